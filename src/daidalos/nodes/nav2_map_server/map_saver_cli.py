"""`map_saver_cli`: saves the map of a topic once."""

from __future__ import annotations

import argparse

from daidalos.nodes.nav2_map_server._saving import FORMATS, MODES, SaveRequest, save_once
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


def main() -> int:
    """Save the map; the exit status is 1 when that failed."""
    given = _parse()
    save_request = SaveRequest(given.topic, given.stem, given.mode, given.fmt, given.occ, given.free)
    saved: list[bool] = []
    status = run_program(lambda: saved.append(save_once(save_request)), interrupted=1)
    return status or int(saved != [True])
