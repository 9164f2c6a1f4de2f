"""One of the robots of this package, or any other, with its joints on sliders."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("urdf_tutorial")
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", default_value="urdf/robot_example.urdf", description="URDF or xacro file"),
            DeclareLaunchArgument("gui", default_value="true", description="joints on sliders"),
            DeclareLaunchArgument("rviz", default_value="true", description="whether to open the view"),
            DeclareLaunchArgument(
                "rvizconfig",
                default_value=PathJoinSubstitution([here, "rviz", "urdf.rviz"]),
                description="what the view shows",
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("urdf_launch"), "launch", "display.launch.py"]),
                launch_arguments={
                    "urdf_package": "urdf_tutorial",
                    "urdf_package_path": LaunchConfiguration("model"),
                    "jsp_gui": LaunchConfiguration("gui"),
                    "rviz": LaunchConfiguration("rviz"),
                    "rviz_config": LaunchConfiguration("rvizconfig"),
                }.items(),
            ),
        ]
    )
