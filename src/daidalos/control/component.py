"""Life cycle of a hardware component: unconfigured, inactive, active, finalized."""

from __future__ import annotations

from daidalos.common.rate_gate import RateGate
from daidalos.control.contracts import Hardware
from daidalos.control.errors import HardwareError, StateError
from daidalos.control.interfaces import Interfaces
from daidalos.control.limits import CommandLimiter

UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED = "unconfigured", "inactive", "active", "finalized"
_STEPS = (UNCONFIGURED, INACTIVE, ACTIVE)


class Component:
    """Hardware with its life-cycle state, read and written at its own rate.

    Parameters
    ----------
    hardware : Hardware
    enforce_limits : bool
        Whether commands are kept within limits.

    Attributes
    ----------
    state : str
    """

    def __init__(self, hardware: Hardware, enforce_limits: bool = True) -> None:
        self.hardware = hardware
        self.name = hardware.info.name
        self.state = UNCONFIGURED
        self._limiter = (
            CommandLimiter(hardware.info.components, hardware.commands, hardware.states) if enforce_limits else None
        )
        self._reading, self._writing = RateGate(hardware.info.rw_rate), RateGate(hardware.info.rw_rate)
        self._last_read = self._last_write = -1

    @property
    def takes_commands(self) -> bool:
        """Return whether the command interfaces are available."""
        return self.state == ACTIVE

    @property
    def tells_states(self) -> bool:
        """Return whether the state interfaces are available."""
        return self.state in (INACTIVE, ACTIVE)

    def interfaces(self, kind: str) -> Interfaces:
        """Return all interfaces of a kind, ``command`` or ``state``."""
        return self.hardware.commands if kind == "command" else self.hardware.states

    def go_to(self, target: str) -> None:
        """Pass through the states up to `target`.

        Raises
        ------
        StateError
            When it cannot be reached.
        HardwareError
            When the hardware refuses; the component is then unconfigured.
        """
        if target not in (*_STEPS, FINALIZED) or self.state == FINALIZED != target:
            raise StateError(f"hardware '{self.name}' cannot go from '{self.state}' to '{target}'")
        goal = _STEPS.index(UNCONFIGURED if target == FINALIZED else target)
        try:
            while self.state != FINALIZED and _STEPS.index(self.state) != goal:
                self._step(up=_STEPS.index(self.state) < goal)
        except HardwareError:
            self.state = UNCONFIGURED
            raise
        self.state = target

    def _step(self, up: bool) -> None:
        hardware = self.hardware
        if up and self.state == UNCONFIGURED:
            hardware.configure()
            self._last_read = self._last_write = -1
            self.state = INACTIVE
        elif up:
            hardware.activate()
            if self._limiter is not None:
                self._limiter.reset()
            self.state = ACTIVE
        elif self.state == ACTIVE:
            hardware.deactivate()
            self.state = INACTIVE
        else:
            hardware.cleanup()
            self.state = UNCONFIGURED

    def read(self, now_ns: int, period: float) -> None:
        """Read the hardware when it is due; `period` [s] is used where nothing was read before."""
        if not self.tells_states or not self._reading.is_due(now_ns):
            return
        elapsed = (now_ns - self._last_read) * 1e-9 if 0 <= self._last_read < now_ns else period
        self._last_read = now_ns
        self.hardware.read(now_ns, elapsed)

    def write(self, now_ns: int, period: float) -> None:
        """Limit the commands, and write them when it is due."""
        if not self.takes_commands or not self._writing.is_due(now_ns):
            return
        elapsed = (now_ns - self._last_write) * 1e-9 if 0 <= self._last_write < now_ns else period
        self._last_write = now_ns
        if self._limiter is not None:
            self._limiter.apply(elapsed)
        self.hardware.write(now_ns, elapsed)
