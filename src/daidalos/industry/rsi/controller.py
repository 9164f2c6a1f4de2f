"""The controller's side of KUKA RSI, simulated: cycles, lost answers, corrections with their limits, and stops.

Each cycle the controller sends a telegram, takes the answer to it, and moves the robot: to the programmed pose and, on
top of it, the correction, which the robot follows as a system of second order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.rsi.configuration import Configuration
from daidalos.industry.rsi.telegrams import AXES, POSE, Telegram, TelegramError, decode, encode
from daidalos.industry.welding.krl import components_of, pose_of

IPO, IPO_FAST = 0.012, 0.004
"""Cycles [s]."""


@dataclass(frozen=True)
class ControllerSettings:
    """Settings of the controller and its signal flow.

    Attributes
    ----------
    cycle : float
        `IPO` or `IPO_FAST` [s].
    max_lost : int
        Lost answers in a row after which the robot stops.
    relative : bool
        Whether each correction is added to those before (RSI_ON(#RELATIVE)); otherwise it counts from the program.
    position_limit, rotation_limit, axis_limit : float
        Greatest correction of POSCORR and AXISCORR in each direction [mm], [deg], [deg]; it is cut off there.
    monitor : float or None
        Correction at which the robot stops (POSCORRMON) [mm]; None without.
    natural_frequency, damping : float
        Of the robot [rad/s, 1].
    """

    cycle: float = IPO
    max_lost: int = 10
    relative: bool = True
    position_limit: float = 5.0
    rotation_limit: float = 2.0
    axis_limit: float = 5.0
    monitor: float | None = None
    natural_frequency: float = 10.0
    damping: float = 0.7


class SimulatedController:
    """A controller that executes RSI.

    Parameters
    ----------
    configuration : Configuration
        What it sends and receives.
    program : callable
        From time [s] to the programmed pose: X, Y, Z [mm] and A, B, C [deg] (6,).
    settings : ControllerSettings
    axes : array of shape (6,), optional
        Programmed angles A1 to A6 [deg].
    start_ipoc : int
        IPOC of the first cycle [ms].

    Attributes
    ----------
    stopped : str
        Why the robot stopped, empty while it moves.
    lost : int
        Lost answers in a row.
    total_lost : int
        All of them.
    """

    def __init__(
        self,
        configuration: Configuration,
        program: Callable[[float], NDArray[np.float64]],
        settings: ControllerSettings | None = None,
        axes: NDArray[np.float64] | None = None,
        start_ipoc: int = 0,
    ) -> None:
        self.configuration = configuration
        self.settings = settings or ControllerSettings()
        self._program = program
        self._axes = np.zeros(6) if axes is None else np.asarray(axes, dtype=np.float64)
        self._inputs = {(channel.name, channel.key): 0.0 for channel in configuration.received}
        self._commanded = np.zeros(12)
        self._state = np.zeros((2, 12))
        self._transition = _transition(self.settings)
        self._answered = configuration.only_send
        self._start_ipoc = start_ipoc
        self._cycles = 0
        self.lost = 0
        self.total_lost = 0
        self.stopped = ""

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self._cycles * self.settings.cycle

    @property
    def ipoc(self) -> int:
        """Time stamp of the present cycle [ms]."""
        return self._start_ipoc + round(1e3 * self.time)

    @property
    def correction(self) -> NDArray[np.float64]:
        """Commanded correction of the pose (6,) [mm, deg]."""
        out: NDArray[np.float64] = self._commanded[:6].copy()
        return out

    @property
    def pose(self) -> NDArray[np.float64]:
        """Actual pose (6,) [mm, deg]."""
        return _corrected(self._program(self.time), self._state[0, :6])

    @property
    def axes(self) -> NDArray[np.float64]:
        """Actual angles A1 to A6 (6,) [deg]."""
        out: NDArray[np.float64] = self._axes + self._state[0, 6:]
        return out

    def telegram(self) -> bytes:
        """Return the telegram of this cycle."""
        set_pose = _corrected(self._program(self.time), self._commanded[:6])
        known = {
            "RIst": dict(zip(POSE, self.pose.tolist(), strict=True)),
            "RSol": dict(zip(POSE, set_pose.tolist(), strict=True)),
            "AIPos": dict(zip(AXES, self.axes.tolist(), strict=True)),
            "ASPos": dict(zip(AXES, (self._axes + self._commanded[6:]).tolist(), strict=True)),
            "Delay": {"D": float(self.lost)},
        }
        groups: dict[str, dict[str, float]] = {}
        values: dict[str, float] = {}
        for channel in self.configuration.sent:
            if channel.key:
                groups.setdefault(channel.name, {})[channel.key] = known.get(channel.name, {}).get(channel.key, 0.0)
            else:
                values[channel.name] = 0.0
        return encode(Telegram("Rob", "KUKA", self.ipoc, groups, values))

    def take(self, data: bytes) -> str:
        """Take an answer that came within this cycle, and return why it does not count; empty where it does."""
        try:
            answer = decode(data, "Sen")
        except TelegramError as error:
            return str(error)
        if answer.sender != self.configuration.sensor:
            return f"Type is '{answer.sender}', but '{self.configuration.sensor}' is expected"
        if answer.ipoc != self.ipoc:
            return f"IPOC is {answer.ipoc}, but {self.ipoc} is expected"
        self._reset_inputs()
        for name, key in self._inputs:
            value = answer.groups.get(name, {}).get(key) if key else answer.values.get(name)
            if value is not None:
                self._inputs[name, key] = value
        self._answered = True
        return ""

    def step(self) -> None:
        """Count the answer, correct within the limits, and move the robot for a cycle."""
        if not self._answered:
            self._lose()
        else:
            self.lost = 0
        self._answered = self.configuration.only_send
        if self.stopped:
            return
        if self._inputs.get(("Stop", ""), 0.0) > 0.5:
            self.stopped = "the sensor asked for it"
            return
        self._correct()
        if not self.stopped:
            self._cycles += 1
            deviation = self._state - np.stack([self._commanded, np.zeros(12)])
            self._state = np.stack([self._commanded, np.zeros(12)]) + self._transition @ deviation

    def _lose(self) -> None:
        self.lost += 1
        self.total_lost += 1
        self._reset_inputs()
        if self.lost >= self.settings.max_lost:
            self.stopped = f"{self.lost} answers in a row were lost"

    def _reset_inputs(self) -> None:
        for channel in self.configuration.received:
            if not channel.holds:
                self._inputs[channel.name, channel.key] = 0.0

    def _correct(self) -> None:
        names = [("RKorr", key) for key in POSE] + [("AK", key) for key in AXES]
        asked = np.array([self._inputs.get(name, 0.0) for name in names])
        wanted = self._commanded + asked if self.settings.relative else asked
        settings = self.settings
        limits = np.repeat([settings.position_limit, settings.rotation_limit, settings.axis_limit], [3, 3, 6])
        self._commanded = np.clip(wanted, -limits, limits)
        distance = float(np.linalg.norm(self._commanded[:3]))
        if settings.monitor is not None and distance > settings.monitor:
            self.stopped = f"the correction is {distance:.3f} mm, but {settings.monitor:g} mm are allowed"


def _transition(settings: ControllerSettings) -> NDArray[np.float64]:
    """Return how the robot's deviation from its command and its speed go on over a cycle (2, 2)."""
    from scipy.linalg import expm

    w = settings.natural_frequency
    out: NDArray[np.float64] = expm(np.array([[0.0, 1.0], [-(w**2), -2.0 * settings.damping * w]]) * settings.cycle)
    return out


def _corrected(pose: NDArray[np.float64], correction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a pose (6,) with a correction (6,) in the axes of the base, both [mm, deg]."""
    if not correction[3:].any():
        out: NDArray[np.float64] = pose + correction
        return out
    turned = pose_of(dict(zip(POSE, pose.tolist(), strict=True)))
    turn = pose_of(dict(zip(POSE, correction.tolist(), strict=True)))
    turned[:3, :3] = turn[:3, :3] @ turned[:3, :3]
    turned[:3, 3] += turn[:3, 3]
    return np.array(list(components_of(turned).values()))
