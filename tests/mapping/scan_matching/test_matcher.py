import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.scan import to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window, merge

from ..worlds import room_scan


def test_merged_points_stand_where_each_scan_saw_them() -> None:
    poses = np.array([[0.0, 0.0, 0.0], [0.5, -0.5, 1.0]])
    clouds = [to_cloud(room_scan(pose), 20.0) for pose in poses]
    points, normals = merge(clouds, poses)
    assert points == pytest.approx(
        np.concatenate([pose2.transform_points(p, c.points) for p, c in zip(poses, clouds, strict=True)])
    )
    assert normals == pytest.approx(
        np.concatenate([pose2.transform_points((0, 0, p[2]), c.normals) for p, c in zip(poses, clouds, strict=True)])
    )


@pytest.mark.parametrize("guess", [(0.4, 0.3, 0.4), (-0.45, 0.2, -0.45), (0.0, -0.45, 0.3)])
def test_a_scan_is_found_from_half_a_metre_and_half_a_radian_away(guess: tuple[float, ...]) -> None:
    poses = np.array([[0.0, 0.0, 0.0], [0.3, -0.2, 0.5]])
    room = PointMap([to_cloud(room_scan(pose, noise=0.01), 20.0) for pose in poses], poses)
    true = np.array([0.2, 0.1, 0.2])
    scan = to_cloud(room_scan(true, noise=0.01, seed=5), 20.0)
    match = room.correlate(scan.points, true + guess, Window(0.5, 0.5))
    assert match is not None
    fine = room.refine(scan.points, scan.normals, match.pose)
    assert fine.pose == pytest.approx(true, abs=5e-3)


def test_an_empty_map_matches_nothing() -> None:
    empty = PointMap([], np.empty((0, 3)))
    assert empty.correlate(np.ones((5, 2)), np.zeros(3), Window(0.5, 0.5)) is None
    assert empty.refine(np.ones((5, 2)), np.ones((5, 2)), np.zeros(3)).inlier_ratio == 0.0


def test_likelihoods_are_built_once_for_each_kind_of_window() -> None:
    room = PointMap([to_cloud(room_scan([0, 0, 0]), 20.0)], np.zeros((1, 3)))
    assert room.likelihood(Window(0.5, 0.5)) is room.likelihood(Window(0.5, 0.1))
    assert room.likelihood(Window(0.5, 0.5)) is not room.likelihood(Window(4.0, 0.5, 0.1, 0.1))
