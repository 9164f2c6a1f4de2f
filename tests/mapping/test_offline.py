from pathlib import Path

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.evaluation import (
    Relations,
    compare_with_truth,
    read_relations,
    relation_errors,
)
from daidalos.mapping.log import Log, read_log
from daidalos.mapping.offline import LogMap, map_log
from daidalos.mapping.scan import LaserScanData

from .bags import write_bag
from .worlds import arena, raster


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
    log = Log(np.array([0, 10**9]), [nothing, nothing], odometry, "/scan", "/odom")
    mapped = map_log(log)
    assert mapped.poses == pytest.approx(odometry)
    assert mapped.grid.data.size == 0


@pytest.mark.slow
def test_the_intel_log_is_mapped(shared_data: Path) -> None:
    """Raw odometry is 7.4 m off. What is left is nearly all in the truth's times: see the next assertions."""
    log, mapped, relations = map_shared(shared_data, "intel")
    errors = relation_errors(log.stamps_ns, mapped.poses, relations)
    assert errors.translation.mean() < 0.37
    assert errors.translation.mean() < 0.135
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
    return log, map_log(log), read_relations(folder / f"{name}.relations")


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
