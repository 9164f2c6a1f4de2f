"""Limits of speed, acceleration and jerk of a commanded velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

from daidalos.common.parameters import ParameterError, Parameters, parameter

NAN = math.nan


@dataclass(frozen=True)
class SpeedLimits(Parameters):
    """Limits of one direction of motion; NaN for none.

    An acceleration or jerk of zero, with which nothing could ever move, is no limit either.
    """

    has_velocity_limits: bool = parameter(True, "Whether velocity limits apply.")
    has_acceleration_limits: bool = parameter(True, "Whether acceleration and deceleration limits apply.")
    has_jerk_limits: bool = parameter(True, "Whether jerk limits apply.")
    max_velocity: float = parameter(NAN, "Largest velocity.", unit="m/s or rad/s")
    min_velocity: float = parameter(NAN, "Least velocity, negative; NaN for -max_velocity.", unit="m/s or rad/s")
    max_acceleration: float = parameter(NAN, "Largest acceleration ahead.", unit="m/s^2 or rad/s^2")
    min_acceleration: float = parameter(NAN, "Old name of max_deceleration, negative.", unit="m/s^2 or rad/s^2")
    max_deceleration: float = parameter(NAN, "Largest deceleration ahead, negative.", unit="m/s^2 or rad/s^2")
    max_acceleration_reverse: float = parameter(
        NAN, "Largest acceleration backwards, negative.", unit="m/s^2 or rad/s^2"
    )
    max_deceleration_reverse: float = parameter(
        NAN, "Largest deceleration backwards, positive.", unit="m/s^2 or rad/s^2"
    )
    max_jerk: float = parameter(NAN, "Largest jerk.", unit="m/s^3 or rad/s^3")
    min_jerk: float = parameter(NAN, "Least jerk, negative; NaN for -max_jerk.", unit="m/s^3 or rad/s^3")


class SpeedLimiter:
    """Limiter of the velocity in one direction.

    Parameters
    ----------
    limits : SpeedLimits
    name : str
        Of the direction, for errors, such as ``linear.x``.

    Raises
    ------
    ParameterError
        When limits contradict each other.
    """

    def __init__(self, limits: SpeedLimits, name: str = "") -> None:
        given = _switched_on(limits)
        self.upper = _given(given.max_velocity, math.inf)
        self.lower = _given(given.min_velocity, -self.upper)
        self.speed_up = _given(given.max_acceleration, math.inf)
        self.slow_down = abs(_given(given.max_deceleration, _given(given.min_acceleration, self.speed_up)))
        self.speed_up_reverse = abs(_given(given.max_acceleration_reverse, self.speed_up))
        self.slow_down_reverse = abs(_given(given.max_deceleration_reverse, self.slow_down))
        self.jerk_up = _given(given.max_jerk, math.inf)
        self.jerk_down = _given(given.min_jerk, -self.jerk_up)
        for what, lower, upper in (("velocity", self.lower, self.upper), ("jerk", self.jerk_down, self.jerk_up)):
            if lower > upper:
                raise ParameterError(f"{name}.min_{what}", f"is above max_{what}: {lower:g} > {upper:g}")
        if self.speed_up < 0.0:
            raise ParameterError(f"{name}.max_acceleration", f"must not be negative, got {self.speed_up:g}")
        self._jerk = math.isfinite(self.jerk_up) or math.isfinite(self.jerk_down)

    def limit(self, wanted: float, last: float, before: float, period: float) -> float:
        """Return the limited velocity.

        Parameters
        ----------
        wanted : float
            [m/s, rad/s].
        last, before : float
            What was allowed in the last cycle and in the one before.
        period : float
            Between cycles [s].
        """
        if self._jerk:
            change, change_before = wanted - last, last - before
            squared = period * period
            change = change_before + min(max(change - change_before, self.jerk_down * squared), self.jerk_up * squared)
            wanted = last + change
        lowest, highest = self._reachable(last, period)
        wanted = min(max(wanted, lowest), highest)
        return min(max(wanted, self.lower), self.upper)

    def _reachable(self, last: float, period: float) -> tuple[float, float]:
        """Return the range of velocities reachable in one cycle."""
        up, down, back, stop = (
            rate * period if math.isfinite(rate) else math.inf
            for rate in (self.speed_up, self.slow_down, self.speed_up_reverse, self.slow_down_reverse)
        )
        if last > 0.0:
            # Slowing down ends at zero; what is left of the cycle speeds up backwards.
            return (last - down if last >= down else -back * (1.0 - last / down)), last + up
        if last < 0.0:
            return last - back, (last + stop if -last >= stop else up * (1.0 + last / stop))
        return -back, up


def _switched_on(limits: SpeedLimits) -> SpeedLimits:
    """Return the limits without those that are switched off."""
    off: dict[str, Any] = {}
    for kind in ("velocity", "acceleration", "jerk"):
        if not getattr(limits, f"has_{kind}_limits"):
            names = (one.name for one in fields(limits) if one.type != "bool")
            rates = ("acceleration", "deceleration") if kind == "acceleration" else (kind,)
            off |= {name: NAN for name in names if any(rate in name for rate in rates)}
    off |= {
        one.name: NAN
        for one in fields(limits)
        if one.name.endswith(("acceleration", "deceleration", "reverse", "jerk")) and getattr(limits, one.name) == 0.0
    }
    return replace(limits, **off)


def _given(value: float, default: float) -> float:
    return default if math.isnan(value) else value
