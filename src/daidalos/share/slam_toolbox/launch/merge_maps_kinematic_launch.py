"""Merging of saved maps by hand."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [Node(package="slam_toolbox", executable="merge_maps_kinematic", name="slam_toolbox", output="screen")]
    )
