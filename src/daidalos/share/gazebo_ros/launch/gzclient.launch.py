"""The view on the simulator: the studio, in the browser."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            Node(
                package="foxglove_bridge",
                executable="foxglove_bridge",
                parameters=[
                    {
                        "port": ParameterValue(LaunchConfiguration("port"), value_type=int),
                        "open_browser": ParameterValue(LaunchConfiguration("open_browser"), value_type=bool),
                    }
                ],
                condition=IfCondition(LaunchConfiguration("gui")),
                output="screen",
            ),
        ]
    )
