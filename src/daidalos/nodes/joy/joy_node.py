"""`joy_node`: publishes the state of a game pad."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.joy._node import JoystickNode, JoystickParameters, device_called
from daidalos.nodes.joystick import devices


@dataclass(frozen=True)
class JoyParameters(JoystickParameters):
    """Parameters of ``joy_node``."""

    device_id: int = parameter(0, "Place of the game pad among those of this machine.")
    device_name: str = parameter("", "Name of the game pad, instead of its place where not empty.")
    coalesce_interval_ms: int = parameter(
        1, "How long to wait for other axes that move together with one.", unit="ms", minimum=0
    )

    @property
    def coalescing_s(self) -> float:
        """For how long axes that move together are waited for [s]."""
        return self.coalesce_interval_ms / 1000.0


class JoyNode(JoystickNode):
    """Node that publishes ``joy``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("joy_node", JoyParameters, **kwargs)

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        if self.settings.device_name:
            return device_called(self.settings.device_name, self.folder)
        found, place = devices(self.folder), self.settings.device_id
        return found[place] if 0 <= place < len(found) else None
