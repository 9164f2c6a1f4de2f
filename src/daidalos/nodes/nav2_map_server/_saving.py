"""What saving maps shares: waiting for a map on a topic, and writing it to files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future

from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import FREE_THRESHOLD, OCCUPIED_THRESHOLD, Mode, save_map
from daidalos.mapping.map_image import Format
from daidalos.nodes.conversions import grid_array, pose2_of

MODES, FORMATS = get_args(Mode), get_args(Format)
_TIMEOUT_S = 5.0


@dataclass(frozen=True)
class SaveRequest:
    """What is to be saved, and how.

    Attributes
    ----------
    topic
        Where the map is published.
    stem
        Path of the files, without extension.
    mode, image_format
        As `save_map` has them; an empty format is the one that the mode needs.
    occupied_thresh, free_thresh
        As `save_map` has them; 0 is for the node's parameters.
    """

    topic: str
    stem: str
    mode: str = ""
    image_format: str = ""
    occupied_thresh: float = 0.0
    free_thresh: float = 0.0


def declare_parameters(node: Node) -> None:
    """Declare the parameters of Nav2's map_saver."""
    node.declare_parameter("save_map_timeout", _TIMEOUT_S)
    node.declare_parameter("free_thresh_default", FREE_THRESHOLD)
    node.declare_parameter("occupied_thresh_default", OCCUPIED_THRESHOLD)
    node.declare_parameter("map_subscribe_transient_local", True)


async def save(node: Node, wish: SaveRequest) -> bool:
    """Wait for a map and write it; False, after a word in the log, when that failed."""
    log = node.get_logger()
    log.info(f"Saving map from '{wish.topic}' topic to '{wish.stem}' file")
    message = await _next_map(node, wish.topic)
    if message is None:
        seconds = node.get_parameter("save_map_timeout").value
        log.error(f"Failed to save the map: nothing came on the topic '{wish.topic}' within {seconds:g} s")
        return False
    info = message.info
    log.info(f"Received a {info.width} X {info.height} map @ {info.resolution:.3g} m/pix")
    try:
        files = _write(node, message, wish)
    except MapFileError as error:
        log.error(f"Failed to save the map: {error}")
        return False
    log.info(f"Map saved: {files[0]} and {files[1]}")
    return True


async def _next_map(node: Node, topic: str) -> Any:
    """Return the next map on a topic, None when none comes in time."""
    from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage

    came = Future()

    def take(message: Any) -> None:
        if not came.done():
            came.set_result(message)

    latched = node.get_parameter("map_subscribe_transient_local").value
    durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    qos = QoSProfile(depth=1, durability=durability)
    group = MutuallyExclusiveCallbackGroup()  # who waits for the map may hold the node's own
    subscription = node.create_subscription(OccupancyGridMessage, topic, take, qos, callback_group=group)
    timeout_s = max(node.get_parameter("save_map_timeout").value, 0.0)
    timer = node.create_timer(timeout_s, lambda: take(None), callback_group=group)
    try:
        return await came
    finally:
        node.destroy_timer(timer)
        node.destroy_subscription(subscription)


def _write(node: Node, message: Any, wish: SaveRequest) -> tuple[Any, Any]:
    # The message's resolution has 32 bits; the file says what its writer meant, such as 0.05.
    resolution = float(str(np.float32(message.info.resolution)))
    x, y, yaw = pose2_of(message.info.origin).tolist()
    grid = OccupancyGrid(grid_array(message), resolution, (x, y, yaw))
    mode = wish.mode or "trinary"
    image_format = wish.image_format or ("png" if mode == "scale" else "pgm")
    if mode not in MODES:
        raise MapFileError(Path(wish.stem), "mode", f"expected {', '.join(MODES)}, found '{mode}'")
    if image_format not in FORMATS:
        raise MapFileError(Path(wish.stem), "format", f"expected {', '.join(FORMATS)}, found '{image_format}'")
    return save_map(
        grid,
        wish.stem,
        cast(Mode, mode),
        image_format=cast(Format, image_format),
        occupied_thresh=wish.occupied_thresh or node.get_parameter("occupied_thresh_default").value,
        free_thresh=wish.free_thresh or node.get_parameter("free_thresh_default").value,
    )
