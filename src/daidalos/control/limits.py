"""Limits of joint commands, from the robot's description and from its hardware."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from daidalos.control.interfaces import Interfaces
from daidalos.description.joint import Axis, JointType
from daidalos.description.ros2_control import ComponentInfo


class CommandLimiter:
    """Limiter of all commands of a hardware component.

    Positions, speeds and efforts stay within the joint's limits, every interface within its own ``min`` and
    ``max``; a position changes no faster than the joint's speed allows. A speed or effort limit of zero, which many
    descriptions have by mistake, is none.

    Parameters
    ----------
    components : iterable of ComponentInfo
    commands, states : Interfaces
        Of the hardware.
    """

    def __init__(self, components: Iterable[ComponentInfo], commands: Interfaces, states: Interfaces) -> None:
        self._commands, self._states = commands, states
        count = len(commands.names)
        self._lower, self._upper = np.full(count, -math.inf), np.full(count, math.inf)
        rows, speeds, feedback = [], [], []
        for component in components:
            for interface in component.commands:
                if interface.data_type != "double" or not (component.limited and interface.limited):
                    continue
                name = f"{component.name}/{interface.name}"
                row = commands.index[name]
                lower, upper = _joint_range(component, interface.name)
                self._lower[row] = max(lower, interface.lower)
                self._upper[row] = min(upper, interface.upper)
                speed = _speed(component)
                if interface.name == "position" and math.isfinite(speed) and name in states:
                    rows.append(row)
                    speeds.append(speed)
                    feedback.append(states.index[name])
        self._rows, self._speeds = np.array(rows, dtype=np.intp), np.array(speeds)
        self._feedback = np.array(feedback, dtype=np.intp)
        self._idle = not rows and bool(np.all(np.isinf(self._lower)) and np.all(np.isinf(self._upper)))
        self.reset()

    def reset(self) -> None:
        """Drop the last commands."""
        self._last = np.full(len(self._rows), math.nan)

    def apply(self, period: float) -> bool:
        """Limit the commands; return whether any exceeded its limits.

        Parameters
        ----------
        period : float
            Since the last time [s].
        """
        values = self._commands.values
        if self._idle:
            return False
        limited = np.minimum(np.maximum(values, self._lower), self._upper)
        if self._rows.size:
            last = np.where(np.isnan(self._last), self._states.values[self._feedback], self._last)
            last = np.where(np.isnan(last), limited[self._rows], last)
            reach = self._speeds * period
            limited[self._rows] = np.clip(limited[self._rows], last - reach, last + reach)
            self._last = limited[self._rows]
        changed = bool(np.any(limited[~np.isnan(values)] != values[~np.isnan(values)]))
        values[:] = limited
        return changed


def _joint_range(component: ComponentInfo, interface: str) -> tuple[float, float]:
    if component.joint is None:
        return -math.inf, math.inf
    axis = component.joint.axis
    if interface == "position" and component.joint.type is not JointType.CONTINUOUS and axis.lower < axis.upper:
        return axis.lower, axis.upper
    largest = {"velocity": _given(axis.velocity), "effort": _given(axis.effort)}.get(interface, math.inf)
    return -largest, largest


def _speed(component: ComponentInfo) -> float:
    axis = component.joint.axis if component.joint is not None else Axis()
    return _given(axis.velocity)


def _given(limit: float) -> float:
    return limit if limit > 0.0 else math.inf
