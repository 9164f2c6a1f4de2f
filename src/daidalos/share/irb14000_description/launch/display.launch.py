"""The two-armed robot ABB IRB 14000 YuMi, its joints on sliders, and a view on it."""

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
                    "urdf_package": "irb14000_description",
                    "urdf_package_path": "urdf/irb14000.urdf.xacro",
                    "jsp_gui": LaunchConfiguration("gui"),
                    "rviz": LaunchConfiguration("rviz"),
                }.items(),
            ),
        ]
    )
