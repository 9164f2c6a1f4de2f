"""Two turtlesims, each in a namespace of its own."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(namespace=f"turtlesim{number}", package="turtlesim", executable="turtlesim_node", output="screen")
            for number in (1, 2)
        ]
    )
