"""The simulator alone, running at once."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    accepted = ("world_sdf_string", "container_name", "create_own_container", "use_composition")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_sdf_file", default_value="", description="SDF world"),
            *(
                DeclareLaunchArgument(name, default_value="", description="accepted, without effect")
                for name in accepted
            ),
            Node(
                package="ros_gz_sim",
                executable="gz_sim",
                arguments=["-r", "-s", LaunchConfiguration("world_sdf_file")],
                output="screen",
            ),
        ]
    )
