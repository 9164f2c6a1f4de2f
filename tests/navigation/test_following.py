"""Where a robot should be that follows an object."""

import math

import numpy as np
import pytest

from daidalos.navigation.following import FilteredPose, is_reached, pose_at_distance


def test_poses_are_filtered_and_the_filter_begins_anew():
    pose = FilteredPose(0.25, 1.0)
    pose.take(np.array([1.0, 0.0, 3.0]), 10.0)
    pose.take(np.array([2.0, 4.0, -3.0]), 10.5)
    assert pose.pose == pytest.approx([1.25, 1.0, 3.0 + 0.25 * (2.0 * math.pi - 6.0)])
    pose.take(np.array([9.0, 9.0, 0.0]), 10.5)
    assert pose.pose[0] == 1.25
    pose.take(np.array([9.0, 9.0, 0.0]), 12.0)
    assert pose.pose == pytest.approx([9.0, 9.0, 0.0])
    raw = FilteredPose(0.0, 1.0)
    for x in (1.0, 2.0):
        raw.take(np.array([x, 0.0, 0.0]), x)
    assert raw.pose[0] == 2.0


def test_poses_at_a_distance():
    thing, robot = np.array([3.0, 4.0, 0.5]), np.zeros(3)
    at = pose_at_distance(thing, robot, 1.0, skip_orientation=True)
    assert at == pytest.approx([2.4, 3.2, math.atan2(4.0, 3.0)])
    at = pose_at_distance(thing, robot, 1.0, skip_orientation=False)
    assert at == pytest.approx([3.0 - math.cos(0.5), 4.0 - math.sin(0.5), 0.5])


@pytest.mark.parametrize(
    ("robot", "skip", "expected"),
    [
        ((2.1, 0.0, 0.1), True, True),
        ((2.1, 0.0, 0.3), True, False),
        ((1.7, 0.0, 0.0), True, False),
        ((2.5, 0.0, 0.0), True, True),
        ((2.5, 0.0, 0.0), False, False),
    ],
)
def test_when_it_is_reached(robot, skip, expected):
    thing, robot = np.array([3.0, 0.0, 0.0]), np.array(robot)
    target = pose_at_distance(thing, robot, 1.0, skip_orientation=skip)
    assert is_reached(target, robot, thing, 0.15, 0.15, skip_orientation=skip) == expected
