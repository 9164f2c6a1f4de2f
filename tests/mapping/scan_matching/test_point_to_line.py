import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from daidalos.mapping.scan_matching.buckets import build_reference
from daidalos.mapping.scan_matching.point_to_line import POINT_DEVIATION, match_information, refine

from ..worlds import box, cast, room_scan


def cloud_at(pose: np.ndarray, noise: float = 0.0, seed: int = 0) -> Cloud:
    return to_cloud(room_scan(pose, beams=720, noise=noise, seed=seed), 20.0)


@pytest.mark.parametrize("offset", [(0.1, -0.05, 0.03), (-0.12, 0.08, -0.05), (0.0, 0.0, 0.08)])
def test_the_motion_between_two_scans_is_found(offset: tuple[float, float, float]) -> None:
    first, second = np.array([0.2, -0.3, 0.1]), np.array([0.35, -0.2, 0.25])
    reference = build_reference(cloud_at(first).points, cloud_at(first).normals, 0.3)
    true = pose2.between(first, second)
    match = refine(cloud_at(second).points, cloud_at(second).normals, reference, true + offset, reach=0.3)
    assert match.pose == pytest.approx(true, abs=2e-3)
    assert match.inlier_ratio > 0.9
    assert match.residual < 5e-3


def test_noise_averages_out() -> None:
    pose = np.array([0.2, -0.3, 0.1])
    reference = build_reference(cloud_at(pose, 0.01, 1).points, cloud_at(pose, 0.01, 1).normals, 0.3)
    errors = []
    for seed in range(2, 12):
        cloud = cloud_at(pose, 0.01, seed)
        errors.append(refine(cloud.points, cloud.normals, reference, np.array([0.05, 0.05, 0.02])).pose)
    assert np.abs(np.mean(errors, axis=0)).max() < 3e-3
    assert np.abs(errors).max() < 8e-3


def test_a_stranger_in_the_room_does_not_matter() -> None:
    """A third of the beams end on something that was not there before."""
    pose = np.array([0.2, -0.3, 0.1])
    before = cloud_at(pose)
    scan = room_scan(pose, beams=720)
    ranges = np.array(scan.ranges)
    ranges[100:340] *= 0.6
    changed = to_cloud(LaserScanData(ranges, scan.angle_min, scan.angle_increment), 20.0)
    reference = build_reference(before.points, before.normals, 0.3)
    match = refine(changed.points, changed.normals, reference, np.array([0.05, -0.05, 0.03]))
    assert match.pose == pytest.approx(np.zeros(3), abs=5e-3)
    assert match.inlier_ratio < 0.85


def test_the_normal_matrix_is_the_curvature_of_the_cost() -> None:
    """Twin: the squared distances to the lines, differentiated numerically in the frame of the scan."""
    cloud = cloud_at(np.array([0.2, -0.3, 0.1]))
    usable = np.abs(cloud.normals).sum(axis=1) > 0.0
    points, normals = cloud.points[usable], cloud.normals[usable]

    def distances(step: np.ndarray) -> np.ndarray:
        return ((pose2.transform_points(step, points) - points) * normals).sum(axis=1)

    jacobian = np.stack([(distances(h) - distances(-h)) / 2e-6 for h in 1e-6 * np.eye(3)], axis=1)
    match = refine(cloud.points, cloud.normals, build_reference(cloud.points, cloud.normals, 0.3), np.zeros(3))
    scale = np.sqrt(np.diag(jacobian.T @ jacobian))
    assert match.normal_matrix / scale / scale[:, None] == pytest.approx(
        jacobian.T @ jacobian / scale / scale[:, None], abs=0.03
    )


def test_a_corridor_tells_nothing_about_the_way_along_it() -> None:
    angles = np.linspace(-np.pi, np.pi, 720, endpoint=False)
    rng = np.random.default_rng(3)
    ranges = cast(box(0.0, 0.0, 200.0, 2.0), np.zeros(2), angles) + 0.01 * rng.standard_normal(720)
    cloud = to_cloud(LaserScanData(ranges, -np.pi, angles[1] - angles[0]), 8.0)
    reference = build_reference(cloud.points, cloud.normals, 0.3)
    match = refine(cloud.points, cloud.normals, reference, np.array([0.0, 0.1, 0.05]))
    assert match.pose[1:] == pytest.approx(np.zeros(2), abs=2e-3)
    deviation = np.sqrt(np.diag(np.linalg.inv(match_information(match.normal_matrix))))
    assert deviation[0] > 5.0
    assert deviation[1:].max() < 0.05


def test_information_of_a_well_seen_room_is_the_normal_matrix() -> None:
    matrix = np.diag([100.0, 120.0, 900.0])
    information = match_information(matrix)
    assert np.diag(information) == pytest.approx(np.diag(matrix) / POINT_DEVIATION**2, rel=0.03)


def test_nothing_in_reach_leaves_the_guess() -> None:
    cloud = cloud_at(np.zeros(3))
    far = build_reference(cloud.points + 100.0, cloud.normals, 0.3)
    match = refine(cloud.points, cloud.normals, far, np.array([0.1, 0.2, 0.3]))
    assert match.pose == pytest.approx([0.1, 0.2, 0.3])
    assert match.inlier_ratio == 0.0
    empty = refine(np.empty((0, 2)), np.empty((0, 2)), far, np.zeros(3))
    assert empty.inlier_ratio == 0.0
