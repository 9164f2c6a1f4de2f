import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.common.pose3 import quaternion_from_rpy, rotation_matrix
from daidalos.mapping.evaluation import compare_with_truth
from daidalos.mapping.grid import OccupancyGrid, ScanGrid
from daidalos.mapping.scan import LaserScanData, to_cloud
from daidalos.mapping.slam import ScanResult, Slam, SlamConfig

from .worlds import Lidar, arena, box, cast, corridors, drive, raster, room_scan, wheel_odometry

RATE = 15.0
TOUR = np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [-3.0, 2.3], [-3.0, -0.5], [0.0, 0.0], [3.0, 0.5]])


def common(first: OccupancyGrid, second: OccupancyGrid) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells of two grids where both have some."""
    shift = np.round((np.array(second.origin) - first.origin)[:2] / first.resolution).astype(int)
    begin = np.maximum(0, shift)
    end = np.minimum(first.data.shape[::-1], shift + second.data.shape[::-1])
    cells = [
        grid.data[low[1] : high[1], low[0] : high[0]]
        for grid, low, high in ((first, begin, end), (second, begin - shift, end - shift))
    ]
    return cells[0], cells[1]


@cache
def tour(lidar: Lidar) -> tuple[np.ndarray, np.ndarray, list[LaserScanData]]:
    """Truth, odometry and scans of a tour through the arena."""
    rng = np.random.default_rng(7)
    true = drive(TOUR)
    odometry = wheel_odometry(true, rng, scale=0.02, noise=0.05)
    return true, odometry, [lidar.scan(arena(), pose, rng) for pose in true]


def run(slam: Slam, odometry: np.ndarray, scans: list[LaserScanData]) -> list[ScanResult]:
    period = round(1e9 / RATE)
    return [slam.add_scan(k * period, scan, pose) for k, (scan, pose) in enumerate(zip(scans, odometry, strict=True))]


def errors(results: list[ScanResult], true: np.ndarray) -> np.ndarray:
    gap = pose2.between(true, np.array([result.pose for result in results]))
    return np.hypot(gap[:, 0], gap[:, 1])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lidar", "config"),
    [
        (Lidar(), SlamConfig(match_every_scan=True)),
        (Lidar(), SlamConfig(resolution=0.025, minimum_travel_distance=0.5, minimum_travel_heading=0.5)),
        (Lidar(beams=180, field=np.pi, pose=(0.2, 0.05, 0.3)), SlamConfig()),
        (Lidar(beams=360, pose=(-0.1, 0.0, np.pi)), SlamConfig(minimum_time_interval=0.2)),
    ],
)
def test_the_arena_is_mapped_and_the_robot_stays_localised(lidar: Lidar, config: SlamConfig) -> None:
    true, odometry, scans = tour(lidar)
    slam = Slam(config)
    results = run(slam, odometry, scans)
    off = errors(results, true)
    assert np.hypot(*(odometry[-1] - true[-1])[:2]) > 0.3
    assert np.sqrt(np.mean(off**2)) < 0.03
    assert off.max() < 0.08
    agreement = compare_with_truth(slam.grid(), raster(arena(), config.resolution))
    assert agreement.walls_true > 0.97
    assert agreement.walls_found > 0.9


@pytest.mark.slow
def test_the_pose_is_odometry_corrected_by_the_map() -> None:
    _, odometry, scans = tour(Lidar())
    slam = Slam(SlamConfig(match_every_scan=True))
    for k in range(60):
        result = slam.add_scan(k * 66_666_667, scans[k], odometry[k])
        assert pose2.compose(slam.map_to_odom, odometry[k]) == pytest.approx(result.pose, abs=1e-9)


@pytest.mark.slow
def test_the_same_input_gives_the_same_result() -> None:
    _, odometry, scans = tour(Lidar(beams=360))
    outcomes = []
    for _ in range(2):
        slam = Slam()
        results = run(slam, odometry[:500], scans[:500])
        slam.finish()
        outcomes.append((np.array([result.pose for result in results]), slam.key_poses, slam.grid().data))
    for first, second in zip(*outcomes, strict=True):
        assert np.array_equal(first, second)


@pytest.mark.slow
def test_a_loop_is_closed_and_the_map_follows_in_pieces() -> None:
    """A ring of corridors driven around more than once, with odometry that is metres off at the end."""
    rng = np.random.default_rng(3)
    corner = 8.2
    ring = [[-corner, -corner], [corner, -corner], [corner, corner], [-corner, corner]]
    true = drive(np.array([*ring, *ring[:2]]), rate=5.0)
    odometry = wheel_odometry(true, rng, scale=0.02, noise=0.05)
    lidar = Lidar(beams=360)
    slam = Slam()
    closed = optimized = drawn = 0
    for k, pose in enumerate(true):
        result = slam.add_scan(k * 200_000_000, lidar.scan(corridors(), pose, rng), odometry[k])
        closed, optimized = closed + result.closed, optimized + result.optimized
        drawn += slam.render(3) == 0
    assert np.hypot(*(odometry[-1] - true[-1])[:2]) > 0.8
    assert closed > 5
    assert optimized >= 1
    assert np.hypot(*(result.pose - true[-1])[:2]) < 0.1
    while slam.render(10):
        pass
    pieces = slam.grid()
    whole = ScanGrid(0.05)
    for cloud, pose in zip(slam.key_clouds, slam.key_poses, strict=True):
        whole.add(cloud, pose)
    one, other = common(pieces, whole.classify())
    assert one.size > 0.98 * pieces.data.size
    assert np.mean(one != other) < 0.005
    assert compare_with_truth(pieces, raster(corridors(), 0.05)).walls_true > 0.9
    assert drawn > 0


@pytest.mark.slow
def test_loops_are_closed_beside_the_scans() -> None:
    """The search works on a copy while scans are added, and what they added moves with it."""
    rng = np.random.default_rng(3)
    corner = 8.2
    ring = [[-corner, -corner], [corner, -corner], [corner, corner], [-corner, corner]]
    true = drive(np.array([*ring, *ring[:2]]), rate=5.0)
    odometry = wheel_odometry(true, rng, scale=0.02, noise=0.05)
    lidar = Lidar(beams=360)
    slam = Slam()
    slam.defers_closing = True
    corrections = moved = 0
    snapshot = None
    for k, pose in enumerate(true):
        result = slam.add_scan(k * 200_000_000, lidar.scan(corridors(), pose, rng), odometry[k])
        assert not result.closed
        if k % 9 == 0:  # the search takes as long as nine scans
            if snapshot is not None:
                closed, has_moved = slam.apply(slam.find_correction(snapshot))
                corrections, moved = corrections + closed, moved + has_moved
            snapshot = slam.snapshot_to_close()
    assert corrections > 3
    assert moved >= 1
    assert np.hypot(*(pose2.between(true[-1], pose2.compose(slam.map_to_odom, odometry[-1])))[:2]) < 0.1
    assert len({(edge.first, edge.second) for edge in slam.edges}) == len(slam.edges)
    slam.closing_is_due = True
    snapshot = slam.snapshot_to_close()
    assert snapshot is not None
    before = slam.key_poses
    slam.remove_keys([3])
    assert slam.apply(slam.find_correction(snapshot)) == (False, False), "the graph is another since"
    assert np.array_equal(np.delete(before, 3, axis=0), slam.key_poses)


@pytest.mark.slow
def test_a_featureless_corridor_is_not_compressed() -> None:
    """Nothing but odometry tells the way along it: the match must not hold the robot back."""
    rng = np.random.default_rng(1)
    walls = box(20.0, 0.0, 60.0, 2.4)
    true = drive(np.array([[0.0, 0.0], [30.0, 0.0]]), speed=0.8)
    odometry = wheel_odometry(true, rng, scale=0.02, noise=0.05)
    lidar = Lidar(beams=270)
    slam = Slam(SlamConfig(max_laser_range=8.0))
    results = run(slam, odometry, [lidar.scan(walls, pose, rng) for pose in true])
    assert results[-1].pose[0] == pytest.approx(odometry[-1, 0], abs=0.2)
    assert abs(results[-1].pose[1]) < 0.4


@pytest.mark.slow
def test_the_heading_follows_good_odometry_where_scans_tell_little() -> None:
    """A corridor seen by few, noisy beams: matches alone turn the map by 4 degrees in 20 m."""
    doors = [box(5.0 * k, 1.2 * (-1) ** k, 0.9, 0.2) for k in range(1, 24)]
    walls = np.concatenate([box(60.0, 0.0, 130.0, 2.4), *doors])
    true = drive(np.array([[0.0, 0.0], [120.0, 0.0]]), speed=1.0, rate=1.0)
    lidar = Lidar(beams=60, field=np.pi, noise=0.05)
    turns = []
    for seed in (0, 1):
        rng = np.random.default_rng(seed)
        results = run(Slam(SlamConfig(max_laser_range=6.0)), true, [lidar.scan(walls, pose, rng) for pose in true])
        headings = np.degrees([result.pose[2] for result in results])
        turns.extend(headings[50:] - headings[30:-20])
    assert np.sqrt(np.mean(np.square(turns))) < 3.3


@pytest.mark.slow
def test_scans_may_vary_and_lack_ranges() -> None:
    true, odometry, scans = tour(Lidar(beams=360))
    rng = np.random.default_rng(5)
    damaged = []
    for k, scan in enumerate(scans[:600]):
        ranges = np.array(scan.ranges, dtype=np.float32)[: 360 - k % 7]
        ranges[rng.integers(0, len(ranges), 60)] = rng.choice([np.nan, np.inf, -np.inf, 0.0, 1e9], 60)
        damaged.append(replace(scan, ranges=np.full(0, 1.0) if k % 50 == 49 else ranges))
    off = errors(run(Slam(), odometry[:600], damaged), true[:600])
    assert off.max() < 0.08


def test_a_robot_that_stands_still_stays_where_it_is() -> None:
    slam = Slam(SlamConfig(match_every_scan=True))
    poses = [
        slam.add_scan(k * 66_666_667, room_scan([1.0, 0.5, 0.2], noise=0.01, seed=k), (0.0, 0.0, 0.0)).pose
        for k in range(50)
    ]
    assert np.abs(poses).max() < 0.01
    assert slam.key_count == 1


def test_scans_that_come_too_early_or_too_near_only_follow_odometry() -> None:
    slam = Slam(SlamConfig(minimum_time_interval=1.0, minimum_travel_distance=0.5))
    assert slam.add_scan(0, room_scan([0, -0.5, 0]), (0.0, -0.5, 0.0)).added
    early = slam.add_scan(500_000_000, room_scan([0.6, -0.5, 0]), (0.6, -0.5, 0.0))
    assert not early.matched
    assert early.pose == pytest.approx([0.6, -0.5, 0.0])
    near = slam.add_scan(2_000_000_000, room_scan([0.3, -0.5, 0]), (0.3, -0.5, 0.0))
    assert not near.added
    assert slam.add_scan(3_000_000_000, room_scan([0.6, -0.5, 0]), (0.6, -0.5, 0.0)).added


def test_a_clock_that_is_set_back_does_not_stop_slam() -> None:
    slam = Slam(SlamConfig(minimum_time_interval=0.1))
    slam.add_scan(10**12, room_scan([0, -0.5, 0]), (0.0, -0.5, 0.0))
    assert slam.add_scan(0, room_scan([0.5, -0.5, 0]), (0.5, -0.5, 0.0)).added


def test_a_match_far_from_odometry_is_found_by_the_search() -> None:
    """Wheels that slipped by 0.4 m and 0.4 rad between two key scans."""
    slam = Slam()
    slam.add_scan(0, room_scan([0.0, -0.5, 0.0]), (0.0, 0.0, 0.0))
    result = slam.add_scan(10**9, room_scan([0.3, -0.5, 0.1]), (0.7, 0.1, 0.5))
    assert result.pose == pytest.approx([0.3, 0.0, 0.1], abs=0.01)


def test_a_wall_seen_by_a_turning_lidar_is_straight() -> None:
    """Beams are cast while a robot that stood still turns at 1.5 rad/s; with their times known, the map is sharp."""
    walls = box(0.0, 0.0, 6.0, 5.0)
    beams, period = 360, 0.1
    increment = 2.0 * np.pi / beams
    slams = {True: Slam(SlamConfig(resolution=0.025)), False: Slam(SlamConfig(resolution=0.025))}
    for k in range(48):
        yaw = 1.5 * period * max(0, k - 3)
        turning = 1.5 if k >= 3 else 0.0
        headings = yaw + turning * period * np.arange(beams) / beams
        angles = headings - np.pi + increment * np.arange(beams)
        scan = LaserScanData(cast(walls, np.zeros(2), angles), -np.pi, increment)
        for known, slam in slams.items():
            timed = replace(scan, time_increment=period / beams if known else 0.0)
            slam.add_scan(round(k * period * 1e9), timed, (0.0, 0.0, yaw))
    truth = raster(walls, 0.025)
    sharp = compare_with_truth(slams[True].grid(), truth, within=1.5).walls_true
    smeared = compare_with_truth(slams[False].grid(), truth, within=1.5).walls_true
    assert sharp > 0.95
    assert sharp > smeared + 0.1


def test_nothing_is_mapped_before_the_first_usable_scan() -> None:
    slam = Slam()
    nothing = LaserScanData(np.full(90, np.inf), 0.0, 0.02)
    assert not slam.add_scan(0, nothing, (1.0, 2.0, 0.5)).added
    assert slam.grid().data.size == 0
    assert slam.map_to_odom == pytest.approx(np.zeros(3))
    assert slam.add_scan(1, room_scan([0, -0.5, 0]), (1.0, 2.0, 0.5)).added


@pytest.mark.parametrize("pose", [(np.nan, 0.0, 0.0), (0.0, np.inf, 0.0), (0.0, 0.0)])
def test_odometry_that_is_no_pose_is_refused(pose: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="finite odometry pose"):
        Slam().add_scan(0, room_scan([0, 0, 0]), pose)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"ranges": np.zeros(0, np.float32)}, "it has no ranges"),
        ({"ranges": np.full(360, np.nan, np.float32)}, "all its 360 ranges are NaN"),
        ({"ranges": np.full(360, np.inf, np.float32)}, "all its 360 ranges are infinite"),
        ({"ranges": np.full(360, 99.0, np.float32)}, "all its 360 ranges are outside of its range limits"),
        ({"angle_increment": np.nan}, "its angle_increment is nan"),
        ({"angle_increment": 0.0}, "its angle_increment is 0"),
        ({"range_min": 5.0, "range_max": 1.0}, r"its range_min \(5\) is not below its range_max \(1\)"),
        ({"ranges": np.array([1.0, 1.1, 1.2], np.float32)}, "only 3 of its ranges"),
    ],
)
def test_a_scan_that_cannot_be_used_has_a_reason_and_changes_nothing(changes: dict, reason: str) -> None:
    lidar, rng = Lidar(beams=360), np.random.default_rng(1)
    slam = Slam(SlamConfig(match_every_scan=True))
    first = slam.add_scan(0, replace(lidar.scan(arena(), np.zeros(3), rng), **changes), np.zeros(3))
    assert re.match(reason, first.problem)
    assert not first.added
    assert slam.add_scan(10**8, lidar.scan(arena(), np.zeros(3), rng), np.zeros(3)).added
    bad = slam.add_scan(2 * 10**8, replace(lidar.scan(arena(), np.zeros(3), rng), **changes), np.array([0.3, 0.0, 0.0]))
    assert re.match(reason, bad.problem)
    assert slam.key_count == 1
    assert bad.pose == pytest.approx([0.3, 0.0, 0.0])
    good = slam.add_scan(3 * 10**8, lidar.scan(arena(), np.array([0.3, 0.0, 0.0]), rng), np.array([0.3, 0.0, 0.0]))
    assert good.matched
    assert not good.problem
    assert good.pose == pytest.approx([0.3, 0.0, 0.0], abs=0.03)


def test_jumps_of_odometry_and_of_time_are_reported_and_do_no_harm() -> None:
    lidar, rng = Lidar(beams=360), np.random.default_rng(1)
    slam = Slam(SlamConfig(match_every_scan=True))
    true = drive(np.array([[-3.0, -2.3], [0.0, -2.3]]), rate=5.0)
    reset = np.array([50.0, -20.0, 1.0])
    problems = []
    for k, pose in enumerate(true):
        odom = pose if k < 15 else pose2.compose(reset, pose)
        stamp_ns = (k if k < 20 else k - 15) * 200_000_000
        result = slam.add_scan(stamp_ns, lidar.scan(arena(), pose, rng), odom)
        assert np.hypot(*(result.pose - pose)[:2]) < 0.12
        problems.append(result.problem)
    assert "odometry jumped by" in problems[15]
    assert "before that of the last scan" in problems[20]
    assert all(not problem for k, problem in enumerate(problems) if k not in (15, 20))


@pytest.mark.parametrize("tilt", [(np.pi, 0.0), (0.0, 0.2), (0.15, -0.1)])
def test_a_lidar_that_hangs_upside_down_or_is_tilted_sees_the_same_walls(tilt: tuple[float, float]) -> None:
    """A tilted plane of beams meets upright walls farther away, at directions that are not evenly spaced."""
    yaw, (roll, pitch), count = 0.4, tilt, 720
    angles = -np.pi + 2 * np.pi / count * np.arange(count)
    rotation = rotation_matrix(quaternion_from_rpy(roll, pitch, yaw))
    beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=1) @ rotation.T
    level = np.hypot(beams[:, 0], beams[:, 1])
    ranges = cast(arena(), np.zeros(2), np.arctan2(beams[:, 1], beams[:, 0])) / level
    scan = LaserScanData(ranges.astype(np.float32), -np.pi, 2 * np.pi / count, 0.05, 30.0, 0.0, (0.0, 0.0, yaw), tilt)
    ends = to_cloud(scan, 20.0).ends
    seen = cast(arena(), np.zeros(2), np.arctan2(ends[:, 1], ends[:, 0]))
    assert np.median(np.abs(np.hypot(*ends.T) - seen)) < 1e-3
    assert len(ends) == count
