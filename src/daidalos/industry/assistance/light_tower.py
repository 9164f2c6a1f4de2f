"""A light tower on DMX channels as an assistance device."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.suggestions import hint
from daidalos.industry.assistance.device import SHOW, Content, Device, DeviceError
from daidalos.industry.assistance.repetition import Repetition
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.outputs import ArtNetOutput
from daidalos.industry.lighting.show import KEEP_ALIVE_S

CHANNELS = 512


@dataclass(frozen=True)
class LightTowerParameters(Parameters):
    """Parameters of a device of the kind ``light_tower``: lamps on DMX channels of their own universe."""

    lamps: tuple[str, ...] = parameter(
        ("red", "yellow", "green"),
        "Colours of the lamps, on channels one after the other.",
        not_empty=True,
        unique=True,
    )
    address: int = parameter(1, "DMX channel of the first lamp.", minimum=1, maximum=512)
    universe: int = parameter(2, "Universe, which nothing else sends.", minimum=0, maximum=artnet.MAX_UNIVERSE)
    host: str = parameter("127.0.0.1", "Address of the Art-Net receiver.", not_empty=True)
    port: int = parameter(artnet.PORT, "Port of the Art-Net receiver.", minimum=1, maximum=65535)


class LightTower(Device):
    """Tower of which one lamp is lit: that of the content's colour."""

    names: ClassVar[tuple[str, ...]] = ("light_tower",)
    Parameters = LightTowerParameters
    skills: ClassVar[tuple[str, ...]] = (SHOW,)

    def __init__(self, parameters: LightTowerParameters, folder: Path) -> None:
        last = parameters.address + len(parameters.lamps) - 1
        if last > CHANNELS:
            raise DeviceError(f"the lamps need channels up to {last}, a universe has {CHANNELS}")
        self._channels: Mapping[str, int] = {
            name: parameters.address - 1 + index for index, name in enumerate(parameters.lamps)
        }
        self._universe = parameters.universe
        self._output = ArtNetOutput(parameters.host, parameters.port)
        self._repetition = Repetition("light tower", self._send, bytes(CHANNELS), KEEP_ALIVE_S)

    def show(self, content: Content) -> None:
        """Light the lamp of a colour."""
        if content.color not in self._channels:
            raise DeviceError(f"there is no lamp '{content.color}'{hint(content.color, self._channels)}")
        levels = bytearray(CHANNELS)
        levels[self._channels[content.color]] = 255
        self._repetition.set(bytes(levels))

    def clear(self) -> None:
        """Switch all lamps off."""
        self._repetition.set(bytes(CHANNELS))

    def close(self) -> None:
        """Switch all lamps off and close the output."""
        try:
            self.clear()
        finally:
            self._repetition.close()
            self._output.close()

    def _send(self, levels: bytes) -> None:
        self._output.send(self._universe, levels)
