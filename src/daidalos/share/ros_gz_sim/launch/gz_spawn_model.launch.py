"""Spawns one entity."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "world": "world to spawn in",
    "file": "SDF or URDF file",
    "model_string": "the description itself",
    "topic": "topic with the description",
    "entity_name": "name of the entity",
    "allow_renaming": "whether another name will do",
    **dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw", "R", "P", "Y"), "pose [m, rad]"),
}
FLAGS = {"model_string": "string", "entity_name": "name", "roll": "R", "pitch": "P", "yaw": "Y"}


def spawner(context):
    """Make the node from the arguments that were given."""
    words = []
    for name in ARGUMENTS:
        value = LaunchConfiguration(name).perform(context)
        if value:
            words += [f"-{FLAGS.get(name, name)}", value]
    return [Node(package="ros_gz_sim", executable="create", arguments=words, output="screen")]


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value="", description=text) for name, text in ARGUMENTS.items()]
    return LaunchDescription([*declared, OpaqueFunction(function=spawner)])
