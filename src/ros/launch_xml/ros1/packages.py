"""Table of ROS 1's packages, nodes, parameters and launch files with their successors, to be extended.

A node that is not listed keeps its package and name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class NodeMapping:
    """Successor of a ROS 1 node.

    Parameters
    ----------
    package, executable
        Where it is found.
    parameters
        New names of parameters; None for one that is of no use any more. Others keep their names.
    values
        New values of parameters, by their new names.
    arguments
        Takes the old command line; returns the new one and parameters taken from the old one.
    note
        What else to know.
    """

    package: str
    executable: str
    parameters: Mapping[str, str | None] = field(default_factory=dict)
    values: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    arguments: Callable[[str], tuple[str, dict[str, str]]] | None = None
    note: str = ""


@dataclass(frozen=True)
class IncludeMapping:
    """Successor of a ROS 1 launch file.

    Parameters
    ----------
    package, path
        Where it is found, the path below the package's share folder.
    arguments
        New names of arguments; None for one that is of no use any more. Others keep their names.
    """

    package: str
    path: str
    arguments: Mapping[str, str | None] = field(default_factory=dict)


def _without_period(arguments: str) -> tuple[str, dict[str, str]]:
    """Drop the last of `static_transform_publisher`'s arguments: transforms that do not change are sent once."""
    words = _words(arguments)
    return " ".join(words[:-1] if len(words) in (9, 10) else words), {}


def _spawn(arguments: str) -> tuple[str, dict[str, str]]:
    """Rename the arguments of the model and its source to today's; those of the pose keep their names."""
    words = _words(arguments)
    new: list[str] = []
    while words:
        word = words.pop(0)
        if word in ("-urdf", "-sdf", "-gazebo"):
            continue
        if word == "-param" and words:
            new += ["-topic", words.pop(0)]
        else:
            new.append({"-model": "-entity"}.get(word, word))
    return " ".join(new), {}


def _words(arguments: str) -> list[str]:
    """Split a command line; quotes and substitutions hold words together."""
    return re.findall(r"""(?:\$\([^)]*\)|"[^"]*"|'[^']*'|\S)+""", arguments)


_GMAPPING = {
    "delta": "resolution",
    "map_update_interval": "map_update_interval",
    "linearUpdate": "minimum_travel_distance",
    "angularUpdate": "minimum_travel_heading",
    "maxUrange": "max_laser_range",
}

#: Nodes by their package and type in ROS 1.
NODES: dict[tuple[str, str], NodeMapping] = {
    ("gazebo_ros", "spawn_model"): NodeMapping("gazebo_ros", "spawn_entity.py", arguments=_spawn),
    ("gmapping", "slam_gmapping"): NodeMapping("slam_toolbox", "async_slam_toolbox_node", _GMAPPING),
    ("joint_state_publisher_gui", "joint_state_publisher_gui"): NodeMapping(
        "joint_state_publisher_gui", "joint_state_publisher_gui"
    ),
    ("joy", "joy_node"): NodeMapping("joy", "joy_node"),
    ("key_teleop", "key_teleop.py"): NodeMapping("key_teleop", "key_teleop"),
    ("robot_state_publisher", "state_publisher"): NodeMapping("robot_state_publisher", "robot_state_publisher"),
    ("rospy_tutorials", "listener"): NodeMapping("demo_nodes_py", "listener"),
    ("rospy_tutorials", "talker"): NodeMapping("demo_nodes_py", "talker"),
    ("roscpp_tutorials", "listener"): NodeMapping("demo_nodes_cpp", "listener"),
    ("roscpp_tutorials", "talker"): NodeMapping("demo_nodes_cpp", "talker"),
    ("rqt_graph", "rqt_graph"): NodeMapping("rqt_graph", "rqt_graph"),
    ("rviz", "rviz"): NodeMapping("rviz2", "rviz2"),
    ("teleop_twist_keyboard", "teleop_twist_keyboard.py"): NodeMapping(
        "teleop_twist_keyboard", "teleop_twist_keyboard"
    ),
    ("tf", "static_transform_publisher"): NodeMapping(
        "tf2_ros", "static_transform_publisher", arguments=_without_period
    ),
    ("tf2_ros", "static_transform_publisher"): NodeMapping(
        "tf2_ros", "static_transform_publisher", arguments=_without_period
    ),
}

#: Launch files by their package and path in ROS 1.
INCLUDES: dict[tuple[str, str], IncludeMapping] = {
    ("gazebo_ros", "launch/empty_world.launch"): IncludeMapping(
        "gazebo_ros",
        "launch/gazebo.launch.py",
        {
            "world_name": "world",
            "paused": "pause",
            "debug": None,
            "headless": None,
            "recording": None,
            "use_sim_time": None,
        },
    ),
}

#: Programs that were called by a path inside of a package.
PROGRAMS: dict[tuple[str, str], str] = {
    ("xacro", "xacro"): "xacro",
    ("xacro", "xacro.py"): "xacro",
}

#: Options of programs that are of no use any more.
DROPPED_OPTIONS: dict[str, tuple[str, ...]] = {"xacro": ("--inorder",)}


def ros2_program(package: str, name: str) -> str:
    """Return the name of a program; many a script lost its ending when its package became one of Python."""
    stem = name.removesuffix(".py")
    if stem != name and not _is_there(package, name) and _is_there(package, stem):
        return stem
    return name


def _is_there(package: str, program: str) -> bool:
    from daidalos.workspaces.executables import find_executable

    try:
        find_executable(package, program)
    except LookupError:
        return False
    return True
