"""`joy_linux_node`: publishes the state of a game pad, given as a Linux device file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.joy._node import JoystickNode, JoystickParameters, device_called


@dataclass(frozen=True)
class JoyLinuxParameters(JoystickParameters):
    """Parameters of ``joy_linux_node``."""

    dev: str = parameter("/dev/input/js0", "File of the game pad.")
    dev_name: str = parameter("", "Name of the game pad, instead of its file where there is one of that name.")
    coalesce_interval: float = parameter(
        0.001, "How long to wait for other axes that move together with one.", unit="s", minimum=0.0
    )

    @property
    def coalescing_s(self) -> float:
        """For how long axes that move together are waited for [s]."""
        return self.coalesce_interval


class JoyLinuxNode(JoystickNode):
    """Node that publishes ``joy``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("joy_node", JoyLinuxParameters, **kwargs)

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        named = device_called(self.settings.dev_name, self.folder) if self.settings.dev_name else None
        path = Path(self.settings.dev)
        return named or (path if path.exists() else None)
