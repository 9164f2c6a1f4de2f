"""A bridge from a YAML file."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    accepted = ("container_name", "create_own_container", "namespace", "use_composition", "use_respawn", "log_level")
    return LaunchDescription(
        [
            DeclareLaunchArgument("bridge_name", default_value="ros_gz_bridge", description="name of the node"),
            DeclareLaunchArgument("config_file", description="YAML file with the bridges"),
            *(
                DeclareLaunchArgument(name, default_value="", description="accepted, without effect")
                for name in accepted
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                name=LaunchConfiguration("bridge_name"),
                parameters=[{"config_file": LaunchConfiguration("config_file")}],
                output="screen",
            ),
        ]
    )
