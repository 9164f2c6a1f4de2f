"""The arm KUKA KR 500-2 MT, its joints on sliders, and a view on it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true", description="joints on sliders"),
            DeclareLaunchArgument("rviz", default_value="true", description="whether to open the view"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("urdf_launch"), "launch", "display.launch.py"]),
                launch_arguments={
                    "urdf_package": "kr500_2mt_description",
                    "urdf_package_path": "urdf/kr500_2mt.urdf.xacro",
                    "jsp_gui": LaunchConfiguration("gui"),
                    "rviz": LaunchConfiguration("rviz"),
                }.items(),
            ),
        ]
    )
