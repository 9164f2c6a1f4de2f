"""Commanded velocity of a base: the last one, until its timeout."""

from __future__ import annotations

import numpy as np

from daidalos.control.contracts import Controller, Subscription
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import VelocityCommand


class VelocityInput:
    """Input of stamped or plain velocities with a timeout.

    Parameters
    ----------
    controller : Controller
        Its clock, and whom to warn.

    Attributes
    ----------
    timeout : float
        Age after which a command counts no more [s]; 0 or less for never.
    """

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.timeout = 0.0
        self.reset()

    def reset(self) -> None:
        """Drop the last command."""
        self._command: VelocityCommand | None = None

    def subscription(self, topic: str, stamped: bool) -> dict[str, Subscription]:
        """Return the subscription to a topic; plain velocities are on one that ends in ``_unstamped``."""
        if stamped:
            return {topic: Subscription(VelocityCommand, self.take)}
        return {f"{topic}_unstamped": Subscription(TwistCommand, self.take_plain)}

    def take_plain(self, command: TwistCommand) -> None:
        """Set a velocity that is valid from now."""
        self.take(VelocityCommand(command.linear, command.angular))

    def take(self, command: VelocityCommand) -> None:
        """Set a velocity that is valid from its stamp, or from now without one."""
        now_ns = self._controller.now_ns
        if not (np.all(np.isfinite(command.linear)) and np.all(np.isfinite(command.angular))):
            self._controller.context.warn("a velocity that is not a number was ignored")
            return
        stamp_ns = command.stamp_ns or now_ns
        if self._is_old(stamp_ns, now_ns):
            late = (now_ns - stamp_ns) * 1e-9
            self._controller.context.warn(f"a velocity whose stamp is {late:.3f} s old was ignored")
            return
        self._command = VelocityCommand(command.linear, command.angular, stamp_ns)

    def latest(self, now_ns: int) -> tuple[float, float, float] | None:
        """Return forward speed, sideways speed and turn rate; None without a command, zeros when it is too old."""
        command = self._command
        if command is None:
            return None
        if self._is_old(command.stamp_ns, now_ns):
            return 0.0, 0.0, 0.0
        return float(command.linear[0]), float(command.linear[1]), float(command.angular[2])

    def _is_old(self, stamp_ns: int, now_ns: int) -> bool:
        return self.timeout > 0.0 and now_ns - stamp_ns > round(self.timeout * 1e9)
