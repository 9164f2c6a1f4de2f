from pathlib import Path

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.evaluation import (
    Relations,
    clock_offset,
    compare_with_truth,
    read_relations,
    relation_errors,
    shifted,
)
from daidalos.mapping.log import Log, read_log
from daidalos.mapping.offline import LogMap, map_log
from daidalos.mapping.scan import LaserScanData

from .bags import write_bag
from .worlds import arena, raster


@pytest.mark.slow
def test_a_bag_becomes_a_map_and_a_trajectory(tmp_path: Path) -> None:
    true = write_bag(tmp_path / "bag")
    log = read_log(tmp_path / "bag")
    seen: list[int] = []
    mapped = map_log(log, progress=seen.append)
    assert seen == list(range(1, len(true) + 1))
    off = pose2.between(true, mapped.poses)
    assert np.hypot(off[:, 0], off[:, 1]).max() < 0.05
    assert compare_with_truth(mapped.grid, raster(arena(), 0.05)).walls_true > 0.95


def test_scans_before_the_first_usable_one_keep_odometry() -> None:
    nothing = LaserScanData(np.full(90, np.inf), 0.0, 0.02)
    odometry = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.5]])
    stamps = np.array([0, 10**9])
    log = Log(stamps, [nothing, nothing], odometry, "/scan", "/odom", stamps, odometry)
    mapped = map_log(log)
    assert mapped.poses == pytest.approx(odometry)
    assert mapped.grid.data.size == 0


def test_a_trajectory_follows_odometry_between_scans() -> None:
    """Odometry that turns half as far as the robot, in the first half of the time between two scans only."""
    nothing = LaserScanData(np.full(90, np.inf), 0.0, 0.02)
    stamps = np.array([0, 1, 2, 3, 4]) * 10**9
    odometry = np.array([[0, 0, 0], [0.5, 0, 0], [1, 0, 0.2], [1, 0, 0.2], [1, 0, 0.2]], dtype=float)
    scans = stamps[[0, 4]]
    log = Log(scans, [nothing, nothing], odometry[[0, 4]], "/scan", "/odom", stamps, odometry)
    true = np.array([[5.0, 5.0, 1.0], pose2.compose((5.0, 5.0, 1.0), (1.0, 0.0, 0.4))])
    times, poses = log.trajectory(true)
    assert np.array_equal(times, stamps)
    assert poses[[0, 4]] == pytest.approx(true)
    assert poses[2] == pytest.approx(true[1])
    assert poses[3] == pytest.approx(true[1])
    assert pose2.between(poses[0], poses[1])[0] == pytest.approx(0.5, abs=0.05)


def test_the_clock_offset_of_relations_is_found() -> None:
    stamps = np.arange(0, 60 * 10**9, 10**8)
    seconds = stamps * 1e-9
    poses = np.stack([np.sin(0.3 * seconds), np.cos(0.2 * seconds), np.sin(0.9 * seconds)], axis=1)
    ends = np.stack([stamps[50:400], stamps[60:410]], axis=1)
    relations = Relations(ends, pose2.between(poses[50:400], poses[60:410]))
    late = Relations(relations.stamps_ns + 120_000_000, relations.poses)
    assert clock_offset(stamps, poses, relations) == pytest.approx(0.0, abs=1e-9)
    assert clock_offset(stamps, poses, late) == pytest.approx(0.12, abs=1e-9)
    assert relation_errors(stamps, poses, shifted(late, 0.12)).rotation.max() < 1e-9


@pytest.mark.slow
def test_the_intel_log_is_mapped(shared_data: Path) -> None:
    """Raw odometry is 7.4 m off. What is left is mostly in the truth's times: see the next assertions."""
    log, mapped, relations = map_shared(shared_data, "intel_5hz")
    errors = relation_errors(mapped.trajectory_ns, mapped.trajectory, relations)
    assert errors.translation.mean() < 0.053
    assert np.median(errors.translation) < 0.029
    assert np.degrees(errors.rotation.mean()) < 1.75
    # The bag holds a scan every three seconds, the truth speaks of times in between, and its stamps come in bursts.
    # Where both times of a relation are unmistakably those of scans, the error is that of SLAM alone.
    exact = relations_at_scans(log, relations)
    assert len(exact.poses) > 80
    alone = relation_errors(log.stamps_ns, mapped.poses, exact)
    assert alone.translation.mean() < 0.023
    assert np.median(alone.translation) < 0.015


@pytest.mark.slow
def test_the_freiburg_log_is_mapped(shared_data: Path) -> None:
    log, mapped, relations = map_shared(shared_data, "fr079")
    errors = relation_errors(log.stamps_ns, mapped.poses, relations)
    assert errors.translation.mean() < 0.043
    assert np.degrees(errors.rotation.mean()) < 1.7


def map_shared(shared_data: Path, name: str) -> tuple[Log, LogMap, Relations]:
    folder = shared_data / "slam" / name
    if not folder.is_dir():
        pytest.skip(f"no log {name} in the shared data")
    log = read_log(folder)
    truth = name.split("_")[0]
    return log, map_log(log), read_relations(folder.parent / truth / f"{truth}.relations")


def relations_at_scans(log: Log, relations: Relations) -> Relations:
    """Relations whose times are within 12 ms of a scan, with no other scan within 100 ms nor relation within 50 ms."""
    scans = log.stamps_ns
    lonely_scans = scans[isolated(scans, 100_000_000)]
    times = np.unique(relations.stamps_ns)
    lonely_times = times[isolated(times, 50_000_000)]
    at_scan = np.abs(relations.stamps_ns[..., None] - lonely_scans).min(axis=-1) < 12_000_000
    usable = (at_scan & np.isin(relations.stamps_ns, lonely_times)).all(axis=1)
    return Relations(relations.stamps_ns[usable], relations.poses[usable])


def isolated(sorted_times: np.ndarray, gap: int) -> np.ndarray:
    far = np.diff(sorted_times) > gap
    return np.concatenate([[True], far]) & np.concatenate([far, [True]])
