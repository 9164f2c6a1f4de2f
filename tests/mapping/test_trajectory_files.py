"""Files of trajectories and logs: what is written is read, by one reader each."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daidalos.common import pose2
from daidalos.mapping.carmen_log import write_carmen
from daidalos.mapping.errors import LineError, MappingError
from daidalos.mapping.log import read_log
from daidalos.mapping.scan import LaserScanData
from daidalos.mapping.text_file import nanoseconds, seconds_text
from daidalos.mapping.trajectory import Trajectory
from daidalos.mapping.trajectory_file import read_trajectory, write_trajectory

AS_FILES = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=40)
poses_of = st.lists(st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(-3.1, 3.1)), min_size=1, max_size=4)


@AS_FILES
@given(poses_of, st.integers(0, 2 * 10**18))
def test_trajectories_are_read_as_they_were_written(
    tmp_path: Path, poses: list[tuple[float, float, float]], first: int
) -> None:
    stamps = first + 100 * np.arange(len(poses), dtype=np.int64)
    written = Trajectory(stamps, np.array(poses))
    for name, is_timed in (("a.tum", True), ("a.txt", True), ("a.kitti", False)):
        write_trajectory(tmp_path / name, written)
        found = read_trajectory(tmp_path / name)
        assert np.abs(pose2.between(written.poses, found.poses)).max() < 1e-5
        assert (found.stamps_ns is None) is not is_timed
        if found.stamps_ns is not None:
            assert np.array_equal(found.stamps_ns, stamps), "to the nanosecond"


@given(st.integers(-(10**19), 10**19))
def test_seconds_keep_their_nanoseconds(stamp: int) -> None:
    assert nanoseconds(seconds_text(stamp)) == stamp


def test_other_ways_to_write_a_time_are_read() -> None:
    assert nanoseconds("1.305031102175304e+09") == 1_305_031_102_175_304_000
    assert nanoseconds("12") == 12 * 10**9
    for text in ("nan", "inf", "x", ""):
        with pytest.raises(ValueError, match=r".*"):
            nanoseconds(text)


RAW = """# a comment
PARAM robot_frontlaser_offset 0.25 host 0.1
SYNC tag
ODOM 0.0 0.0 0.0 0 0 0 10.00 host 10.0
FLASER 4 1.0 2.0 3.0 81.91 1.25 0.0 0.0 1.0 0.0 0.0 10.20 host 10.2
ODOM 2.0 0.0 0.0 0 0 0 10.40 host 10.4
RLASER 1 1.0 0 0 0 0 0 0 10.3 host 10.3
"""
NEW = "ROBOTLASER1 0 -1.57 3.14 0.0175 50.0 0.01 0 3 1.0 2.0 3.0 0 1.3 0.5 0.0 1.0 0.5 0.0 0 0 0 0 0 20.5 host 20.5\n"


def test_a_raw_log_of_carmen_is_read(tmp_path: Path) -> None:
    (tmp_path / "raw.log").write_text(RAW)
    log = read_log(tmp_path / "raw.log")
    assert log.stamps_ns.tolist() == [10_200_000_000]
    assert log.odometry_stamps_ns.tolist() == [10_000_000_000, 10_200_000_000, 10_400_000_000]
    assert log.odometry[0] == pytest.approx([1.0, 0.0, 0.0])
    (scan,) = log.scans
    assert (scan.angle_min, scan.range_max) == (-np.pi / 2, 80.0)
    assert scan.sensor_pose == (0.25, 0.0, 0.0)
    trajectory = read_trajectory(tmp_path / "raw.log")
    assert trajectory.poses[0] == pytest.approx([1.0, 0.0, 0.0]), "of the robot, not of its laser"


def test_a_clock_that_lost_its_digits_is_replaced(tmp_path: Path) -> None:
    lines = [
        f"ODOM {k} 0 0 0 0 0 1.1e+09 h 1.1e+09\nFLASER 1 1.0 {k} 0 0 {k} 0 0 1.1e+09 h 1.1e+09\n" for k in range(5)
    ]
    with gzip.open(tmp_path / "cut.log.gz", "wt") as file:
        file.write("".join(lines))
    log = read_log(tmp_path / "cut.log.gz")
    assert np.diff(log.stamps_ns).tolist() == [200_000_000] * 4
    assert log.odometry[:, 0] == pytest.approx(np.arange(5.0))


def test_the_newer_lines_of_carmen_are_read(tmp_path: Path) -> None:
    (tmp_path / "new.clf").write_text(NEW)
    log = read_log(tmp_path / "new.clf")
    (scan,) = log.scans
    assert (scan.angle_min, scan.angle_increment, scan.range_max) == (-1.57, 0.0175, 50.0)
    assert scan.ranges.tolist() == [1.0, 2.0, 3.0]
    assert scan.sensor_pose == pytest.approx((0.3, 0.0, 0.0))
    assert log.odometry[0] == pytest.approx([1.0, 0.5, 0.0])


def test_logs_of_carmen_are_read_as_they_were_written(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    scans = [
        LaserScanData(
            rng.uniform(0.5, 9.0, 181).astype(np.float32), -np.pi / 2, np.pi / 180, 0.0, 80.0, 0.0, (0.1, 0.0, 0.0)
        )
        for _ in range(3)
    ]
    scans[0].ranges[7] = np.inf
    stamps, poses = np.array([5, 205, 405]) * 10**6, rng.uniform(-3.0, 3.0, (3, 3))
    write_carmen(tmp_path / "a.log", stamps, scans, poses, np.zeros((3, 3)))
    log, trajectory = read_log(tmp_path / "a.log"), read_trajectory(tmp_path / "a.log")
    assert log.stamps_ns.tolist() == stamps.tolist()
    assert np.abs(pose2.between(poses, trajectory.poses)).max() < 1e-5
    assert log.odometry == pytest.approx(np.zeros((3, 3)))
    assert log.scans[1].ranges == pytest.approx(scans[1].ranges, abs=1e-3)
    assert log.scans[0].ranges[7] > log.scans[0].range_max
    assert log.scans[0].sensor_pose == pytest.approx((0.1, 0.0, 0.0))
    wide = LaserScanData(np.ones(270, np.float32), -2.35, 0.0175)
    with pytest.raises(LineError, match="the format holds 180, 181, 360 or 361 beams from -90 deg on, found 270"):
        write_carmen(tmp_path / "b.log", stamps[:1], [wide], poses[:1], poses[:1])


@pytest.mark.parametrize(
    ("name", "text", "problem"),
    [
        ("a.tum", "1 2 3 4 5 6 7 8\n1 2 3\n", ":2: expected eight numbers: t x y z qx qy qz qw"),
        ("a.tum", "1 2 3 4 0 0 0 0\n", ":1: expected finite numbers and a quaternion that is not zero"),
        ("a.kitti", "1 0 0 1 0 1 0 1 0 0 1 nan\n", ":1: expected twelve finite numbers"),
        ("a.txt", "1 2 3\n", r":1: expected 8 numbers \(TUM\) or 12 \(KITTI\), found 3 words"),
        ("a.txt", "# nothing\n", ": no poses in the file"),
        ("a.log", "FLASER 3 1.0 2.0 0 0 0 0 0 0 1 host 1\n", ":1: expected after FLASER: count ranges"),
        ("a.log", "ODOM 0 0 0 0 0 0 1 host 1\n", ": no FLASER or ROBOTLASER1"),
        ("a.clf", "ROBOTLASER1 0 0\n", ":1: expected after ROBOTLASER1"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, name: str, text: str, problem: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(LineError, match=f"{name}{problem}"):
        read_trajectory(tmp_path / name)
    with pytest.raises(MappingError, match=r"gone\.tum: No such file"):
        read_trajectory(tmp_path / "gone.tum")


@AS_FILES
@given(st.binary(max_size=200) | st.text("FLASERODM 0123456789.-\n", max_size=200).map(str.encode))
def test_any_other_file_is_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    for name in ("a.log", "a.tum", "a.g2o"):
        (tmp_path / name).write_bytes(content)
        problem = ""
        try:
            read_trajectory(tmp_path / name)
        except MappingError as error:
            problem = str(error)
        assert "\n" not in problem
