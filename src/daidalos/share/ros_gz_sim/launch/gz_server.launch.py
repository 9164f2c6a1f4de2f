"""The simulator alone, running at once."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from daidalos.common.temporary_files import write_temporary


def server(context):
    """Make the node from arguments that are known by now."""
    world = LaunchConfiguration("world_sdf_file").perform(context)
    text = LaunchConfiguration("world_sdf_string").perform(context)
    if text and not world:
        world = str(write_temporary(text, "world_", ".sdf"))
    return [Node(package="ros_gz_sim", executable="gz_sim", arguments=["-r", "-s", world], output="screen")]


def generate_launch_description():
    accepted = ("container_name", "create_own_container", "use_composition")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_sdf_file", default_value="", description="SDF world"),
            DeclareLaunchArgument("world_sdf_string", default_value="", description="the world itself"),
            *(
                DeclareLaunchArgument(name, default_value="", description="accepted, without effect")
                for name in accepted
            ),
            OpaqueFunction(function=server),
        ]
    )
