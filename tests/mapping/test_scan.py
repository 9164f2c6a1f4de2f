import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.scan import LINE_TOLERANCE, SPACING, LaserScanData, to_cloud

from .worlds import Lidar, arena, box, cast, room_scan


def test_ends_are_where_the_beams_ended() -> None:
    scan = LaserScanData(np.array([1.0, 2.0, 3.0]), -np.pi / 2, np.pi / 2)
    assert to_cloud(scan, 10.0).ends == pytest.approx(np.array([[0.0, -1.0], [2.0, 0.0], [0.0, 3.0]]))


def test_what_is_no_measurement_is_left_out() -> None:
    ranges = np.array([np.nan, np.inf, -np.inf, 0.0, -1.0, 0.05, 1.0, 31.0], dtype=np.float32)
    cloud = to_cloud(LaserScanData(ranges, 0.0, 0.1, 0.1, 30.0), 10.0)
    assert cloud.ends.shape == (1, 2)
    assert cloud.cleared.shape == (0, 2)


def test_long_beams_clear_up_to_the_largest_range() -> None:
    cloud = to_cloud(LaserScanData(np.array([25.0, 5.0]), 0.0, np.pi / 2, 0.0, 30.0), 10.0)
    assert cloud.ends == pytest.approx(np.array([[0.0, 5.0]]))
    assert cloud.cleared == pytest.approx(np.array([[10.0, 0.0]]))


def test_a_mounted_sensor_sees_the_same_world() -> None:
    """Points of a lidar off the base's centre, turned backwards, lie on the walls."""
    lidar = Lidar(beams=200, noise=0.0, pose=(0.3, -0.1, np.pi))
    robot = np.array([-0.5, -0.8, 0.7])
    cloud = to_cloud(lidar.scan(arena(), robot, np.random.default_rng(0)), 20.0)
    in_world = pose2.transform_points(robot, cloud.ends)
    assert distance_to_walls(in_world, arena()).max() < 1e-9
    assert cloud.origin == pytest.approx([0.3, -0.1])


def test_normals_of_a_square_room_point_inwards() -> None:
    angles = np.linspace(-np.pi, np.pi, 720, endpoint=False)
    ranges = cast(box(0.0, 0.0, 6.0, 6.0), np.zeros(3), angles)
    cloud = to_cloud(LaserScanData(ranges, -np.pi, angles[1] - angles[0]), 20.0)
    inside = np.abs(cloud.points).min(axis=1) < 2.5
    expected = np.where(np.abs(cloud.points) > 2.999, -np.sign(cloud.points), 0.0)
    assert cloud.normals[inside] == pytest.approx(expected[inside], abs=1e-6)


def test_normals_follow_the_readable_twin() -> None:
    cloud = to_cloud(room_scan([0.4, -0.6, 0.3], noise=0.01), 20.0)
    reach = np.hypot(*cloud.ends.T)
    twin = np.array([normal_by_svd(cloud.ends, reach, i, 2 * np.pi / 360) for i in range(len(cloud.ends))])
    kept = np.flatnonzero((cloud.ends[:, None] == cloud.points[None]).all(axis=2).any(axis=1))
    assert cloud.normals == pytest.approx(twin[kept], abs=1e-9)
    assert np.mean(np.abs(cloud.normals).sum(axis=1) > 0.0) > 0.6


def test_points_for_matching_keep_their_distance() -> None:
    cloud = to_cloud(room_scan([-3.8, 0.0, 0.0], beams=2000), 20.0)
    steps = np.hypot(*np.diff(cloud.points, axis=0).T)
    assert steps.min() >= SPACING
    assert len(cloud.points) < 0.7 * len(cloud.ends)


def test_a_turning_robot_sees_straight_walls_once_its_motion_is_known() -> None:
    """Each beam is cast from where the robot was then; undone by the twist, the points lie on the walls."""
    twist = np.array([0.5, 0.0, 1.5])
    beams, duration = 400, 0.2
    increment = 2.0 * np.pi / beams
    times = np.arange(beams) * duration / beams
    yaw = twist[2] * times
    radius = twist[0] / twist[2]
    x, y = radius * np.sin(yaw), radius * (1.0 - np.cos(yaw))
    walls = box(0.0, 0.0, 5.0, 4.0)
    ranges = np.array(
        [cast(walls, np.array([x[i], y[i]]), np.array([yaw[i] - np.pi + i * increment]))[0] for i in range(beams)]
    )
    scan = LaserScanData(ranges, -np.pi, increment, time_increment=duration / beams)
    still = distance_to_walls(to_cloud(scan, 20.0).ends, walls)
    known = distance_to_walls(to_cloud(scan, 20.0, (0.5, 0.0, 1.5)).ends, walls)
    assert still.max() > 0.2
    assert known.max() < 1e-3


def test_an_empty_scan_is_an_empty_cloud() -> None:
    cloud = to_cloud(LaserScanData(np.full(90, np.nan), 0.0, 0.01), 10.0)
    assert cloud.points.shape == cloud.normals.shape == cloud.ends.shape == (0, 2)


def normal_by_svd(ends: np.ndarray, reach: np.ndarray, i: int, increment: float) -> np.ndarray:
    """The smallest singular direction of the neighbours that are reached without a jump."""
    radius = max(0.1, 3.5 * reach[i] * increment)
    members = [i]
    for step in (-1, 1):
        j = i
        while 0 <= j + step < len(ends):
            near = np.linalg.norm(ends[j + step] - ends[i]) <= radius
            if not near or np.linalg.norm(ends[j + step] - ends[j]) > radius:
                break
            j += step
            members.append(j)
    if len(members) < 3:
        return np.zeros(2)
    centred = ends[members] - ends[members].mean(axis=0)
    _, (along, across), directions = np.linalg.svd(centred, full_matrices=False)
    if across**2 > len(members) * LINE_TOLERANCE**2 or across**2 > 0.2 * along**2:
        return np.zeros(2)
    normal = directions[1]
    return normal if normal @ ends[i] < 0.0 else -normal


def distance_to_walls(points: np.ndarray, walls: np.ndarray) -> np.ndarray:
    start, along = walls[None, :, :2], walls[None, :, 2:] - walls[None, :, :2]
    offset = points[:, None] - start
    share = np.clip((offset * along).sum(axis=2) / (along**2).sum(axis=2), 0.0, 1.0)
    return np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1)
