"""`joy_node`: publishes the state of a game pad."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from daidalos.nodes.joy._node import JoystickNode, device_called
from daidalos.nodes.joystick import devices
from daidalos.nodes.runner import run


class JoyNode(JoystickNode):
    """Node that publishes ``joy``.

    Parameters of the node: ``device_id`` (the place of the game pad among those of this machine), ``device_name``
    (its name instead, where it is not empty), ``deadzone`` (share of an axis that is its centre), ``autorepeat_rate``
    (how often an unchanged state is published [Hz], 0 for never), ``sticky_buttons`` (whether buttons are switches) and
    ``coalesce_interval_ms`` (for how long axes that move together are waited for).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("joy_node", **kwargs)
        self._place = int(self.declare_parameter("device_id", 0).value or 0)
        self._name = str(self.declare_parameter("device_name", "").value)
        self.start()

    def declare_coalescing(self) -> float:
        """Declare for how long axes are waited for, and return it [s]."""
        return float(self.declare_parameter("coalesce_interval_ms", 1).value or 0) / 1000.0

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        if self._name:
            return device_called(self._name, self.folder)
        found = devices(self.folder)
        return found[self._place] if 0 <= self._place < len(found) else None


def main() -> int:
    """Run the node."""
    return run(JoyNode)


if __name__ == "__main__":
    sys.exit(main())
