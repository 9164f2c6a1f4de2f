"""Logs of real robots: laser scans and odometry from a bag, as arrays."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.bags.errors import BagError
from daidalos.bags.reader import BagReader
from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.common.pose3 import yaw_from_quaternion
from daidalos.interfaces.codec import CdrError, Codec, codec_of
from daidalos.mapping.carmen_log import CARMEN_SUFFIXES, read_carmen
from daidalos.mapping.errors import LogError
from daidalos.mapping.evaluation import poses_at
from daidalos.mapping.scan import LaserScanData
from daidalos.mapping.text_file import format_suffix
from daidalos.mapping.trajectory import Stamps

LASER_SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"

TURN_WEIGHT = 1.0
"""Distance [m] that counts as much as a turn of 1 rad where an error is spread over a motion."""

LATEST_ODOMETRY = 200_000_000
"""How long [ns] before the first or after the last odometry a scan may be for that odometry to be used."""


@dataclass(frozen=True)
class Log:
    """Scans with the odometry at their times.

    Attributes
    ----------
    stamps_ns : ndarray of int64, shape (n,)
        Times of the scans [ns], not decreasing.
    scans : list of LaserScanData
        The scans, with the sensor's pose on the robot.
    odometry : ndarray, shape (n, 3)
        Pose (x, y, yaw) of the base in the odometry frame at those times.
    scan_topic, odometry_source : str
        Where they come from.
    odometry_stamps_ns : ndarray of int64, shape (m,)
        Times of all odometry [ns], each later than the one before.
    all_odometry : ndarray, shape (m, 3)
        The poses at those times.
    """

    stamps_ns: Stamps
    scans: list[LaserScanData]
    odometry: Array
    scan_topic: str
    odometry_source: str
    odometry_stamps_ns: Stamps
    all_odometry: Array

    def trajectory(self, poses: Array) -> tuple[Stamps, Array]:
        """Return a trajectory through poses at the scans that follows odometry between them.

        What odometry erred between two scans is spread over the motion between them.

        Parameters
        ----------
        poses : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the map at the scans.

        Returns
        -------
        tuple of ndarray of int64, shape (k,), and ndarray, shape (k, 3)
            Times [ns] of all scans and all odometry, and the poses at them.
        """
        times = np.union1d(self.stamps_ns, self.odometry_stamps_ns)
        odometry = poses_at(self.odometry_stamps_ns, self.all_odometry, times)
        step = pose2.between(odometry[:-1], odometry[1:])
        motion = np.hypot(step[:, 0], step[:, 1]) + TURN_WEIGHT * np.abs(step[:, 2]) + 1e-9
        travelled = np.concatenate([[0.0], np.cumsum(motion)])
        at = np.searchsorted(times, self.stamps_ns)
        before = np.clip(np.searchsorted(self.stamps_ns, times, side="right") - 1, 0, len(poses) - 1)
        after = np.minimum(before + 1, len(poses) - 1)
        forwards = pose2.compose(poses[before], pose2.between(odometry[at[before]], odometry))
        backwards = pose2.compose(poses[after], pose2.between(odometry[at[after]], odometry))
        whole = np.maximum(travelled[at[after]] - travelled[at[before]], 1e-9)
        share = np.clip((travelled - travelled[at[before]]) / whole, 0.0, 1.0)
        return times, pose2.interpolate(forwards, backwards, share)


def read_log(path: str | Path, *, scan_topic: str | None = None, odom_topic: str | None = None) -> Log:
    """Read the scans and the odometry of a bag (MCAP or sqlite3, a folder or a single file) or a log of CARMEN.

    Odometry comes from `nav_msgs/Odometry` messages or, where there are none, from odom -> base in /tf.

    Parameters
    ----------
    path : str or Path
        The bag.
    scan_topic, odom_topic : str, optional
        Topics to read; by default the only ones of their type, or `/scan` and `/odom`.

    Raises
    ------
    MappingError
        When the bag cannot be read or lacks scans or odometry.
    """
    bag = Path(path)
    if not bag.exists():
        raise LogError(bag, "no such file or folder")
    if format_suffix(bag) in CARMEN_SUFFIXES and bag.is_file():
        return _read_carmen(bag)
    try:
        with BagReader(bag) as reader:
            if reader.notes and not reader.metadata.message_count:
                raise LogError(bag, f"not a readable bag: {reader.notes[-1]}")
            return _collect(bag, reader, scan_topic, odom_topic)
    except (BagError, CdrError) as error:
        raise LogError(bag, f"not a readable bag: {error}") from error


def _collect(bag: Path, reader: BagReader, scan_topic: str | None, odom_topic: str | None) -> Log:
    topics = {name: topic.type for name, topic in reader.topics.items()}
    scan_topic = _choose(bag, topics, LASER_SCAN, scan_topic, "/scan")
    if scan_topic is None:
        raise LogError(bag, f"no scans: expected a topic of type {LASER_SCAN}, found {_listed(topics)}")
    odom_topic = _choose(bag, topics, ODOMETRY, odom_topic, "/odom")
    scans: list[Any] = []
    odometry: list[Any] = []
    transforms: list[Any] = []
    into: dict[str, Callable[[Any], None]] = {
        LASER_SCAN: scans.append,
        ODOMETRY: odometry.append,
        TRANSFORMS: lambda message: transforms.extend(message.transforms),
    }
    takers = {
        topic: (_codec(topics[topic]), into[topics[topic]])
        for topic in (scan_topic, odom_topic, "/tf", "/tf_static")
        if topic is not None and topics.get(topic) in into
    }
    for message in reader.messages(takers):
        codec, take = takers[message.topic]
        take(codec.decode(message.data))
    if not scans:
        raise LogError(bag, f"no messages on {scan_topic}")
    scans.sort(key=lambda message: _stamp(message.header))
    source, stamps, poses, base = _odometry(bag, odometry, transforms, odom_topic)
    mounts = _mounts(transforms, base)
    times = np.array([_stamp(message.header) for message in scans], dtype=np.int64)
    found = [_scan(bag, message, mounts) for message in scans]
    return _log(bag, (times, found, scan_topic), (stamps, poses, source))


def _read_carmen(path: Path) -> Log:
    """Read a log of CARMEN."""
    found = read_carmen(path)
    times, stamps = np.array(found.scan_stamps_ns), np.array(found.odometry_stamps_ns)
    order, rows = np.argsort(times, kind="stable"), np.argsort(stamps, kind="stable")
    scans = [found.scans[k] for k in order]
    return _log(path, (times[order], scans, "its laser"), (stamps[rows], np.array(found.odometry)[rows], "the log"))


def _log(path: Path, seen: tuple[Stamps, list[LaserScanData], str], measured: tuple[Stamps, Array, str]) -> Log:
    """Return scans with the odometry at their times, without those that have none.

    Parameters
    ----------
    path : Path
    seen
        Times of the scans, the scans and where they come from.
    measured
        Times of odometry, the poses and where they come from.
    """
    (times, scans, scan_topic), (stamps, poses, source) = seen, measured
    covered = (times >= stamps[0] - LATEST_ODOMETRY) & (times <= stamps[-1] + LATEST_ODOMETRY)
    if not covered.any():
        raise LogError(path, f"no scan on {scan_topic} has odometry at its time: {source} covers another period")
    kept = [scan for scan, use in zip(scans, covered, strict=True) if use]
    at_scans = poses_at(stamps, poses, times[covered])
    distinct, first = np.unique(stamps, return_index=True)
    return Log(times[covered], kept, at_scans, scan_topic, source, distinct, poses[first])


def _codec(type_name: str) -> Codec:
    """Return the function that deserializes messages of a type."""
    package, kind, name = type_name.split("/")
    return codec_of(getattr(import_module(f"{package}.{kind}"), name))


def _choose(bag: Path, topics: dict[str, str], kind: str, asked: str | None, usual: str) -> str | None:
    """Return the requested topic, else the usual one, else the only one of its type."""
    if asked is not None:
        if topics.get(asked) != kind:
            found = f"it is {topics[asked]}" if asked in topics else f"the bag has {_listed(topics)}"
            raise LogError(bag, f"no topic {asked} of type {kind}: {found}")
        return asked
    candidates = sorted(topic for topic, found in topics.items() if found == kind)
    if usual in candidates:
        return usual
    if len(candidates) > 1:
        raise LogError(bag, f"several topics of type {kind}, name one: {', '.join(candidates)}")
    return candidates[0] if candidates else None


def _listed(topics: dict[str, str]) -> str:
    return ", ".join(f"{topic} ({kind})" for topic, kind in sorted(topics.items())) or "no topics"


def _odometry(
    bag: Path, messages: list[Any], transforms: list[Any], odom_topic: str | None
) -> tuple[str, Stamps, Array, str]:
    """Return the source of odometry, its stamps and poses, and the name of the base frame."""
    if messages:
        source = str(odom_topic)
        base = messages[0].child_frame_id or "base_link"
        stamped = [(_stamp(message.header), _planar(message.pose.pose)) for message in messages]
    else:
        moving = [t for t in transforms if _frame(t.header.frame_id) == "odom"]
        if not moving:
            raise LogError(bag, f"no odometry: expected a topic of type {ODOMETRY} or a transform from odom in /tf")
        base = moving[0].child_frame_id
        source = f"/tf odom -> {_frame(base)}"
        stamped = [(_stamp(t.header), _planar_transform(t.transform)) for t in moving if t.child_frame_id == base]
    stamped.sort(key=lambda item: item[0])
    stamps = np.array([stamp for stamp, _ in stamped], dtype=np.int64)
    poses = np.array([pose for _, pose in stamped])
    if not np.isfinite(poses).all():
        raise LogError(bag, f"odometry from {source} has poses that are not numbers")
    return source, stamps, poses, _frame(base)


def _mounts(transforms: Sequence[Any], base: str) -> dict[str, Array]:
    """Return the pose (x, y, yaw) in the base of every frame that static transforms connect to it."""
    children: dict[str, dict[str, Array]] = {}
    for t in transforms:
        parent, child = _frame(t.header.frame_id), _frame(t.child_frame_id)
        children.setdefault(parent, {}).setdefault(child, np.array(_planar_transform(t.transform)))
    mounts = {base: np.zeros(3)}
    waiting = [base]
    while waiting:
        parent = waiting.pop()
        for child, pose in children.get(parent, {}).items():
            if child not in mounts:
                mounts[child] = pose2.compose(mounts[parent], pose)
                waiting.append(child)
    return mounts


def _scan(bag: Path, message: Any, mounts: dict[str, Array]) -> LaserScanData:
    frame = _frame(message.header.frame_id)
    # Without any transforms the scanner is taken to sit at the base; with some, its own must be there.
    mount = mounts.get(frame) if len(mounts) > 1 else np.zeros(3)
    if mount is None:
        raise LogError(bag, f"no transform from the base to the frame {frame!r} of the scans in /tf_static or /tf")
    return LaserScanData(
        np.asarray(message.ranges, dtype=np.float32),
        message.angle_min,
        message.angle_increment,
        message.range_min,
        message.range_max,
        message.time_increment,
        (float(mount[0]), float(mount[1]), float(mount[2])),
    )


def _stamp(header: Any) -> int:
    return int(header.stamp.sec) * 10**9 + int(header.stamp.nanosec)


def _frame(name: str) -> str:
    """Return a frame's name without the leading slash of ROS 1."""
    return name.lstrip("/")


def _planar(pose: Any) -> tuple[float, float, float]:
    return (pose.position.x, pose.position.y, _yaw(pose.orientation))


def _planar_transform(transform: Any) -> tuple[float, float, float]:
    return (transform.translation.x, transform.translation.y, _yaw(transform.rotation))


def _yaw(q: Any) -> float:
    return yaw_from_quaternion((q.x, q.y, q.z, q.w))
