"""A moving head that takes points, and names of tf frames to follow, from an MQTT broker."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    bridges = PathJoinSubstitution([FindPackageShare("daidalos_lighting"), "config", "mqtt.yaml"])
    broker = {
        "broker.host": LaunchConfiguration("broker_host"),
        "broker.port": ParameterValue(LaunchConfiguration("broker_port"), value_type=int),
    }
    head = {
        "config": LaunchConfiguration("config"),
        "world_frame": LaunchConfiguration("world_frame"),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("broker_host", default_value="localhost", description="of the MQTT broker"),
            DeclareLaunchArgument("broker_port", default_value="1883", description="of the MQTT broker"),
            DeclareLaunchArgument("config", default_value="", description="file of heads and outputs"),
            DeclareLaunchArgument("world_frame", default_value="world", description="in which heads are placed"),
            Node(package="daidalos_lighting", executable="moving_head", parameters=[head], output="screen"),
            Node(package="mqtt_client", executable="mqtt_client", parameters=[bridges, broker], output="screen"),
        ]
    )
