"""Timing and paths of planned motion against closed forms, linear programmes and the limits themselves."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from benchmarks.motion_reference import polyline_with_parabolas, solve
from daidalos.industry.motion.branches import joints_at
from daidalos.industry.motion.corners import Zone
from daidalos.industry.motion.curves import JointCurve, Line
from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.orientations import matrices
from daidalos.industry.motion.pieces import Limits, sample_wrist_path
from daidalos.industry.motion.planner import Movement, Planner
from daidalos.industry.robots import ARMS

ARM = ARMS["irb120"]
TOOL = np.eye(4)
DOWN = np.array([0.0, 1.0, 0.0, 0.0])
SQUARE = [np.array(one) for one in ([0.35, -0.1, 0.3], [0.35, 0.1, 0.3], [0.45, 0.1, 0.3], [0.45, -0.1, 0.35])]
Z10 = Zone(0.01, 0.015, math.radians(1.5))


def angles_at(position: np.ndarray) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = matrices(DOWN[None])[0], position
    return joints_at(ARM, pose, None, np.radians([0.0, 0.0, 0.0, 0.0, 60.0, 0.0]))


def square(speed: float, zone: Zone | None = Z10, **more: float) -> Planner:
    planner = Planner(ARM, angles_at(SQUARE[0]))
    corners = [*SQUARE, SQUARE[0]]
    for n, (start, end) in enumerate(itertools.pairwise(corners)):
        is_last = n == len(SQUARE) - 1
        limits = Limits(speed=speed, **more)
        movement = Movement(Line(start, end, DOWN, DOWN), limits, None if is_last else zone, TOOL, f"{n}")
        while not planner.append(movement):
            planner.advance(planner.remaining())
    return planner


@pytest.mark.parametrize(("turn", "speed_share"), [(1.5, 1.0), (0.1, 1.0), (1.0, 0.3)])
def test_joint_movement_takes_the_time_of_an_s_curve(turn: float, speed_share: float) -> None:
    start = np.radians([0.0, 0.0, 0.0, 0.0, 30.0, 0.0])
    end = start + np.array([turn, 0.0, 0.0, 0.0, 0.0, 0.0])
    planner = Planner(ARM, start)
    curve = JointCurve.between(ARM, TOOL, start, end)
    v, a = speed_share * ARM.speeds[0], ARM.accelerations[0]
    limits = Limits(rate=curve.length * v / turn)
    assert planner.append(Movement(curve, limits, None, TOOL))
    wanted = turn / v + v / a if turn > v * v / a else 2.0 * math.sqrt(turn / a)
    assert planner.remaining() == pytest.approx(wanted + ARM.ramp_time, rel=1e-6)
    joints, speeds, accelerations = planner.motion_at(np.linspace(0.0, planner.remaining(), 2001))
    assert joints[0] == pytest.approx(start)
    assert joints[-1] == pytest.approx(end, abs=1e-9)
    assert np.abs(speeds[:, 0]).max() <= v * (1.0 + 1e-6)
    assert np.abs(accelerations[:, 0]).max() <= a * (1.0 + 1e-6)
    step = planner.remaining() / 2000
    assert np.abs(np.diff(accelerations[:, 0])).max() / step <= 2.0 * a / ARM.ramp_time * (1.0 + 1e-6)


@pytest.mark.parametrize("speed", [0.1, 0.5, 2.0])
def test_limits_are_kept(speed: float) -> None:
    planner = square(speed)
    times = np.linspace(0.0, planner.remaining(), 4001)
    joints, speeds, accelerations = planner.motion_at(times)
    assert (np.abs(speeds) / ARM.speeds).max() <= 1.01
    assert (np.abs(accelerations) / ARM.accelerations).max() <= 1.06
    tcp = forward(ARM, joints)[:, :3, 3]
    assert (np.linalg.norm(np.diff(tcp, axis=0), axis=1) / np.diff(times)).max() <= 1.01 * speed


def test_path_is_lines_and_parabolas() -> None:
    planner = square(0.5)
    tcp = forward(ARM, planner.joints_at(np.linspace(0.0, planner.remaining(), 1501)))[:, :3, 3]
    corners = [*SQUARE, SQUARE[0]]
    allowed = []
    for start, end in itertools.pairwise(corners):
        along = np.linspace(0.0, 1.0, 20001)[:, None]
        allowed.append(start + along * (end - start))
    for before, corner, after in zip(corners, corners[1:], corners[2:], strict=False):
        a, b = (corner + 0.01 * (one - corner) / np.linalg.norm(one - corner) for one in (before, after))
        u = np.linspace(0.0, 1.0, 4001)[:, None]
        allowed.append((1 - u) ** 2 * a + 2 * u * (1 - u) * corner + u**2 * b)
    points = np.concatenate(allowed)
    gaps = [np.linalg.norm(points - one, axis=1).min() for one in tcp[::10]]
    assert max(gaps) < 2e-5
    for corner, report in zip(corners[1:], planner.corners, strict=False):
        assert np.linalg.norm(tcp - corner, axis=1).min() == pytest.approx(report.deviation, abs=2e-5)


def test_zone_is_reduced_to_half_of_the_segment() -> None:
    planner = square(0.5, Zone(0.2, 0.3, math.radians(30.0)))
    assert [round(one.distance, 6) for one in planner.corners] == [0.05, 0.05, 0.05 * math.sqrt(17.0) / 2] or [
        round(one.distance, 3) for one in planner.corners
    ] == [0.05, 0.05, 0.056]


def test_look_ahead_changes_nothing() -> None:
    """The path appended movement by movement, each at its lead, is the motion planned at once."""
    whole = square(0.3)
    planner = Planner(ARM, angles_at(SQUARE[0]))
    corners = [*SQUARE, SQUARE[0]]
    for n, (start, end) in enumerate(itertools.pairwise(corners)):
        zone = Z10 if n < 3 else None
        assert planner.append(Movement(Line(start, end, DOWN, DOWN), Limits(speed=0.3), zone, TOOL))
        if zone is not None:
            planner.advance(planner.lead())
    assert planner.now + planner.remaining() == pytest.approx(whole.remaining(), rel=1e-2)
    assert not planner.warnings


def test_movement_that_comes_too_late_finds_the_arm_in_the_point() -> None:
    planner = Planner(ARM, angles_at(SQUARE[0]))
    line = Line(SQUARE[0], SQUARE[1], DOWN, DOWN)
    assert planner.append(Movement(line, Limits(speed=0.3), Z10, TOOL, "test.mod:3"))
    planner.advance(planner.remaining() - 0.06)
    following = Movement(Line(SQUARE[1], SQUARE[2], DOWN, DOWN), Limits(speed=0.3), None, TOOL)
    assert not planner.append(following)
    assert planner.warnings == [
        "test.mod:3: 50024 Corner path failure: the next movement came too late; the arm stops in the point"
    ]
    planner.advance(planner.remaining())
    assert planner.append(replace(following, sampled=None))


def test_stop_stays_on_the_path_and_goes_on() -> None:
    planner = square(0.5)
    whole = planner.remaining()
    planner.advance(0.3)
    planner.stop()
    assert math.isinf(planner.remaining())
    braking = planner.braking()
    assert 0.05 < braking < 0.3
    planner.advance(braking)
    rest = planner.motion_at(np.array([planner.now]))
    assert rest[1] == pytest.approx(np.zeros((1, 6)), abs=1e-9)
    position = forward(ARM, rest[0][0])[:3, 3]
    assert position[[0, 2]] == pytest.approx([0.35, 0.3], abs=1e-6)
    planner.advance(1.0)
    assert planner.joints_at(np.array([planner.now])) == pytest.approx(rest[0], abs=1e-12)
    planner.resume()
    assert planner.remaining() + 0.3 > whole
    planner.advance(planner.remaining())
    assert planner.joints == pytest.approx(angles_at(SQUARE[0]), abs=1e-9)


def test_same_calls_give_the_same_bits() -> None:
    times = np.linspace(0.0, 1.0, 101)
    assert square(0.4).joints_at(times).tobytes() == square(0.4).joints_at(times).tobytes()


@pytest.mark.parametrize(
    ("end", "number"),
    [([0.9, 0.1, 0.3], 50050), ([-0.35, 0.01, 0.3], 50027)],
)
def test_faults(end: list[float], number: int) -> None:
    planner = Planner(ARM, angles_at(SQUARE[0]))
    with pytest.raises(MotionFault) as caught:
        planner.append(Movement(Line(SQUARE[0], np.array(end), DOWN, DOWN), Limits(speed=0.3), None, TOOL))
    assert caught.value.number == number, str(caught.value)
    assert planner.is_at_rest


def test_wrist_singularity_on_a_line() -> None:
    before, after = (np.radians([0.0, 10.0, 0.0, 20.0, q5, 0.0]) for q5 in (20.0, -20.0))
    ends = [forward(ARM, one) for one in (before, after)]
    turned = [Rotation.from_matrix(one[:3, :3]).as_quat() for one in ends]
    line = Line(ends[0][:3, 3], ends[1][:3, 3], *turned)
    with pytest.raises(MotionFault, match="axes 4 and 6 are in line") as caught:
        Planner(ARM, before).append(Movement(line, Limits(speed=0.3), None, TOOL))
    assert caught.value.number == 50026
    sampled = sample_wrist_path(ARM, TOOL, line, before, after)
    positions = forward(ARM, sampled.joints)[:, :3, 3]
    share = sampled.x / line.length
    assert positions == pytest.approx(line.start + share[:, None] * (line.end - line.start), abs=1e-9)
    assert sampled.joints[-1] == pytest.approx(after, abs=1e-8)


def test_blended_motion_against_a_fine_reference() -> None:
    planner, corners = square(0.25), [*SQUARE, SQUARE[0]]
    duration = planner.remaining()
    rotation = matrices(DOWN[None])[0]
    path = polyline_with_parabolas(corners, 0.01, 0.002)
    reference = solve(ARM, path, rotation, angles_at(SQUARE[0]), 0.25)
    assert duration == pytest.approx(reference.time, rel=0.03)
    tcp = forward(ARM, planner.joints_at(np.linspace(0.0, duration, 1001)))[:, :3, 3]
    gaps = cKDTree(polyline_with_parabolas(corners, 0.01, 0.00004)).query(tcp)[0]
    assert gaps.max() < 0.1e-3
