"""`map_saver_cli`: saves the map of a topic once."""

from __future__ import annotations

import argparse

from rclpy.node import Node

from daidalos.nodes.nav2_map_server._saving import FORMATS, MODES, MapSaverParameters, SaveRequest, save
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import program_arguments, run_program


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="map_saver_cli", description="Saves the map that is published on a topic")
    add = parser.add_argument
    add("-t", dest="topic", default="map", metavar="map_topic", help="topic of the map (default: %(default)s)")
    add("-f", dest="stem", default="", metavar="mapname", help="path of the files, without extension")
    add("--occ", type=float, default=0.0, metavar="threshold_occupied", help="cells above it are occupied (0 to 1)")
    add("--free", type=float, default=0.0, metavar="threshold_free", help="cells below it are free (0 to 1)")
    add("--fmt", default="", choices=FORMATS, help="format of the image (default: png in mode scale, else pgm)")
    add("--mode", default="trinary", choices=MODES, help="what the grey values mean (default: %(default)s)")
    return parser.parse_args(program_arguments())


def _save(arguments: argparse.Namespace) -> bool:
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    rclpy.init()
    node = Node("map_saver")
    try:
        parameters = declare(node, MapSaverParameters)
        stem = arguments.stem or f"map_{node.get_clock().now().nanoseconds // 1_000_000_000}"
        save_request = SaveRequest(arguments.topic, stem, arguments.mode, arguments.fmt, arguments.occ, arguments.free)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        task = executor.create_task(save, node, parameters, save_request)
        executor.spin_until_future_complete(task)
        return bool(task.result())
    finally:
        node.destroy_node()


def main() -> int:
    """Save the map; the exit status is 1 when that failed."""
    arguments = _parse()
    saved: list[bool] = []
    status = run_program(lambda: saved.append(_save(arguments)), interrupted=1)
    return status or int(saved != [True])
