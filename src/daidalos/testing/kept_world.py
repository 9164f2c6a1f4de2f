"""What the models of a scenario's world look like, kept beside the bag of a failure."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.nodes.gazebo_ros.gzserver import GzServer

FILE_NAME = "world.cdr"


def running_server() -> GzServer | None:
    """Return the simulator that runs in this process; None where there is none."""
    module = sys.modules.get("daidalos.nodes.gazebo_ros.gzserver")
    return None if module is None else next(iter(module.RUNNING), None)


def keep_world(folder: Path) -> None:
    """Write the shapes of all models of the running world into a folder, also of those deleted meanwhile.

    The file is a ``visualization_msgs/msg/MarkerArray`` in CDR; each marker is in the frame ``model::link``, whose
    poses are in the ``link_states`` of the bag. Nothing is written where no simulator runs.
    """
    server = running_server()
    if server is None:
        return
    from rclpy.serialization import serialize_message
    from visualization_msgs.msg import MarkerArray

    from daidalos.nodes.gazebo_ros._shapes import shape_markers

    markers = [marker for name, model in server.host.known_models.items() for marker in shape_markers(model, name)]
    (folder / FILE_NAME).write_bytes(serialize_message(MarkerArray(markers=markers)))


def read_world(folder: Path) -> Any:
    """Return the ``visualization_msgs/msg/MarkerArray`` that is kept in a folder; None where there is none."""
    path = folder / FILE_NAME
    if not path.is_file():
        return None
    from rclpy.serialization import deserialize_message
    from visualization_msgs.msg import MarkerArray

    return deserialize_message(path.read_bytes(), MarkerArray)
