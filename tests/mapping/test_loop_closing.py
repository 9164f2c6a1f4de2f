from dataclasses import replace

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.back_end import GraphSnapshot, find_correction
from daidalos.mapping.config import SlamConfig
from daidalos.mapping.loop_closing import (
    CONFIRMATIONS,
    DRIFT_OF_CLOSURE,
    DRIFT_PER_METRE,
    DRIFT_PER_RADIAN,
    LoopCloser,
    possible_drift,
)
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.scan import Cloud, to_cloud

from .worlds import Lidar, arena, box


def sequence(poses: np.ndarray) -> list[Edge]:
    return [Edge(k, k + 1, pose2.between(poses[k], poses[k + 1]), np.eye(3)) for k in range(len(poses) - 1)]


def test_drift_grows_with_the_way_and_turns() -> None:
    poses = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [2.0, 3.0, 1.0]])
    steps = [DRIFT_PER_METRE * 2.0, DRIFT_PER_RADIAN, DRIFT_PER_METRE * 3.0]
    assert possible_drift(0, poses, sequence(poses)) == pytest.approx([0.0, *np.cumsum(steps)], abs=1e-4)


def test_a_closure_is_a_short_cut() -> None:
    poses = np.array([[float(x), 0.0, 0.0] for x in range(30)])
    edges = [*sequence(poses), Edge(0, 29, np.zeros(3), np.eye(3), closure=True)]
    assert possible_drift(29, poses, edges)[0] == pytest.approx(DRIFT_OF_CLOSURE, abs=1e-5)


def round_trip(
    drift: tuple[float, float, float], world: np.ndarray | None = None
) -> tuple[list[Cloud], np.ndarray, np.ndarray]:
    """Clouds, believed and true poses of a robot that returns to where it began; the way back has drifted."""
    x = np.concatenate([np.linspace(-3.0, 3.0, 24), np.linspace(3.0, -3.0, 24)])
    true = np.stack([x, np.full(48, -2.4), np.repeat([0.0, np.pi], 24)], axis=1)
    rng = np.random.default_rng(0)
    lidar = Lidar(beams=360, field=2.0 * np.pi * 359 / 360)
    clouds = [to_cloud(lidar.scan(arena() if world is None else world, pose, rng), 20.0) for pose in true]
    believed = true.copy()
    for k in range(24, 48):
        believed[k] = pose2.compose(drift, true[k])
    return clouds, believed, true


@pytest.mark.parametrize("drift", [(0.0, 0.0, 0.0), (0.25, -0.15, 0.04), (-0.2, 0.2, -0.06)])
def test_the_true_motion_is_found_in_spite_of_drift(drift: tuple[float, float, float]) -> None:
    clouds, believed, true = round_trip(drift)
    closures = LoopCloser(SlamConfig()).search(clouds, believed, sequence(true))
    assert len(closures) == 1
    closure = closures[0]
    assert closure.second == 47
    assert closure.closure
    expected = pose2.between(true[closure.first], true[47])
    assert pose2.between(expected, closure.measurement) == pytest.approx(np.zeros(3), abs=0.01)


def test_another_room_is_no_place_seen_before() -> None:
    clouds, believed, true = round_trip((0.0, 0.0, 0.0))
    obstacles = [box(0.5, 0.2, 1.0, 2.5, 1.0), box(-2.0, 1.0, 0.4, 2.0)]
    elsewhere = np.concatenate([box(0.0, 0.0, 11.0, 9.0, 0.5), *obstacles])
    strangers, _, _ = round_trip((0.0, 0.0, 0.0), elsewhere)
    closures = LoopCloser(SlamConfig()).search([*clouds[:24], *strangers[24:]], believed, sequence(true))
    assert [closure for closure in closures if closure.first < 24] == []


def test_scans_that_are_tied_together_are_not_matched_again() -> None:
    clouds, believed, true = round_trip((0.0, 0.0, 0.0))
    ties = [Edge(k, 47, np.zeros(3), np.eye(3), closure=True) for k in range(24)]
    assert LoopCloser(SlamConfig()).search(clouds, believed, [*sequence(true), *ties]) == []


def test_the_latest_scans_are_no_loop() -> None:
    clouds, believed, true = round_trip((0.0, 0.0, 0.0))
    assert LoopCloser(SlamConfig()).search(clouds[:10], believed[:10], sequence(true[:10])) == []
    assert LoopCloser(SlamConfig()).search(clouds[:1], believed[:1], []) == []


FAR_DRIFT = (0.25, -0.15, 0.04)


def test_places_farther_away_than_the_search_distance_are_tried_as_far_as_the_drift_allows() -> None:
    clouds, believed, true = round_trip(FAR_DRIFT)
    closer = LoopCloser(SlamConfig(loop_search_maximum_distance=0.05))
    found = []
    for newest in range(30, 48):
        count = newest + 1
        closures = closer.search(clouds[:count], believed[:count], sequence(true[:count]))
        assert len(closures) in (0, CONFIRMATIONS + 1)  # one match alone proves nothing
        found.extend(closures)
    assert found
    for closure in found:
        expected = pose2.between(true[closure.first], true[closure.second])
        assert pose2.between(expected, closure.measurement) == pytest.approx(np.zeros(3), abs=0.02)


def test_places_beyond_the_possible_drift_are_not_tried() -> None:
    clouds, believed, true = round_trip((3.0, 2.0, 0.0))
    closer = LoopCloser(SlamConfig(loop_search_maximum_distance=0.05))
    for count in range(31, 49):
        assert closer.search(clouds[:count], believed[:count], sequence(true[:count])) == []


def test_a_wrong_closure_is_taken_out_again_by_right_ones() -> None:
    clouds, believed, true = round_trip(FAR_DRIFT)
    chain = [replace(edge, information=1e4 * np.eye(3)) for edge in sequence(true)]
    wrong = Edge(3, 44, np.array([1.5, 0.5, 0.3]), 1e3 * np.eye(3), closure=True)
    correction = find_correction(LoopCloser(SlamConfig()), GraphSnapshot(clouds, believed, [*chain, wrong], 0))
    assert correction is not None
    assert correction.poses is not None
    assert all(edge is not wrong for edge in correction.edges)
    assert [edge.second for edge in correction.edges if edge.closure] == [47]
    assert pose2.between(true, correction.poses) == pytest.approx(np.zeros((48, 3)), abs=0.02)
