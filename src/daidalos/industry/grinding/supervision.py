"""Supervision of grinding: reasons to lift the tool off."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.industry.grinding.force_control import Measurement, ValveMode
from daidalos.industry.grinding.settings import PERIOD, CellParameters

CONTACT_FORCE = 1.0
"""Force below which the disc does not touch [N]."""
END_OF_STROKE = 0.5e-3
"""Distance from the ends of the stroke at which the piston is at its end [m]."""


@dataclass(frozen=True)
class Situation:
    """What is known besides the measurement.

    Attributes
    ----------
    time : float
        [s]
    wanted : float
        Wanted force [N].
    is_steady : bool
        Whether the wanted force has not changed for a while.
    torque : float
        Of the spindle [N m].
    wear : float
        Share of the disc's layer that is worn off.
    """

    time: float
    wanted: float
    is_steady: bool
    torque: float
    wear: float


class Supervisor:
    """Checks each measurement while the disc touches the workpiece."""

    def __init__(self, parameters: CellParameters, mode: ValveMode) -> None:
        self._parameters, self._mode = parameters, mode
        self.begin()

    def begin(self) -> None:
        """Forget what has lasted."""
        self._wrong = self._lost = self._at_end = 0.0

    def sensor_problem(self, measured: Measurement, time: float) -> str:
        """Return what is wrong with the force sensor, or nothing."""
        if not math.isfinite(measured.force):
            return f"the force sensor sends {measured.force}"
        if not math.isfinite(measured.position):
            return f"the sensor of the cylinder sends {measured.position}"
        if time - measured.time > self._parameters.sensor.timeout:
            return f"no force for {time - measured.time:.3f} s"
        if measured.force > self._parameters.safety.max_force:
            return f"the force is {measured.force:.0f} N, above {self._parameters.safety.max_force:g} N"
        return ""

    def problem(self, measured: Measurement, now: Situation) -> str:
        """Return why the tool has to be lifted off, or nothing."""
        safety, actuator = self._parameters.safety, self._parameters.actuator
        problem = self.sensor_problem(measured, now.time)
        if problem:
            return problem
        if now.wear >= 1.0:
            return "the disc is worn out"
        if now.torque > self._parameters.spindle.max_torque:
            return f"the spindle's torque is {now.torque:.2f} N m"
        self._lost = self._lost + PERIOD if measured.force < CONTACT_FORCE else 0.0
        if self._lost > safety.contact_loss_time:
            return f"no contact for {safety.contact_loss_time:g} s"
        error = measured.force - now.wanted
        is_wrong = now.is_steady and abs(error) > safety.force_error
        self._wrong = self._wrong + PERIOD if is_wrong else 0.0
        if self._wrong > safety.error_time:
            return (
                f"the force does not follow: {measured.force:.1f} N instead of {now.wanted:.1f} N "
                f"for {safety.error_time:g} s; does the valve work?"
            )
        is_free = self._mode is ValveMode.OPEN
        at_end = not END_OF_STROKE < measured.position < actuator.stroke - END_OF_STROKE
        self._at_end = self._at_end + PERIOD if is_free and at_end else 0.0
        if self._at_end > safety.contact_loss_time:
            return f"the cylinder is at the end of its stroke, {1e3 * measured.position:.1f} mm"
        return ""
