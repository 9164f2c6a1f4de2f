"""Commands of Gazebo, classic and new, in users' launch files: `gazebo`, `gzclient`, `gz` and `ign`."""

from __future__ import annotations

import sys
from collections.abc import Sequence


def gazebo(argv: Sequence[str] | None = None) -> int:
    """Run the simulator and its view.

    Parameters
    ----------
    argv
        What `gzserver` takes; the arguments of the process where None.
    """
    return _run("gazebo_ros", "gzserver", sys.argv[1:] if argv is None else argv, with_view=True)


def gzclient() -> int:
    """Serve the view of a running simulator; arguments have no effect."""
    return _run("", "", (), with_view=True)


def gz(argv: Sequence[str] | None = None) -> int:
    """Run ``gz sim`` or ``ign gazebo``; other verbs of gz are not available.

    Parameters
    ----------
    argv
        The verb and its arguments; those of the process where None.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    verb = words.pop(0) if words else ""
    if verb not in ("sim", "gazebo"):
        print(
            f"error: gz has no '{verb}' here; 'gz sim' simulates, for topics and services there is ros2",
            file=sys.stderr,
        )
        return 2
    from daidalos.nodes.ros_gz_sim.gz_sim import parse

    if "-g" in words:
        return gzclient()
    return _run("ros_gz_sim", "gz_sim", words, with_view=not parse(words).server)


def _run(package: str, server: str, words: Sequence[str], with_view: bool) -> int:
    """Start a simulator, if one is named, and the view; stop them together."""
    from launch import LaunchDescription, LaunchDescriptionEntity, LaunchService
    from launch.actions import IncludeLaunchDescription, Shutdown
    from launch.substitutions import PathJoinSubstitution
    from launch_ros.actions import Node
    from launch_ros.substitutions import FindPackageShare

    parts: list[LaunchDescriptionEntity] = []
    if server:
        parts.append(
            Node(package=package, executable=server, arguments=list(words), output="screen", on_exit=[Shutdown()])
        )
    if with_view:
        view = PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gzclient.launch.py"])
        parts.append(IncludeLaunchDescription(view))
    service = LaunchService()
    service.include_launch_description(LaunchDescription(parts))
    return int(service.run())
