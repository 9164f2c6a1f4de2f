"""Targets that are shown before an arm moves there."""

from __future__ import annotations

import numpy as np
import pytest

from daidalos.common.pose3 import Vector
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.rapid.runtime.announced_arm import AnnouncedArm, Announcement
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.robots import ARMS

from .running import run
from .test_arm import DATA

A, B, C = (0.35, -0.1, 0.2), (0.35, 0.1, 0.2), (0.45, 0.1, 0.2)


class Shown:
    """An arm, and when it showed what: the time, the place, and how fast the arm was."""

    def __init__(self, lead: float) -> None:
        self.found = list[tuple[float, Vector]]()
        self.is_moving = list[bool]()
        self.arm = AnnouncedArm(ARMS["irb120"], Announcement(self.note, lead), sampling=0.01)

    def note(self, place: Vector) -> None:
        """Note a place."""
        now = self.arm.planner.now
        self.found.append((now, place))
        self.is_moving.append(bool(np.abs(self.arm.planner.motion_at(np.array([now]))[1]).max() > 1e-6))

    def drive(self, lines: str) -> float:
        """Run lines, and return the time that they took."""
        outcome, _ = run(f"ConfL \\Off; {lines}", DATA, robot=self.arm)
        assert outcome.reason == "end", outcome.message
        return outcome.time

    def still(self, start: float, end: float) -> bool:
        """Return whether the arm stood all the time."""
        times = np.concatenate([one.times for one in self.arm.samples])
        speeds = np.concatenate([one.speeds for one in self.arm.samples])
        within = (times > start + 0.01) & (times < end - 0.01)
        return bool(np.abs(speeds[within]).max(initial=0.0) < 1e-9)


def places(shown: Shown) -> list[tuple[float, ...]]:
    return [tuple(round(one, 9) for one in place) for _, place in shown.found]


def test_a_standing_arm_waits_for_the_lead() -> None:
    shown, plain = Shown(0.8), ArmRobot(ARMS["irb120"])
    lines = "MoveJ pA, v1000, fine, tPen; MoveL pB, v200, fine, tPen; WaitTime 0.5; MoveL pC, v200, fine, tPen;"
    took = shown.drive(lines)
    usual, _ = run(f"ConfL \\Off; {lines}", DATA, robot=plain)
    assert took == pytest.approx(usual.time + 3 * 0.8, abs=1e-6)
    assert places(shown) == [A, B, C]
    assert shown.is_moving == [False, False, False]
    assert all(shown.still(time, time + 0.8) for time, _ in shown.found)
    assert shown.found[0][0] == 0.0


def test_a_movement_without_a_stop_is_shown_while_the_one_before_ends() -> None:
    shown = Shown(0.3)
    shown.drive("MoveJ pA, v1000, fine, tPen; MoveL pB, v200, z10, tPen; MoveL pC, v200, z10, tPen; "
                "MoveL pA, v200, fine, tPen;")  # fmt: skip
    assert places(shown) == [A, B, C, A]
    assert shown.is_moving == [False, False, True, True]
    arrival = next(  # when the tool is nearest to the corner
        float(times[np.argmin(np.linalg.norm(positions - B, axis=1))])
        for times, positions in [
            (np.concatenate([one.times for one in shown.arm.samples]),
             np.concatenate([one.positions for one in shown.arm.samples]))
        ]
    )  # fmt: skip
    assert arrival - shown.found[2][0] == pytest.approx(0.3, abs=0.06)


def test_joint_targets_and_no_lead() -> None:
    shown = Shown(0.0)
    took = shown.drive("MoveAbsJ [[10,20,-15,5,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, fine, tPen;")
    tip = forward(ARMS["irb120"], np.radians([10.0, 20.0, -15.0, 5.0, 40.0, 0.0])) @ np.array([0.0, 0.0, 0.12, 1.0])
    assert shown.found == [(0.0, pytest.approx(tuple(tip[:3])))]
    assert took < 5.0


def test_a_stopped_arm_shows_nothing_new() -> None:
    shown = Shown(0.2)
    trap = DATA + "TRAP halt\nStopMove; WaitTime 2; StartMove;\nENDTRAP\n"
    outcome, _ = run(
        "ConfL \\Off; MoveJ pA, v1000, fine, tPen; CONNECT number WITH halt; ITimer \\Single, 0.4, number; "
        "MoveL pB, v200, z10, tPen; MoveL pC, v200, fine, tPen;",
        trap,
        robot=shown.arm,
    )
    assert outcome.reason == "end", outcome.message
    assert places(shown) == [A, B, C]
    assert shown.found[2][0] > shown.found[1][0] + 2.0
