"""`joy_linux_node`: publishes the state of a game pad, given as a Linux device file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from daidalos.nodes.joy._node import JoystickNode, device_called
from daidalos.nodes.runner import run


class JoyLinuxNode(JoystickNode):
    """Node that publishes ``joy``.

    Parameters of the node: ``dev`` (the game pad's file), ``dev_name`` (its name, which comes first where it is not
    empty and there is such a game pad), ``deadzone``, ``autorepeat_rate`` [Hz] and ``sticky_buttons`` as in `JoyNode`,
    and ``coalesce_interval`` (for how long axes that move together are waited for [s]).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("joy_node", **kwargs)
        self._path = Path(str(self.declare_parameter("dev", "/dev/input/js0").value))
        self._name = str(self.declare_parameter("dev_name", "").value)
        self.start()

    def declare_coalescing(self) -> float:
        """Declare for how long axes are waited for, and return it [s]."""
        return float(self.declare_parameter("coalesce_interval", 0.001).value or 0.0)

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        named = device_called(self._name, self.folder) if self._name else None
        return named or (self._path if self._path.exists() else None)


def main() -> int:
    """Run the node."""
    return run(JoyLinuxNode)


if __name__ == "__main__":
    sys.exit(main())
