"""How true and how fast SLAM is: two classic logs against ground truth, and the time of its parts."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from daidalos.common import pose2
from daidalos.common.kernels import warm_up
from daidalos.mapping.evaluation import clock_offset, read_relations, relation_errors, shifted
from daidalos.mapping.grid import ScanGrid
from daidalos.mapping.log import read_log
from daidalos.mapping.offline import map_log
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window
from daidalos.mapping.slam import Slam, SlamConfig

DATA = Path(os.environ.get("DAIDALOS_SHARED_DATA", Path(__file__).parents[2] / "shared" / "data")) / "slam"
LOGS = ("intel_5hz", "fr079")


def run() -> dict[str, float | str]:
    """Measure everything; times are medians."""
    start = time.perf_counter()
    warm_up("daidalos.mapping")
    results: dict[str, float | str] = {"mapping.warm_up_s": time.perf_counter() - start}
    for name in LOGS:
        if (DATA / name).is_dir():
            results |= measure_log(name)
        else:
            results[f"mapping.{name}"] = f"no log at {DATA / name}"
    return results | measure_parts() | measure_online()


def measure_log(name: str) -> dict[str, float | str]:
    """Measure the error of the trajectory, which follows odometry between scans, and the time of mapping."""
    log = read_log(DATA / name)
    truth = name.split("_")[0]
    relations = read_relations(DATA / truth / f"{truth}.relations")
    start = time.perf_counter()
    mapped = map_log(log, SlamConfig(minimum_travel_distance=0.3, minimum_travel_heading=0.3))
    seconds = time.perf_counter() - start
    trajectory = mapped.trajectory_ns, mapped.trajectory
    errors = relation_errors(*trajectory, relations).summary()
    offset = clock_offset(*trajectory, relations)
    after = relation_errors(*trajectory, shifted(relations, offset)).summary()
    duration = float(log.stamps_ns[-1] - log.stamps_ns[0]) * 1e-9
    odometry = relation_errors(log.odometry_stamps_ns, log.all_odometry, relations).summary()
    return {
        f"mapping.{name}_translation_m": errors["translation_mean_m"],
        f"mapping.{name}_translation_median_m": errors["translation_median_m"],
        f"mapping.{name}_translation_std_m": errors["translation_std_m"],
        f"mapping.{name}_rotation_deg": errors["rotation_mean_deg"],
        f"mapping.{name}_clock_offset_s": offset,
        f"mapping.{name}_with_offset_translation_m": after["translation_mean_m"],
        f"mapping.{name}_with_offset_rotation_deg": after["rotation_mean_deg"],
        f"mapping.{name}_odometry_translation_m": odometry["translation_mean_m"],
        f"mapping.{name}_seconds": seconds,
        f"mapping.{name}_real_time_factor": duration / seconds,
        f"mapping.{name}_ms_per_scan": 1e3 * seconds / len(log.scans),
    }


def measure_parts() -> dict[str, float | str]:
    """Measure the parts of SLAM on a room of 8 m x 6 m, seen by 820 beams from ten places."""
    poses = np.array([[-2.0 + 0.3 * k, 0.2 * k - 1.0, 0.1 * k] for k in range(10)])
    clouds = [to_cloud(room(pose, k), 20.0) for k, pose in enumerate(poses)]
    scan, pose = room(np.array([0.5, 0.3, 0.8]), 99), np.array([0.5, 0.3, 0.8])
    cloud = to_cloud(scan, 20.0)
    near = PointMap(clouds, poses)
    window = Window(distance=0.25, angle=np.deg2rad(10.0))
    near.correlate(cloud.points, pose, window)
    guess = pose2.compose(pose, (0.02, 0.01, 0.02))
    far = pose2.compose(pose, (0.2, -0.15, 0.15))
    grid = ScanGrid(0.05)
    return {
        "mapping.scan_to_points_ms": milliseconds(lambda: to_cloud(scan, 20.0)),
        "mapping.prepare_ten_scans_ms": milliseconds(lambda: prepare(clouds, poses, window)),
        "mapping.correlate_half_metre_20_deg_ms": milliseconds(lambda: near.correlate(cloud.points, far, window)),
        "mapping.point_to_line_ms": milliseconds(lambda: near.refine(cloud.points, cloud.normals, guess)),
        "mapping.draw_scan_820_beams_ms": milliseconds(lambda: grid.add(cloud, pose)),
        "mapping.classify_grid_ms": milliseconds(grid.classify),
    }


def prepare(clouds: list[Cloud], poses: np.ndarray, window: Window) -> object:
    points = PointMap(clouds, poses)
    return points.likelihood(window), points.reference


def measure_online() -> dict[str, float | str]:
    """Measure a robot with 820 beams at 15 Hz on a round through the room, as in the demo."""
    steps = 15 * 60
    angle = np.linspace(0.0, 6.0 * np.pi, steps)
    poses = np.stack([2.5 * np.cos(angle), 1.8 * np.sin(angle), angle + np.pi / 2], axis=1)
    scans = [room(pose, k) for k, pose in enumerate(poses)]
    rng = np.random.default_rng(0)
    drift = np.cumsum(rng.normal(scale=[0.001, 0.001, 0.0005], size=(steps, 3)), axis=0)
    odometry = pose2.compose(poses, drift)
    slam = Slam(SlamConfig(match_every_scan=True))
    slam.defers_closing = True  # as the node has it
    times, errors, draws, closings = [], [], [], []
    for k in range(steps):
        start = time.perf_counter()
        result = slam.add_scan(round(k / 15 * 1e9), scans[k], odometry[k])
        times.append(time.perf_counter() - start)
        start = time.perf_counter()
        slam.close_loops()
        closings.append(time.perf_counter() - start)
        errors.append(
            np.hypot(*pose2.between(pose2.compose(slam_frame(poses[0], odometry[0]), poses[k]), result.pose)[:2])
        )
        if k % 30 == 0:
            start = time.perf_counter()
            slam.grid(100)
            draws.append(time.perf_counter() - start)
    return {
        "mapping.online_ms_per_scan": 1e3 * statistics.mean(times),
        "mapping.online_scan_p99_ms": 1e3 * float(np.percentile(times[15:], 99)),
        "mapping.online_longest_scan_ms": 1e3 * max(times[15:]),
        "mapping.online_longest_closing_ms": 1e3 * max(closings),
        "mapping.online_longest_map_ms": 1e3 * max(draws[1:]),
        "mapping.online_rmse_m": float(np.sqrt(np.mean(np.square(errors)))),
    }


def slam_frame(true: np.ndarray, odometry: np.ndarray) -> np.ndarray:
    """Pose of the truth's frame in the map, whose frame is odometry's at the first scan."""
    return pose2.compose(odometry, pose2.inverse(true))


def room(pose: np.ndarray, seed: int, beams: int = 820) -> LaserScanData:
    """Return a scan of a rectangular room with a pillar, in closed form."""
    field = np.deg2rad(270.0)
    increment = field / (beams - 1)
    angles = pose[2] - field / 2 + increment * np.arange(beams)
    dx, dy = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore"):
        ranges = np.minimum(
            np.where(dx > 0.0, (4.0 - pose[0]) / dx, (-4.0 - pose[0]) / dx),
            np.where(dy > 0.0, (3.0 - pose[1]) / dy, (-3.0 - pose[1]) / dy),
        )
    along = -(pose[0] - 0.2) * dx - (pose[1] + 0.3) * dy
    chord = 0.35**2 - (pose[0] - 0.2) ** 2 - (pose[1] + 0.3) ** 2 + along**2
    ranges = np.where((chord > 0.0) & (along > 0.0), along - np.sqrt(np.maximum(chord, 0.0)), ranges)
    ranges = ranges + 0.01 * np.random.default_rng(seed).standard_normal(beams)
    return LaserScanData(ranges.astype(np.float32), -field / 2, increment, 0.05, 25.0)


def milliseconds(work: Callable[[], object], repetitions: int = 50) -> float:
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e3 * statistics.median(times)


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:<45} {value if isinstance(value, str) else format(value, '.4g')}")
