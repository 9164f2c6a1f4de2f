"""A moving head over a table in the simulator: it points at parts in turn, until somebody publishes a point."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def share(*parts):
    return PathJoinSubstitution([FindPackageShare("daidalos_lighting"), *parts])


def generate_launch_description():
    port = ParameterValue(LaunchConfiguration("artnet_port"), value_type=int)
    return LaunchDescription(
        [
            DeclareLaunchArgument("artnet_port", default_value="6454", description="UDP port of Art-Net"),
            IncludeLaunchDescription(share("launch", "cell.launch.py"), launch_arguments={"laser": "false"}.items()),
            Node(
                package="daidalos_lighting",
                executable="moving_head",
                parameters=[{"config": share("config", "head.yaml"), "artnet_port": port}],
                remappings=[("joint_states", "aimed_joint_states"), ("point", "clicked_point")],
                output="screen",
            ),
            Node(package="daidalos_lighting", executable="tour", output="screen"),
        ]
    )
