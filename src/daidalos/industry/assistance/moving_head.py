"""A moving head as an assistance device."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Vector
from daidalos.industry.assistance.colors import parse_rgb
from daidalos.industry.assistance.device import Content, Device, DeviceError
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.kinematics import PointingError
from daidalos.industry.lighting.show import Show


@dataclass(frozen=True)
class MovingHeadDeviceParameters(Parameters):
    """Parameters of a device of the kind ``moving_head``."""

    config: str = parameter(
        "", "File of heads and outputs, as `daidalos light` reads it; the built-in one where empty."
    )
    head: str = parameter("", "Name of the head; the first of the file where empty.")
    artnet_port: int = parameter(0, "Port of the Art-Net outputs; that of the file where 0.", minimum=0, maximum=65535)


class MovingHeadDevice(Device):
    """Head that lays its spot on a place; ``show`` sets its colour."""

    names: ClassVar[tuple[str, ...]] = ("moving_head",)
    Parameters = MovingHeadDeviceParameters

    def __init__(self, parameters: MovingHeadDeviceParameters, folder: Path) -> None:
        configuration = read_configuration(folder / parameters.config if parameters.config else DEFAULT)
        configuration = configuration.with_artnet_port(parameters.artnet_port)
        show = Show(configuration.make_heads())
        self._name = show.head(parameters.head or configuration.heads[0].name).name
        self._engine = Engine(show, configuration.make_outputs())
        self._engine.__enter__()

    def point(self, place: Vector, content: Content) -> None:
        """Lay the spot on a place, in the colour of the content."""

        def act(head: Head) -> None:
            head.point(place)
            _show(head, content)

        self._command(act)

    def show(self, content: Content) -> None:
        """Light up in a colour where the head is."""
        self._command(lambda head: _show(head, content))

    def clear(self) -> None:
        """Go dark."""
        self._engine.blackout()

    def close(self) -> None:
        """Go dark and close the outputs."""
        self._engine.close()

    def _command(self, act: Callable[[Head], None]) -> None:
        try:
            self._engine.command(self._name, act)
        except (PointingError, UserError) as error:
            raise DeviceError(str(error)) from None


def _show(head: Head, content: Content) -> None:
    look = head.look
    if content.color:
        red, green, blue = parse_rgb(content.color)
        look = replace(look, color=(red / 255.0, green / 255.0, blue / 255.0))
    head.show(look)
