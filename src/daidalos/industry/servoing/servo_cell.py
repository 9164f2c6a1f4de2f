"""Simulated cell of a seam servo: a controller with RSI, a joint, a sensor ahead of the tool, and what moves the tool.

The tool gives way beside what the robot reports: slowly as the force changes along the seam, and with the turns of the
spindle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.rsi.configuration import Configuration
from daidalos.industry.rsi.controller import ControllerSettings, SimulatedController
from daidalos.industry.rsi.telegrams import Telegram
from daidalos.industry.servoing.butt_joint import ButtJoint
from daidalos.industry.servoing.profile_sensor import ProfileSensor
from daidalos.industry.welding.experiments import SPINDLE_SPEED

START = 0.045
"""Length that the robot moves before the seam begins [m]."""
RUN_OUT = 0.005
"""Length that it moves on after the seam's end [m]."""
STANDING = np.array([0.0, -90.0, 90.0, 0.0, 90.0, 0.0])
"""Angles of the axes of a robot that stands [deg]."""
ORIGIN = np.array([2300.0, 0.0, 900.0, 0.0, 0.0, 180.0])
"""Pose of the tool at the beginning of the seam [mm, deg]."""


@dataclass(frozen=True)
class ToolMotion:
    """Motion of the tool beside what the robot reports.

    Attributes
    ----------
    drift, drift_length : float
        Amplitude and wavelength of the slow deflection along the seam [m].
    vibration : float
        Amplitude at the spindle's frequency [m].
    """

    drift: float = 0.03e-3
    drift_length: float = 0.5
    vibration: float = 0.02e-3

    def at(self, s: float, time: float) -> float:
        """Return the motion to the left at a length [m] and time [s]."""
        slow = self.drift * math.sin(2.0 * math.pi * s / self.drift_length)
        return slow + self.vibration * math.sin(2.0 * math.pi * SPINDLE_SPEED * time)


class ServoCell:
    """A robot that moves along a joint, and its sensor.

    Parameters
    ----------
    joint : ButtJoint
    configuration : Configuration
        Of the controller.
    speed : float
        [m/s]
    sensor_lead : float
        Distance of the sensor ahead of the tool [m].
    controller : ControllerSettings
    motion : ToolMotion
    seed : int
        Of the sensor's noise.
    blind : tuple of float, optional
        Lengths of the tool between which the sensor sees nothing [m].
    """

    def __init__(
        self,
        joint: ButtJoint,
        configuration: Configuration,
        speed: float,
        sensor_lead: float,
        controller: ControllerSettings,
        motion: ToolMotion,
        seed: int = 0,
        blind: tuple[float, float] | None = None,
    ) -> None:
        self.joint = joint
        self._lead = sensor_lead
        self._motion = motion
        self._blind = blind
        self._sensor = ProfileSensor(joint, seed)
        self.controller = SimulatedController(configuration, straight_program(speed), controller)

    @property
    def s(self) -> float:
        """Length at which the tool is, from the seam's beginning [m]."""
        return float(1e-3 * (self.controller.pose[0] - ORIGIN[0]))

    @property
    def lateral(self) -> float:
        """Where the tool really is, to the left of the programmed path [m]."""
        return float(1e-3 * (self.controller.pose[1] - ORIGIN[1])) + self._motion.at(self.s, self.controller.time)

    @property
    def deviation(self) -> float:
        """Distance of the tool to the left of the seam [m]."""
        return self.lateral - float(self.joint.seam.lateral(np.array([self.s]))[0])

    def profile(self, _: Telegram) -> NDArray[np.float64] | None:
        """Return what the sensor measures now (POINTS,) [m]; None where it is blind."""
        s = self.s
        if self._blind is not None and self._blind[0] <= s < self._blind[1]:
            return None
        return self._sensor.measure(s + self._lead, self.lateral)


def straight_program(speed: float) -> Callable[[float], NDArray[np.float64]]:
    """Return the programmed pose by time (6,) [mm, deg]: along x at a speed [m/s], from `START` before `ORIGIN`."""

    def pose(time: float) -> NDArray[np.float64]:
        out: NDArray[np.float64] = ORIGIN + np.array([1e3 * (speed * time - START), 0.0, 0.0, 0.0, 0.0, 0.0])
        return out

    return pose


class RehearsalSensor:
    """Simulated sensor that a robot's reported position moves over a simulated joint.

    Parameters
    ----------
    joint : ButtJoint
        Its seam begins `START` after the first position, in the direction of `heading` [rad] in the robot's base.
    heading, sensor_lead : float
        [rad], [m]
    seed : int
        Of the noise.
    """

    def __init__(self, joint: ButtJoint, heading: float, sensor_lead: float, seed: int = 0) -> None:
        self._sensor = ProfileSensor(joint, seed)
        self._axes = np.array([[math.cos(heading), math.sin(heading)], [-math.sin(heading), math.cos(heading)]])
        self._lead = sensor_lead
        self._origin: NDArray[np.float64] | None = None

    def __call__(self, telegram: Telegram) -> NDArray[np.float64]:
        """Return the heights where the robot says it is (POINTS,) [m]."""
        actual = telegram.groups["RIst"]
        position = 1e-3 * np.array([actual["X"], actual["Y"]])
        if self._origin is None:
            self._origin = position
        along, lateral = self._axes @ (position - self._origin)
        return self._sensor.measure(float(along) - START + self._lead, float(lateral))
