"""Saving of maps: waits for a map on a topic, and writes it to files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import FREE_THRESHOLD, OCCUPIED_THRESHOLD, Mode, save_map
from daidalos.mapping.map_image import Format
from daidalos.nodes.conversions import grid_array, pose2_of
from daidalos.nodes.parameters import declare

MODES, FORMATS = get_args(Mode), get_args(Format)


@dataclass(frozen=True)
class SaveRequest:
    """Map topic, file and format of a map to be saved.

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


@dataclass(frozen=True)
class MapSaverParameters(Parameters):
    """Parameters of Nav2's map_saver."""

    save_map_timeout: float = parameter(5.0, "How long to wait for a map; 0 for ever.", unit="s", minimum=0.0)
    free_thresh_default: float = parameter(
        FREE_THRESHOLD, "Occupancy below which a cell is free.", minimum=0.0, maximum=1.0
    )
    occupied_thresh_default: float = parameter(
        OCCUPIED_THRESHOLD, "Occupancy above which a cell is occupied.", minimum=0.0, maximum=1.0
    )
    map_subscribe_transient_local: bool = parameter(True, "Whether the map is taken from a latched topic.")


def save_once(save_request: SaveRequest, settings: MapSaverParameters | None = None) -> bool:
    """Save a map with a node of its own; False, after a word in the log, when that failed.

    Parameters
    ----------
    save_request : SaveRequest
        What to save; a file name is made where it has none.
    settings : MapSaverParameters or None
        Declared as the node's parameters where None.
    """
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    rclpy.init()
    node = Node("map_saver")
    try:
        parameters = settings or declare(node, MapSaverParameters)
        stem = save_request.stem or f"map_{node.get_clock().now().nanoseconds // 1_000_000_000}"
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        task = executor.create_task(save, node, parameters, replace(save_request, stem=stem))
        executor.spin_until_future_complete(task)
        return bool(task.result())
    finally:
        node.destroy_node()


async def save(node: Node, parameters: MapSaverParameters, save_request: SaveRequest) -> bool:
    """Wait for a map and write it; False, after a word in the log, when that failed."""
    log = node.get_logger()
    log.info(f"Saving map from '{save_request.topic}' topic to '{save_request.stem}' file")
    message = await _next_map(node, parameters, save_request.topic)
    if message is None:
        seconds = parameters.save_map_timeout
        log.error(f"Failed to save the map: nothing came on the topic '{save_request.topic}' within {seconds:g} s")
        return False
    info = message.info
    log.info(f"Received a {info.width} X {info.height} map @ {info.resolution:.3g} m/pix")
    try:
        files = _write(parameters, message, save_request)
    except UserError as error:
        log.error(f"Failed to save the map: {error}")
        return False
    log.info(f"Map saved: {files[0]} and {files[1]}")
    return True


async def _next_map(node: Node, parameters: MapSaverParameters, topic: str) -> Any:
    """Return the next map on a topic, None when none comes in time."""
    from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage

    came = Future()

    def take(message: Any) -> None:
        if not came.done():
            came.set_result(message)

    latched = parameters.map_subscribe_transient_local
    durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    qos = QoSProfile(depth=1, durability=durability)
    group = MutuallyExclusiveCallbackGroup()  # the caller may hold the node's own group
    subscription = node.create_subscription(OccupancyGridMessage, topic, take, qos, callback_group=group)
    timeout = parameters.save_map_timeout
    timer = node.create_timer(timeout, lambda: take(None), callback_group=group) if timeout else None
    try:
        return await came
    finally:
        if timer is not None:
            node.destroy_timer(timer)
        node.destroy_subscription(subscription)


def _write(parameters: MapSaverParameters, message: Any, save_request: SaveRequest) -> tuple[Any, Any]:
    # The message's resolution has 32 bits; the file says what its writer meant, such as 0.05.
    resolution = float(str(np.float32(message.info.resolution)))
    x, y, yaw = pose2_of(message.info.origin).tolist()
    grid = OccupancyGrid(grid_array(message), resolution, (x, y, yaw))
    mode = save_request.mode or "trinary"
    image_format = save_request.image_format or ("png" if mode == "scale" else "pgm")
    if mode not in MODES:
        raise MapFileError(Path(save_request.stem), "mode", f"expected {', '.join(MODES)}, found '{mode}'")
    if image_format not in FORMATS:
        raise MapFileError(Path(save_request.stem), "format", f"expected {', '.join(FORMATS)}, found '{image_format}'")
    return save_map(
        grid,
        save_request.stem,
        cast(Mode, mode),
        image_format=cast(Format, image_format),
        occupied_thresh=save_request.occupied_thresh or parameters.occupied_thresh_default,
        free_thresh=save_request.free_thresh or parameters.free_thresh_default,
    )
