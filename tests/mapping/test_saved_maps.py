"""Localization in a saved map, and mapping that goes on from it."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.lifelong import KeyScanDecay, LifelongConfig
from daidalos.mapping.pose_graph_file import SavedGraph, load_pose_graph, save_pose_graph
from daidalos.mapping.slam import Slam, SlamConfig

from .worlds import Lidar, arena, drive, wheel_odometry

RATE = 5.0
LIDAR = Lidar(beams=180, field=np.pi, pose=(0.1, 0.0, 0.2))
CONFIG = SlamConfig(match_every_scan=True)
TOUR = np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [-3.0, 2.3], [-3.0, -0.5]])


def play(slam: Slam, corners: np.ndarray, seed: int, frame: tuple[float, float, float] = (0.0, 0.0, 0.0)):
    """Drive from corner to corner with odometry in a frame of its own; return the truth and the results."""
    rng = np.random.default_rng(seed)
    true = drive(corners, speed=0.8, rate=RATE)
    odometry = pose2.compose(np.array(frame), wheel_odometry(true, rng, scale=0.02, noise=0.05))
    results = [
        slam.add_scan(round(k * 1e9 / RATE), LIDAR.scan(arena(), pose, rng), odom)
        for k, (pose, odom) in enumerate(zip(true, odometry, strict=True))
    ]
    return true, results


@cache
def mapped() -> SavedGraph:
    slam = Slam(CONFIG)
    play(slam, TOUR, seed=7)
    return slam.saved()


def gaps(true: np.ndarray, results: list) -> np.ndarray:
    gap = pose2.between(true, np.array([result.pose for result in results]))
    return np.hypot(gap[:, 0], gap[:, 1])


@pytest.mark.slow
def test_a_robot_is_localized_from_a_rough_first_guess_and_the_map_stays(tmp_path: Path) -> None:
    save_pose_graph(mapped(), tmp_path / "arena")
    slam = Slam(CONFIG, load_pose_graph(tmp_path / "arena"))
    slam.localizing = True
    before = slam.grid().data
    corners = np.array([[1.0, -2.0], [2.8, 1.5], [-1.0, 2.0]])
    start = drive(corners, speed=0.8, rate=RATE)[0]
    slam.start_at(pose2.compose(start, (0.5, -0.4, 0.4)))
    true, results = play(slam, corners, seed=3, frame=(20.0, -7.0, 2.0))
    assert all(result.matched for result in results[:3])
    assert gaps(true, results).max() < 0.08
    assert slam.key_count == len(mapped().clouds)
    assert np.array_equal(slam.grid().data, before)


def test_a_guess_in_another_room_is_reported() -> None:
    slam = Slam(CONFIG, mapped())
    slam.localizing = True
    slam.start_at((40.0, 40.0, 0.0))
    result = slam.add_scan(0, LIDAR.scan(arena(), np.zeros(3), np.random.default_rng(1)), np.zeros(3))
    assert not result.matched
    assert "does not fit the map near (40.00, 40.00)" in result.problem


def test_a_map_goes_on_from_a_pose_and_from_its_first_scan() -> None:
    corners = np.array([[-3.0, -2.3], [0.0, -2.0], [2.0, 0.0]])
    start = drive(corners, speed=0.8, rate=RATE)[0]
    for begin in (Slam.start_at_first, lambda slam: slam.start_at(pose2.compose(start, (0.3, 0.2, -0.2)))):
        slam = Slam(CONFIG, mapped())
        begin(slam)
        true, results = play(slam, corners, seed=5, frame=(-4.0, 9.0, -1.0))
        assert results[0].added
        assert results[0].matched
        assert gaps(true, results).max() < 0.08
        assert slam.key_count > len(mapped().clouds)


def test_mapping_and_localization_change_over() -> None:
    slam = Slam(CONFIG)
    true = drive(np.array([[-3.0, -2.3], [0.0, -2.3], [-1.0, -1.0], [-3.0, -2.0]]), speed=0.8, rate=RATE)
    rng = np.random.default_rng(4)
    counts, results = [], []
    for k, pose in enumerate(true):
        slam.localizing = len(true) // 3 <= k < 2 * len(true) // 3
        results.append(slam.add_scan(round(k * 1e9 / RATE), LIDAR.scan(arena(), pose, rng), pose))
        counts.append(slam.key_count)
    assert counts[0] < counts[len(true) // 3 - 1] == counts[2 * len(true) // 3 - 1] < counts[-1]
    assert np.mean([result.matched for result in results[1:]]) > 0.8
    assert gaps(true, results).max() < 0.08


def test_a_key_scan_that_is_moved_by_hand_takes_the_map_with_it() -> None:
    slam = Slam(CONFIG, mapped())
    last = slam.key_count - 1
    wanted = pose2.compose(slam.key_pose(last), (0.3, 0.1, 0.05))
    first, middle = slam.key_pose(0), slam.key_pose(last // 2)
    slam.move_keys({last: wanted})
    assert slam.key_pose(last) == pytest.approx(wanted, abs=0.05)
    assert slam.key_pose(0) == pytest.approx(first)
    assert 0.01 < np.hypot(*(slam.key_pose(last // 2) - middle)[:2]) < 0.3


def test_removed_key_scans_leave_a_connected_map() -> None:
    slam = Slam(CONFIG, mapped())
    slam.grid()
    whole = Slam(CONFIG, mapped())
    removed = [3, 4, 10]
    slam.remove_keys([*removed, slam.key_count - 1])
    kept = [k for k in range(whole.key_count) if k not in removed]
    assert slam.key_poses == pytest.approx(whole.key_poses[kept])
    ends = {(edge.first, edge.second) for edge in slam.edges}
    assert {(k, k + 1) for k in range(slam.key_count - 1)} <= ends
    measured = next(edge.measurement for edge in slam.edges if (edge.first, edge.second) == (2, 3))
    assert measured == pytest.approx(pose2.between(whole.key_pose(2), whole.key_pose(5)), abs=0.05)
    redrawn = Slam(CONFIG, slam.saved())
    assert np.array_equal(slam.grid().data, redrawn.grid().data)


@pytest.mark.slow
@pytest.mark.parametrize("tree", [False, True])
def test_a_map_does_not_grow_in_a_place_that_is_known(tree: bool) -> None:
    slam, decay = Slam(CONFIG), KeyScanDecay(LifelongConfig(lifelong_search_use_tree=tree))
    rng = np.random.default_rng(2)
    counts = []
    for k in range(120):
        pose = np.array([0.2 * np.cos(0.3 * k), 0.2 * np.sin(0.3 * k), 0.3 * k])
        if slam.add_scan(k * 200_000_000, LIDAR.scan(arena(), pose, rng), pose).added:
            decay.update(slam)
        counts.append(slam.key_count)
    assert counts[-1] < 0.7 * 120
    assert counts[-1] < 1.1 * max(counts[:80])
    assert slam.key_pose(0) == pytest.approx([0.2, 0.0, 0.0], abs=0.01)
