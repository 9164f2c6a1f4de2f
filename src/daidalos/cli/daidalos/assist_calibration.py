"""`daidalos assist calibrate`: the homography of a video projector, by clicks or by a camera."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from daidalos.industry.assistance.picture_server import PictureServer

    Points = Sequence[Sequence[float]]

CORNERS = ((-1.0, -0.75), (-1.0, 0.75), (1.0, -0.75), (1.0, 0.75))
"""Known points where none are given: the corners of a table of 2 x 1.5 m."""


def add_calibration(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `daidalos assist calibrate`."""
    parser.add_argument("output", type=Path, metavar="OUTPUT", help="file of the pairs, which must not exist")
    parser.add_argument(
        "--point", type=float, nargs=2, action="append", metavar=("X", "Y"), dest="points",
        help="known point of the plane [m], four or more times (default: the corners of a table of 2 x 1.5 m)",
    )  # fmt: skip
    parser.add_argument(
        "--size", type=int, nargs=2, default=(1280, 720), metavar=("W", "H"), help="of the picture [pixels]"
    )
    parser.add_argument("--port", type=int, default=8770, metavar="N", help="of the page (default: 8770)")
    parser.add_argument(
        "--camera", metavar="TOPIC",
        help="detect dark circles at five or more known points, and discs of the projector, in the images of a camera",
    )  # fmt: skip
    parser.add_argument(
        "--settle", type=float, default=0.5, metavar="S",
        help="time from a picture of the projector to that of the camera (default: 0.5)",
    )  # fmt: skip


def calibrate(args: argparse.Namespace) -> int:
    """Find a homography, and write the pairs of points and pixels."""
    from daidalos.industry.assistance.circles import MIN_CIRCLES
    from daidalos.industry.assistance.homography import MIN_PAIRS, fit, write_pairs
    from daidalos.industry.assistance.picture_server import PictureServer

    points: Points = args.points or CORNERS
    least = MIN_PAIRS if args.camera is None else MIN_CIRCLES
    if len(points) < least:
        raise UserError(f"{least} or more points are needed: add --point X Y for each")
    if args.output.exists():
        raise UserError(f"{args.output} exists; name another file")
    if not all(16 <= one <= 16384 for one in args.size):
        raise UserError("--size must be from 16 to 16384 pixels")
    if not 0.0 <= args.settle <= 60.0:
        raise UserError("--settle must be from 0 to 60 s")
    clicks = _Clicks(*args.size)
    server = PictureServer("127.0.0.1", args.port, clicks.put)
    try:
        print(f"fill the projector's screen with http://127.0.0.1:{server.port}/", flush=True)
        measure = _by_clicks if args.camera is None else _by_camera
        plane, pixels = measure(args, server, points, clicks)
    finally:
        server.close()
    found = fit(plane, pixels)
    write_pairs(args.output, plane, pixels)
    print(f"residual {found.residual:.2f} pixels, written to {args.output}")
    return 0


class _Clicks:
    """Clicks in the picture, in pixels."""

    def __init__(self, width: int, height: int) -> None:
        import queue

        self._size = width, height
        self._found: queue.SimpleQueue[tuple[float, float]] = queue.SimpleQueue()

    def put(self, x: float, y: float) -> None:
        """Take a click at shares of the picture."""
        self._found.put((x * self._size[0], y * self._size[1]))

    def get(self) -> tuple[float, float]:
        """Wait for the next one."""
        return self._found.get()


def _by_clicks(
    args: argparse.Namespace, server: PictureServer, points: Points, clicks: _Clicks
) -> tuple[Points, Points]:
    from daidalos.industry.assistance.video_projector import draw_text

    pixels = []
    for x, y in points:
        text = f"Click where the point [{x:g}, {y:g}] of the plane lies"
        server.show(draw_text(tuple(args.size), text))
        print(text, flush=True)
        pixels.append(clicks.get())
    return points, pixels


def _by_camera(
    args: argparse.Namespace, server: PictureServer, points: Points, clicks: _Clicks
) -> tuple[Points, Points]:
    from daidalos.industry.assistance.projector_calibration import measure_pairs
    from daidalos.industry.assistance.video_projector import draw_text
    from daidalos.nodes.still_camera import StillCamera

    server.show(draw_text(tuple(args.size), "Press Enter in the terminal when the screen shows this"))
    print("press Enter when the screen shows the page", flush=True)
    sys.stdin.readline()
    with StillCamera(args.camera, args.settle) as camera:
        found = measure_pairs(
            points, tuple(args.size), server.show, camera.take, lambda line: print(line, flush=True)
        )  # fmt: skip
    return found.points.tolist(), found.pixels.tolist()
