"""Sensors that repeat the same data while the robot moves."""

import numpy as np

from daidalos.navigation.costmap.frozen_data import FrozenData

RANGES = np.array([1.0, 2.0, np.inf, np.nan, 3.0])


def feed(frozen: FrozenData, data: np.ndarray, poses: np.ndarray) -> list[bool]:
    return [frozen.repeats(data, data, pose) for pose in poses]


def driven(count: int, step: float) -> np.ndarray:
    return np.stack([np.arange(count) * step, np.zeros(count), np.zeros(count)], axis=-1)


def test_the_same_data_are_frozen_once_the_robot_has_moved() -> None:
    found = feed(FrozenData(0.3), RANGES, driven(10, 0.02))
    assert found == [False] * 3 + [True] * 7  # from 0.06 m on


def test_a_turn_is_a_motion_too() -> None:
    poses = np.stack([np.zeros(10), np.zeros(10), np.pi - 0.05 + 0.02 * np.arange(10)], axis=-1)
    poses[:, 2] = (poses[:, 2] + np.pi) % (2 * np.pi) - np.pi
    assert feed(FrozenData(0.3), RANGES, poses)[-1]


def test_a_robot_that_stands_may_see_the_same_for_ever() -> None:
    assert not any(feed(FrozenData(0.3), RANGES, driven(100, 0.0)))


def test_new_data_end_it() -> None:
    frozen = FrozenData(0.3)
    feed(frozen, RANGES, driven(10, 0.02))
    assert not frozen.repeats(RANGES + 1e-6, RANGES, np.array([0.2, 0.0, 0.0]))


def test_open_ground_and_parts_of_the_robot_are_not_judged() -> None:
    assert not any(feed(FrozenData(0.3), np.full(5, np.inf), driven(100, 0.02)))
    assert not any(feed(FrozenData(0.3), np.array([0.2, np.inf, 0.25]), driven(100, 0.02)))


def test_a_correction_of_the_pose_is_no_motion() -> None:
    poses = np.concatenate([np.zeros((5, 3)), np.tile([2.0, 0.0, 1.0], (5, 1))])
    assert not any(feed(FrozenData(0.3), RANGES, poses))
