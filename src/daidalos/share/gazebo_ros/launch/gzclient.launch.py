"""The view on the simulator: the studio, in the browser."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def view(context):
    """Make the node from arguments that are known by now."""

    def is_true(name):
        return LaunchConfiguration(name).perform(context).lower() in ("true", "1")

    node = Node(
        package="foxglove_bridge",
        executable="foxglove_bridge",
        parameters=[
            {
                "front": "simulation",
                "port": ParameterValue(LaunchConfiguration("port"), value_type=int),
                "open_browser": ParameterValue(LaunchConfiguration("open_browser"), value_type=bool),
            }
        ],
        output="screen",
        on_exit=[Shutdown()] if is_true("gui_required") else [],
    )
    return [node] if is_true("gui") else []


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("gui_required", default_value="false", description="whether everything ends with it"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            OpaqueFunction(function=view),
        ]
    )
