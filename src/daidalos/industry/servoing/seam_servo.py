"""Servoing of a robot along a seam: each telegram of the robot, with a profile, becomes a correction.

What is seen too late, too rarely or in the wrong place is not followed: the last correction is held, and then the robot
is stopped.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.rsi.telegrams import Telegram
from daidalos.industry.servoing.contracts import LoopSetup, Observation, SeamController
from daidalos.industry.servoing.evaluation import Evaluation, evaluate
from daidalos.industry.servoing.seam_map import SeamMap

Profiles = Callable[[Telegram], NDArray[np.float64] | None]
"""From the robot's telegram to the heights of the profile that was measured with it; None where none came."""

ACQUISITION = 3
"""Profiles in a row that must agree before the first joint counts."""
MAX_ROBOT_STEP = 5e-3
"""Motion of the robot from which its position counts as wrong, beside twice that at its speed [m]."""


class State(Enum):
    """States of the servo."""

    SEARCHING = "searching"
    TRACKING = "tracking"
    HOLDING = "holding"
    STOPPED = "stopped"


@dataclass(frozen=True)
class ServoSettings:
    """Settings of a servo.

    Attributes
    ----------
    setup : LoopSetup
    heading : float
        Direction of the programmed path in the robot's base, about its z [rad].
    sensor_lead : float
        Distance of the sensor ahead of the tool [m].
    hold_after : float
        Time without a seam after which the last correction is held [s].
    stop_after : float
        Time without a seam, or with a correction at its limit, after which the robot is stopped [s].
    max_jump : float
        Step across between profiles from which a joint does not count as the seam [m].
    """

    setup: LoopSetup = field(default_factory=LoopSetup)
    heading: float = 0.0
    sensor_lead: float = 0.035
    hold_after: float = 0.1
    stop_after: float = 1.0
    max_jump: float = 0.8e-3


@dataclass(frozen=True)
class Cycle:
    """What happened in a cycle; lengths [m], NaN where nothing was seen.

    Attributes
    ----------
    ipoc : int
        Of the robot's telegram [ms].
    s, lateral, commanded, correction : float
        Place of the tool along the path and to its left, sum of the corrections, and this cycle's correction.
    seam : float
        Middle of the gap under the sensor, to the left of the path.
    deviation : float
        Of the reported place from the seam that was mapped there.
    evaluation : Evaluation or None
    state : State
    reason : str
        Why the servo stopped.
    """

    ipoc: int
    s: float
    lateral: float
    commanded: float
    correction: float
    seam: float
    deviation: float
    evaluation: Evaluation | None
    state: State
    reason: str = ""


class SeamServo:
    """Handler of an RSI client that follows a seam.

    Parameters
    ----------
    controller : SeamController
    settings : ServoSettings
    profiles : callable
        See `Profiles`.
    each_cycle : callable, optional
        Takes the `Cycle`, and the heights of its profile or None.

    Attributes
    ----------
    state : State
    reason : str
        Why it stopped, empty before.
    """

    def __init__(
        self,
        controller: SeamController,
        settings: ServoSettings,
        profiles: Profiles,
        each_cycle: Callable[[Cycle, NDArray[np.float64] | None], None] | None = None,
    ) -> None:
        self._controller = controller
        self._settings = settings
        self._profiles = profiles
        self._each_cycle = each_cycle
        self._map = SeamMap()
        self._origin: NDArray[np.float64] | None = None
        self._commanded = 0.0
        self._last_s = 0.0
        self._last_ipoc: int | None = None
        self._pending: list[float] = []
        self._last_seam = math.nan
        self._unseen = 0
        self._limited = 0
        self.state = State.SEARCHING
        self.reason = ""

    def __call__(self, telegram: Telegram) -> Mapping[str, Mapping[str, float]]:
        """Return the groups of the answer to a telegram of the robot."""
        place = self._place(telegram)
        if place is None:
            return self._stopped()
        s, lateral = place
        heights = self._profiles(telegram) if self.state is not State.STOPPED else None
        evaluation = None if heights is None else self._look(heights, s, lateral)
        correction = 0.0
        if self.state is not State.STOPPED:
            self._watch(evaluation is not None, s)
        if self.state is State.TRACKING:
            correction = self._correct(s, lateral)
        seam = math.nan if evaluation is None else evaluation.centre + lateral
        if self._each_cycle is not None:
            beside = lateral - float(self._map.seam(np.array([s]))[0]) if self._map.known_end >= s else math.nan
            cycle = Cycle(
                telegram.ipoc, s, lateral, self._commanded, correction, seam, beside, evaluation, self.state,
                self.reason,
            )  # fmt: skip
            self._each_cycle(cycle, heights)
        self._commanded += correction
        return self._stopped() if self.state is State.STOPPED else self._answer(correction)

    def _place(self, telegram: Telegram) -> tuple[float, float] | None:
        """Return where the tool is along the path and to its left [m]; None, and stop, where that is not known."""
        actual = _position(telegram, "RIst")
        if actual is None:
            self._stop("the robot's telegram has no RIst with X and Y")
            return None
        if self._origin is None:
            self._origin = actual
        s, lateral = self._along(actual)
        passed = 1e-3 * (telegram.ipoc - (telegram.ipoc if self._last_ipoc is None else self._last_ipoc))
        if abs(s - self._last_s) > MAX_ROBOT_STEP + 2.0 * self._settings.setup.speed * passed:
            self._stop(f"the robot's place jumped from {1e3 * self._last_s:.1f} to {1e3 * s:.1f} mm")
        self._last_s, self._last_ipoc = s, telegram.ipoc
        wanted = _position(telegram, "RSol")
        if wanted is not None:  # what the controller really added, without lost answers and beyond its limits
            self._commanded = self._along(wanted)[1]
        return s, lateral

    def _along(self, position: NDArray[np.float64]) -> tuple[float, float]:
        assert self._origin is not None
        x, y = position - self._origin
        cosine, sine = math.cos(self._settings.heading), math.sin(self._settings.heading)
        return float(cosine * x + sine * y), float(cosine * y - sine * x)

    def _look(self, heights: NDArray[np.float64], s: float, lateral: float) -> Evaluation | None:
        """Return the joint in a profile where it is the seam, and add it to the map."""
        found = evaluate(heights, expected=self._last_seam - lateral)
        if found is None:
            return None
        seam = found.centre + lateral
        reference = self._last_seam if math.isfinite(self._last_seam) else (self._pending or [seam])[-1]
        if abs(seam - reference) > self._settings.max_jump:
            self._pending.clear()
            return None
        if not math.isfinite(self._last_seam):
            self._pending.append(seam)
            if len(self._pending) < ACQUISITION:
                return None
        self._last_seam = seam
        self._map.add(s + self._settings.sensor_lead, found.fp1[0] + lateral, found.fp2[0] + lateral, found.quality)
        return found

    def _watch(self, seen: bool, s: float) -> None:
        """Change the state by whether the seam is seen."""
        cycle, settings = self._cycle, self._settings
        self._unseen = 0 if seen else self._unseen + 1
        if self._unseen * cycle > settings.stop_after:
            self._stop(f"no seam was seen for {settings.stop_after:g} s, {_at(s)}")
        elif self._unseen * cycle > settings.hold_after:
            if self.state is State.TRACKING:
                self.state = State.HOLDING
                self._controller.hold()
        elif self.state is State.HOLDING or (self.state is State.SEARCHING and self._map.known_end > s):
            self.state = State.TRACKING

    @property
    def _cycle(self) -> float:
        """Time between two corrections [s]."""
        return self._settings.setup.model.cycle

    def _correct(self, s: float, lateral: float) -> float:
        """Return the controller's correction within its limits."""
        setup = self._settings.setup
        observation = Observation(s, lateral, self._commanded, self._map.raw, self._map.seam)
        wanted = self._controller.step(observation)
        if not math.isfinite(wanted):
            self._stop(f"the controller computed {wanted} {_at(s)}")
            return 0.0
        correction = min(max(wanted, -setup.max_step), setup.max_step)
        total = min(max(self._commanded + correction, -setup.max_correction), setup.max_correction)
        at_limit = abs(total) >= setup.max_correction
        self._limited = self._limited + 1 if at_limit else 0
        if self._limited * self._cycle > self._settings.stop_after:
            self._stop(f"the correction is at its limit of {1e3 * setup.max_correction:g} mm, {_at(s)}")
            return 0.0
        return total - self._commanded

    def _stop(self, reason: str) -> None:
        if self.state is not State.STOPPED:
            self.state, self.reason = State.STOPPED, reason

    def _answer(self, correction: float) -> dict[str, dict[str, float]]:
        sine, cosine = math.sin(self._settings.heading), math.cos(self._settings.heading)
        values = {"X": -1e3 * sine * correction, "Y": 1e3 * cosine * correction}
        return {"Stop": {"": 0.0}, "RKorr": values | dict.fromkeys("ZABC", 0.0)}

    def _stopped(self) -> dict[str, dict[str, float]]:
        return self._answer(0.0) | {"Stop": {"": 1.0}}


def _at(s: float) -> str:
    return f"{1e3 * s:.1f} mm after the first place of the robot"


def _position(telegram: Telegram, name: str) -> NDArray[np.float64] | None:
    """Return X and Y of a group (2,) [m]; None where they are not there."""
    group = telegram.groups.get(name, {})
    return 1e-3 * np.array([group["X"], group["Y"]]) if "X" in group and "Y" in group else None
