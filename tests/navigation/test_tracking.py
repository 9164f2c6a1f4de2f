"""Tracking of moving obstacles against scans that are computed exactly."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.costmap.observation import Observation
from daidalos.navigation.tracking import MovingObstacleTracker, free_standing
from properties import examples

ROOM = 4.0
"""Half of the side [m] of a square room."""


def scan(pose, discs, rays=360, noise=0.0, seed=0):
    """Return the ranges from a pose to discs (x, y, radius) and the walls of a room around the origin."""
    angles = pose[2] + np.linspace(0.0, 2.0 * np.pi, rays, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    with np.errstate(divide="ignore"):
        walls = np.where(directions > 0.0, ROOM - pose[:2], -ROOM - pose[:2]) / directions
    ranges = np.where(walls > 0.0, walls, np.inf).min(axis=1)
    for x, y, radius in discs:
        to = np.array([x, y]) - pose[:2]
        along = directions @ to
        missed = to @ to - along**2
        hit = (along > 0.0) & (missed < radius**2)
        ranges[hit] = np.minimum(ranges[hit], along[hit] - np.sqrt(radius**2 - missed[hit]))
    ranges = ranges + noise * np.random.default_rng(seed).standard_normal(rays)
    return LaserScanData(ranges, 0.0, 2.0 * math.pi / rays, 0.05, 12.0)


def track(paths, robot=lambda t: np.zeros(3), seconds=2.0, rate=10.0, **more):
    """Return the tracker after scans of discs that move by functions of time."""
    tracker = MovingObstacleTracker()
    for k in range(round(seconds * rate)):
        time = k / rate
        pose = np.asarray(robot(time), dtype=float)
        tracker.update(Observation.from_scan(scan(pose, [path(time) for path in paths], seed=k, **more), pose, time))
    return tracker, (round(seconds * rate) - 1) / rate


@examples(25)
@given(angle=st.floats(0.0, 6.28), speed=st.floats(0.5, 1.4), side=st.floats(-1.0, 1.0))
def test_position_and_velocity_of_somebody_who_walks_by(angle, speed, side):
    velocity = speed * np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-velocity[1], velocity[0]]) / speed
    start = math.copysign(1.2 + 0.6 * abs(side), side) * across - velocity
    tracker, now = track([lambda t: (*(start + t * velocity), 0.2)], noise=0.01)
    (found,) = tracker.moving(now)
    assert found.velocity == pytest.approx(velocity, abs=0.25)
    assert np.hypot(*(found.position - (start + now * velocity))) < 0.25


def test_nothing_moves_in_a_room_that_the_robot_drives_through():
    pillars = [lambda t, x=x, y=y: (x, y, 0.15) for x, y in ((1.5, 1.0), (2.0, -1.2), (-1.0, 1.5), (0.3, -1.5))]
    for seed_turn in (0.0, 0.8, -1.5):
        tracker, now = track(
            pillars, lambda t, w=seed_turn: (0.4 * t, 0.1 * math.sin(t), w * t), seconds=3.0, noise=0.01
        )
        assert tracker.moving(now) == []


def test_who_stops_does_not_move_any_more():
    tracker, now = track([lambda t: (1.5, -1.0 + min(t, 1.0), 0.2)], seconds=3.0)
    assert tracker.moving(now) == []
    tracker, now = track([lambda t: (1.5, -1.0 + min(t, 1.0), 0.2)], seconds=1.0)
    assert len(tracker.moving(now)) == 1


def test_two_people_who_pass_each_other_are_two():
    tracker, now = track([lambda t: (1.5, -1.0 + t, 0.2), lambda t: (2.6, 1.0 - t, 0.2)], seconds=1.6)
    speeds = sorted(float(one.velocity[1]) for one in tracker.moving(now))
    assert speeds == pytest.approx([-1.0, 1.0], abs=0.3)


def test_tracks_end_with_their_scans_and_when_time_is_set_back():
    tracker, now = track([lambda t: (1.5, -1.0 + t, 0.2)], seconds=1.5)
    assert tracker.moving(now + 0.5)
    assert not tracker.moving(now + 1.0)
    pose = np.zeros(3)
    tracker.update(Observation.from_scan(scan(pose, []), pose, now - 100.0))
    assert tracker.tracks == []


def test_what_is_partly_hidden_or_wide_is_no_object():
    pose = np.zeros(3)
    free = free_standing(Observation.from_scan(scan(pose, [(1.5, 0.0, 0.2)]), pose, 0.0), 1.0)
    assert len(free) == 1
    assert free[0][0] == pytest.approx([1.35, 0.0], abs=0.1)
    hidden = free_standing(Observation.from_scan(scan(pose, [(1.5, 0.0, 0.2), (2.5, 0.35, 0.2)]), pose, 0.0), 1.0)
    assert len(hidden) == 1
    assert free_standing(Observation.from_scan(scan(pose, [(2.0, 0.0, 0.8)]), pose, 0.0), 1.0) == []
    assert free_standing(Observation.from_scan(scan(pose, []), pose, 0.0), 1.0) == []
