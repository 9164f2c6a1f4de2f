"""Logs of CARMEN (``.log``, ``.clf``): the text format of the classic laser logs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.errors import LogFileError
from daidalos.mapping.scan import LaserScanData
from daidalos.mapping.text_file import nanoseconds, read_lines, seconds_text, write_lines
from daidalos.mapping.trajectory import Stamps, Trajectory, sorted_trajectory

CARMEN_SUFFIXES = (".log", ".clf", ".carmen")

MAX_RANGE = 80.0
"""Range [m] from which readings mean that nothing was seen; lasers of that time report 81.83 and 81.91."""

_OFFSET = "robot_frontlaser_offset"
_LEAST_GROWTH = 0.9
"""Share of the scans that come later than the one before in a log whose times can be used."""

_LINE_NS = 100_000_000
"""Time [ns] that a line takes in other logs."""

_HALF_TURN_BEAMS = 180
"""Beams over half a turn at one beam a degree; 181 beams have both ends."""


@dataclass
class CarmenLog:
    """Scans and odometry of a log.

    Attributes
    ----------
    scan_stamps_ns, odometry_stamps_ns : list of int
        Times [ns].
    scans : list of LaserScanData
    laser_poses : list of ndarray, shape (3,)
        Where each scan was taken, as the log says: by odometry in raw logs, corrected in others.
    odometry : list of ndarray, shape (3,)
        Poses of the robot.
    offset : float
        How far ahead of the robot's middle the laser is [m].
    scan_lines, odometry_lines : list of int
        Numbers of their lines.
    """

    scan_stamps_ns: list[int] = field(default_factory=list)
    scans: list[LaserScanData] = field(default_factory=list)
    laser_poses: list[Array] = field(default_factory=list)
    odometry_stamps_ns: list[int] = field(default_factory=list)
    odometry: list[Array] = field(default_factory=list)
    offset: float = 0.0
    scan_lines: list[int] = field(default_factory=list)
    odometry_lines: list[int] = field(default_factory=list)

    @property
    def trajectory(self) -> Trajectory:
        """Poses of the robot that the scans have in the log, in the order of their times."""
        mount = (self.offset, 0.0, 0.0)
        poses = [pose2.compose(pose, pose2.inverse(mount)) for pose in self.laser_poses]
        return sorted_trajectory(self.scan_stamps_ns, poses)


def read_carmen(path: Path) -> CarmenLog:
    """Read a log: its lines ``ODOM``, ``FLASER``, ``ROBOTLASER1`` and the laser's offset among the ``PARAM``.

    Lines of other kinds, such as those of a second laser, are passed over. Where the times cannot be used, as in files
    that GMapping wrote with six digits, each line counts as 0.1 s.

    Raises
    ------
    LogFileError
        Naming the file and the line.
    """
    log = CarmenLog()
    readers: dict[str, tuple[Callable[[CarmenLog, list[str]], None], str]] = {
        "ODOM": (_read_odometry, "x y theta tv rv accel time host time"),
        "FLASER": (_read_front_laser, "count ranges, the laser's x y theta, the robot's x y theta, time host time"),
        "ROBOTLASER1": (_read_robot_laser, "eight numbers of the laser, its ranges and remissions, two poses, times"),
        "PARAM": (_read_parameter, "a name and a value"),
    }
    for number, line in read_lines(path, LogFileError):
        kind, *words = line.split()
        if kind in readers:
            read, expected = readers[kind]
            try:
                read(log, words)
            except (ValueError, IndexError):
                raise LogFileError(path, number, f"expected after {kind}: {expected}") from None
        # What a line adds comes at the time of its number, where the clock cannot be used.
        log.scan_lines += [number] * (len(log.scans) - len(log.scan_lines))
        log.odometry_lines += [number] * (len(log.odometry) - len(log.odometry_lines))
    if not log.scans:
        raise LogFileError(path, None, "no FLASER or ROBOTLASER1 in the file")
    if not _is_clock(log.scan_stamps_ns):
        log.scan_stamps_ns = [line * _LINE_NS for line in log.scan_lines]
        log.odometry_stamps_ns = [line * _LINE_NS for line in log.odometry_lines]
    return log


def _is_clock(stamps_ns: list[int]) -> bool:
    """Return whether times grow from scan to scan, but for few of them; other programs cut the digits off."""
    grows = np.diff(np.array(stamps_ns)) > 0
    return not grows.size or float(np.mean(grows)) > _LEAST_GROWTH


def write_carmen(path: Path, stamps_ns: Stamps, scans: Sequence[LaserScanData], poses: Array, odometry: Array) -> None:
    """Write scans as ``FLASER`` lines.

    Beams over half a turn in steps of one or half a degree are what the format holds.

    Parameters
    ----------
    path : Path
    stamps_ns : ndarray of int64, shape (n,)
    scans : sequence of LaserScanData
    poses, odometry : ndarray, shape (n, 3)
        Poses of the robot at the scans: corrected, and by odometry.

    Raises
    ------
    LogFileError
        When the scans do not fit the format, or the file cannot be written.
    """
    mount = scans[0].sensor_pose
    if mount[1] or mount[2]:
        raise LogFileError(path, None, f"the format holds a laser that looks ahead on the x axis, found one at {mount}")
    lines = [f"PARAM {_OFFSET} {mount[0]:.6f} 0 host 0\n"]
    for stamp, scan, pose, by_odometry in zip(stamps_ns.tolist(), scans, poses, odometry, strict=True):
        if not _fits(scan):
            degrees = np.degrees([scan.angle_min, scan.angle_increment])
            found = f"{len(scan.ranges)} from {degrees[0]:.1f} deg in steps of {degrees[1]:.3f}"
            raise LogFileError(
                path, None, f"the format holds 180, 181, 360 or 361 beams from -90 deg on, found {found}"
            )
        seen = np.where(np.isfinite(scan.ranges), scan.ranges, MAX_RANGE + 1.0)
        ranges = " ".join(f"{value:.3f}" for value in seen.tolist())
        laser = " ".join(f"{value:.6f}" for value in pose2.compose(pose, mount).tolist())
        robot = " ".join(f"{value:.6f}" for value in by_odometry.tolist())
        time = seconds_text(stamp)
        lines.append(f"FLASER {len(seen)} {ranges} {laser} {robot} {time} host {time}\n")
    write_lines(path, lines, LogFileError)


def _fits(scan: LaserScanData) -> bool:
    """Return whether the format holds a scan's directions."""
    begin, step = _directions(len(scan.ranges))
    usual = len(scan.ranges) in (180, 181, 360, 361)
    return usual and abs(scan.angle_min - begin) < 1e-3 and abs(scan.angle_increment - step) < 1e-5


def _directions(count: int) -> tuple[float, float]:
    """Return the direction of the first beam and the step [rad] of a front laser, which sees half a turn."""
    even = count - count % 2
    return -np.pi / 2, np.pi / (even or _HALF_TURN_BEAMS)


def _read_odometry(log: CarmenLog, words: list[str]) -> None:
    _add_odometry(log, _finite(words[:3]), nanoseconds(words[-3]))


def _read_front_laser(log: CarmenLog, words: list[str]) -> None:
    count = int(words[0])
    ranges, rest = words[1 : 1 + count], words[1 + count :]
    _require(len(rest) >= 9)
    begin, step = _directions(count)
    _add_scan(log, _scan(ranges, begin, step, MAX_RANGE, log.offset), _finite(rest[:3]), nanoseconds(rest[6]))
    _add_odometry(log, _finite(rest[3:6]), nanoseconds(rest[6]))


def _read_robot_laser(log: CarmenLog, words: list[str]) -> None:
    """Read a line of the newer format, whose odometry stands at its end."""
    begin, _, step, longest = _finite(words[1:5]).tolist()
    count = int(words[7])
    ranges, after = words[8 : 8 + count], words[8 + count :]
    remissions = int(after[0])
    rest = after[1 + remissions :]
    _require(len(rest) >= 14)
    laser, robot, time = _finite(rest[:3]), _finite(rest[3:6]), nanoseconds(rest[11])
    mount = pose2.between(robot, laser)
    scan = _scan(ranges, begin, step, min(longest, MAX_RANGE) if longest > 0 else MAX_RANGE, float(mount[0]))
    log.offset = float(mount[0])
    _add_scan(log, scan, laser, time)
    _add_odometry(log, robot, time)


def _read_parameter(log: CarmenLog, words: list[str]) -> None:
    if words[0] == _OFFSET:
        log.offset = float(_finite(words[1:2])[0])


def _scan(ranges: list[str], begin: float, step: float, longest: float, offset: float) -> LaserScanData:
    values = np.array([float(word) for word in ranges], dtype=np.float32)
    return LaserScanData(values, begin, step, 0.0, longest, 0.0, (offset, 0.0, 0.0))


def _add_scan(log: CarmenLog, scan: LaserScanData, laser: Array, stamp: int) -> None:
    log.scans.append(scan)
    log.laser_poses.append(laser)
    log.scan_stamps_ns.append(stamp)


def _add_odometry(log: CarmenLog, pose: Array, stamp: int) -> None:
    log.odometry.append(pose)
    log.odometry_stamps_ns.append(stamp)


def _finite(words: list[str]) -> Array:
    values = np.array([float(word) for word in words])
    _require(bool(np.isfinite(values).all()) and len(values) == len(words) and len(words) > 0)
    return values


def _require(holds: bool) -> None:
    if not holds:
        raise ValueError
