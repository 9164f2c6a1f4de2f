"""A video projector as an assistance device: marks and texts on a plane, in the picture of a web page."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Vector
from daidalos.industry.assistance.colors import parse_rgb
from daidalos.industry.assistance.device import Content, Device, DeviceError
from daidalos.industry.assistance.homography import read_homography
from daidalos.industry.assistance.picture_server import PictureServer

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

_CORNERS = 36


@dataclass(frozen=True)
class VideoProjectorParameters(Parameters):
    """Parameters of a device of the kind ``video_projector``."""

    calibration: str = parameter("", "File of `daidalos assist calibrate`.", not_empty=True)
    size: tuple[int, ...] = parameter(
        (1280, 720), "Width and height of the picture.", unit="pixel", length=2, minimum=16, maximum=16384
    )
    radius: float = parameter(0.04, "Radius of a mark on the plane.", unit="m", above=0.0)
    host: str = parameter("127.0.0.1", "Address at which the page is served.", not_empty=True)
    port: int = parameter(8770, "Port at which the page is served; 0 for a free one.", minimum=0, maximum=65535)


class VideoProjector(Device):
    """Projector whose picture is a page that a browser fills the projector's screen with."""

    names: ClassVar[tuple[str, ...]] = ("video_projector",)
    Parameters = VideoProjectorParameters

    def __init__(self, parameters: VideoProjectorParameters, folder: Path) -> None:
        self._homography = read_homography(folder / parameters.calibration)
        self._size = (parameters.size[0], parameters.size[1])
        self._radius = parameters.radius
        self._server = PictureServer(parameters.host, parameters.port)
        self.url = f"http://{parameters.host}:{self._server.port}/"
        self.clear()

    def point(self, place: Vector, content: Content) -> None:
        """Draw a ring around a place of the plane, with the text beside it."""
        from PIL import ImageDraw

        ring = [
            (place[0] + self._radius * math.cos(angle), place[1] + self._radius * math.sin(angle))
            for angle in (2.0 * math.pi * one / _CORNERS for one in range(_CORNERS + 1))
        ]
        pixels = [(float(u), float(v)) for u, v in self._homography.pixels(ring)]
        width, height = self._size
        if not all(0.0 <= u < width and 0.0 <= v < height for u, v in pixels):
            raise DeviceError(
                f"the point [{place[0]:g}, {place[1]:g}] is out of the picture of {width} x {height} pixels"
            )
        color = parse_rgb(content.color)
        picture = self._blank()
        draw = ImageDraw.Draw(picture)
        draw.line(pixels, fill=color, width=max(2, height // 150), joint="curve")
        self._write(draw, content.text, color, (max(u for u, _ in pixels), pixels[0][1]))
        self._send(picture)

    def show(self, content: Content) -> None:
        """Fill the picture with a colour, or write a text in it."""
        from PIL import ImageDraw

        color = parse_rgb(content.color)
        picture = self._blank()
        draw = ImageDraw.Draw(picture)
        if content.text:
            self._write(draw, content.text, color, (0.05 * self._size[0], 0.5 * self._size[1]))
        else:
            draw.rectangle((0, 0, *self._size), fill=color)
        self._send(picture)

    def clear(self) -> None:
        """Show black."""
        self._send(self._blank())

    def close(self) -> None:
        """Show black and stop serving."""
        self.clear()
        self._server.close()

    def _blank(self) -> Image:
        return _new(self._size)

    def _write(self, draw: ImageDraw, text: str, color: tuple[int, int, int], at: tuple[float, float]) -> None:
        _write(draw, self._size[1] // 24, text, color, at)

    def _send(self, picture: Image) -> None:
        self._server.show(_png(picture))


def draw_text(size: tuple[int, int], text: str) -> bytes:
    """Return a black picture of a size [pixels] with a white text in its middle, in PNG."""
    from PIL import ImageDraw

    picture = _new(size)
    _write(ImageDraw.Draw(picture), size[1] // 24, text, (255, 255, 255), (0.1 * size[0], 0.5 * size[1]))
    return _png(picture)


def draw_disc(size: tuple[int, int], center: tuple[float, float], radius: float) -> bytes:
    """Return a black picture of a size with a white disc [pixels], none where its radius is 0, in PNG."""
    from PIL import ImageDraw

    picture = _new(size)
    if radius > 0.0:
        (x, y), draw = center, ImageDraw.Draw(picture)
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=(255, 255, 255))
    return _png(picture)


def _new(size: tuple[int, int]) -> Image:
    from PIL import Image as images

    return images.new("RGB", size)


def _write(draw: ImageDraw, size: int, text: str, color: tuple[int, int, int], at: tuple[float, float]) -> None:
    """Write a text of a size [pixels] to the right of a place."""
    from PIL import ImageFont

    if text:
        draw.text((at[0] + size, at[1] - 0.5 * size), text, fill=color, font=ImageFont.load_default(size))


def _png(picture: Image) -> bytes:
    buffer = io.BytesIO()
    picture.save(buffer, "PNG", compress_level=1)
    return buffer.getvalue()
