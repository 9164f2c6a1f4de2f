"""`map_saver`: saves the map of a topic once, with ROS 1's arguments."""

from __future__ import annotations

import argparse

from daidalos.nodes.nav2_map_server._saving import MapSaverParameters, SaveRequest, save_once
from daidalos.nodes.runner import program_arguments, run_program


def _percentage(text: str) -> float:
    value = float(text)
    if not 0.0 <= value <= 100.0:
        raise argparse.ArgumentTypeError(f"expected a percentage from 0 to 100, found {text}")
    return value


def _topic(text: str) -> str:
    name, _, topic = text.partition(":=")
    if name.lstrip("/") != "map" or not topic:
        raise argparse.ArgumentTypeError(f"expected map:=TOPIC, found {text}")
    return topic


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="map_saver", description="Saves the map that is published on a topic")
    add = parser.add_argument
    add("--occ", type=_percentage, default=65.0, metavar="PERCENT", help="cells from it on are occupied")
    add("--free", type=_percentage, default=25.0, metavar="PERCENT", help="cells up to it are free")
    add("-f", dest="stem", default="map", metavar="MAPNAME", help="path of the files, without extension")
    add("topic", nargs="?", type=_topic, default="map:=map", metavar="map:=TOPIC", help="topic of the map")
    return parser.parse_args(program_arguments())


def main() -> int:
    """Wait for the map, however long it takes, and save it; the exit status is 1 when that failed."""
    given = _parse()
    request = SaveRequest(given.topic, given.stem, occupied_thresh=given.occ / 100.0, free_thresh=given.free / 100.0)
    saved: list[bool] = []
    settings = MapSaverParameters(save_map_timeout=0.0)
    status = run_program(lambda: saved.append(save_once(request, settings)), interrupted=1)
    return status or int(saved != [True])
