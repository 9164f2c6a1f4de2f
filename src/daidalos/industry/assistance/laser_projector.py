"""A laser projector as an assistance device: rings and texts drawn by a beam, streamed by the ILDA Digital Network."""

from __future__ import annotations

import contextlib
import math
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.assistance.colors import parse_rgb
from daidalos.industry.assistance.device import Content, Device, DeviceError
from daidalos.industry.assistance.galvanometer import Galvanometer
from daidalos.industry.assistance.laser_figure import centered_text, horizontal_text, ring, trace
from daidalos.industry.assistance.repetition import Repetition
from daidalos.industry.lighting import idn
from daidalos.industry.lighting.outputs import resolve

Array = NDArray[np.float64]
REPEAT_S = 0.1
MIN_PICTURES = 15.0
"""Least number of passes a second [Hz]; a picture drawn less often flickers."""

_DARK = trace([], (0, 0, 0), 1.0)


@dataclass(frozen=True)
class LaserPose(Parameters):
    """Where a laser projector is, and how far it reaches."""

    position: tuple[float, ...] = parameter((0.0, 0.0, 2.5), "Position of the second mirror.", unit="m", length=3)
    rpy: tuple[float, ...] = parameter(
        (math.pi, 0.0, 0.0),
        "Roll, pitch and yaw; z is the beam at rest, y the picture's upper edge.",
        unit="rad",
        length=3,
    )
    field_deg: tuple[float, ...] = parameter(
        (60.0, 60.0), "Angles of the field, across and upright.", unit="deg", length=2, minimum=1.0, maximum=160.0
    )
    mirror_distance: float = parameter(0.005, "Distance between the two mirrors.", unit="m", minimum=0.0, maximum=1.0)

    def galvanometer(self) -> Galvanometer:
        """Return the geometry."""
        across, upright = (0.5 * math.radians(one) for one in self.field_deg)
        return Galvanometer(Pose.from_xyz_rpy(self.position, self.rpy), (across, upright), self.mirror_distance)


@dataclass(frozen=True)
class LaserProjectorParameters(LaserPose):
    """Parameters of a device of the kind ``laser_projector``."""

    radius: float = parameter(0.04, "Radius of a ring around a place.", unit="m", above=0.0)
    text_height: float = parameter(0.04, "Height of capitals beside a ring.", unit="m", above=0.0)
    text_direction_deg: float = parameter(0.0, "Direction of writing about z; 0 writes along x.", unit="deg")
    brightness: float = parameter(1.0, "Share of the beam's full power.", minimum=0.0, maximum=1.0)
    point_rate: float = parameter(
        30000.0, "Samples that the mirrors follow in a second.", unit="Hz", minimum=1000.0, maximum=200000.0
    )
    host: str = parameter("127.0.0.1", "Address of the IDN receiver.", not_empty=True)
    port: int = parameter(idn.PORT, "Port of the IDN receiver.", minimum=1, maximum=65535)


class LaserProjector(Device):
    """Projector whose beam draws a ring around a place, and the text beside it."""

    names: ClassVar[tuple[str, ...]] = ("laser_projector",)
    Parameters = LaserProjectorParameters

    def __init__(self, parameters: LaserProjectorParameters, folder: Path) -> None:
        self._parameters = parameters
        self._galvanometer = parameters.galvanometer()
        self._target = resolve(parameters.host, parameters.port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._sequence = 0
        self._repetition = Repetition("laser projector", self._send, _DARK, REPEAT_S)

    def point(self, place: Vector, content: Content) -> None:
        """Draw a ring around a place, with the text beside it."""
        one = self._parameters
        lines = [ring(place, one.radius)]
        if content.text:
            direction = math.radians(one.text_direction_deg)
            gap = one.radius + 0.5 * one.text_height
            start = (place[0] + gap * math.cos(direction), place[1] + gap * math.sin(direction), place[2])
            lines += _written(lambda: horizontal_text(content.text, start, one.text_height, direction))
        self._draw([self._deflections(line) for line in lines], content)

    def show(self, content: Content) -> None:
        """Write a text in the middle of the field, or draw a circle there."""
        angles = np.array(self._galvanometer.angles)
        if content.text:
            lines = _written(lambda: centered_text(content.text, 1.2 * angles[0], 0.4 * angles[1]))
        else:
            lines = [0.5 * angles.min() * ring((0.0, 0.0, 0.0), 1.0)[:, :2]]
        self._draw([line / angles for line in lines], content)

    def clear(self) -> None:
        """Draw nothing."""
        self._repetition.set(_DARK)

    def close(self) -> None:
        """Draw nothing and end the connection."""
        try:
            self.clear()
        finally:
            self._repetition.close()
            with self._socket, contextlib.suppress(OSError):  # a projector that gets nothing goes dark by itself
                self._socket.sendto(idn.close_packet(self._sequence, _now_us()), self._target)

    def _deflections(self, line: Array) -> Array:
        found = self._galvanometer.deflections(line)
        if not (np.abs(found) <= 1.0).all():
            x, y, z = line[~(np.abs(found) <= 1.0).all(axis=1)][0]
            across, upright = self._parameters.field_deg
            raise DeviceError(f"[{x:.3g}, {y:.3g}, {z:.3g}] is out of the field of {across:g} x {upright:g} degrees")
        return found

    def _draw(self, lines: list[Array], content: Content) -> None:
        color = [round(self._parameters.brightness * one) for one in parse_rgb(content.color)]
        frame = trace(lines, color, self._parameters.point_rate)
        if len(frame.places) > idn.MAX_SAMPLES or frame.duration > 1.0 / MIN_PICTURES:
            raise DeviceError(
                f"the picture takes {frame.duration * 1e3:.0f} ms at {self._parameters.point_rate:g} samples a second, "
                f"and flickers above {1e3 / MIN_PICTURES:.0f} ms: shorten the text"
            )
        self._repetition.set(frame)

    def _send(self, frame: idn.Frame) -> None:
        self._socket.sendto(idn.frame_packet(frame, self._sequence, _now_us()), self._target)
        self._sequence += 1


def _written(write: Callable[[], list[Array]]) -> list[Array]:
    try:
        return write()
    except UserError as error:  # a letter that the alphabet lacks
        raise DeviceError(str(error)) from None


def _now_us() -> int:
    return time.monotonic_ns() // 1000
