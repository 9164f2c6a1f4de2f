"""The simulator with gz's arguments, and the view on it unless they say ``-s``."""

import re
import shlex

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from daidalos.nodes.packages import model_path_with_exports


def simulator(context):
    """Make the nodes from arguments that are known by now."""
    given = [LaunchConfiguration(name).perform(context) for name in ("gz_args", "ign_args")]
    words = shlex.split(given[0] or given[1])
    ends = LaunchConfiguration("on_exit_shutdown").perform(context).lower() in ("true", "1")
    server = Node(
        package="ros_gz_sim",
        executable="gz_sim",
        arguments=words,
        output="screen",
        additional_env=model_path_with_exports(context.environment),
        on_exit=[Shutdown()] if ends else [],
    )
    view = IncludeLaunchDescription(
        PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gzclient.launch.py"])
    )
    if "-g" in words:
        return [view]
    # Letters may stand together: -rs.
    return [server] if any(re.fullmatch(r"-[rg]*s[rg]*(v\d?)?", word) for word in words) else [server, view]


def generate_launch_description():
    accepted = ("gz_version", "ign_version", "debugger", "debug_env")
    return LaunchDescription(
        [
            DeclareLaunchArgument("gz_args", default_value="", description="world, -r to run at once, -s without view"),
            DeclareLaunchArgument("ign_args", default_value="", description="the older name of gz_args"),
            DeclareLaunchArgument("on_exit_shutdown", default_value="false", description="end when it ends"),
            *(
                DeclareLaunchArgument(name, default_value="", description="accepted, without effect")
                for name in accepted
            ),
            OpaqueFunction(function=simulator),
        ]
    )
