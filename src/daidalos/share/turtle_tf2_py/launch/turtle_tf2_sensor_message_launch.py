"""A turtle with a frame, and another one that a sensor sees."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="turtlesim", executable="turtlesim_node", name="sim", output="screen"),
            Node(
                package="turtle_tf2_py",
                executable="turtle_tf2_broadcaster",
                name="broadcaster1",
                parameters=[{"turtlename": "turtle1"}],
            ),
            Node(
                package="turtle_tf2_py",
                executable="turtle_tf2_broadcaster",
                name="broadcaster2",
                parameters=[{"turtlename": "turtle3"}],
            ),
            Node(
                package="turtle_tf2_py",
                executable="turtle_tf2_message_broadcaster",
                name="message_broadcaster",
                output="screen",
            ),
        ]
    )
