"""Talker and listener as components of one container."""

from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    """Return the container with its components."""
    container = ComposableNodeContainer(
        package="rclcpp_components",
        executable="component_container",
        name="my_container",
        namespace="",
        composable_node_descriptions=[
            ComposableNode(package="composition", plugin=f"composition::{plugin}", name=plugin.lower())
            for plugin in ("Talker", "Listener")
        ],
        output="screen",
    )
    return LaunchDescription([container])
