"""Action nodes that cut paths and put them together."""

from math import atan2, cos, hypot, inf, pi, sin
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, entry


class TruncatePath(Node):
    """Action node that cuts the last `distance` [m] of a path off."""

    names = ("TruncatePath",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_path": Port(entry),
        "distance": Port(float, 1.0),
        "output_path": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Cut the path; at least one pose stays."""
        path = self.ports.get("input_path")
        if path is None or not path.poses:
            return Status.FAILURE
        poses, left = list(path.poses), self.ports.get("distance")
        while len(poses) > 1 and left > 0.0:
            left -= _distance(poses[-2], poses[-1])
            poses.pop()
        if len(poses) > 1:
            _look_along(poses[-2], poses[-1])
        self.ports.set("output_path", _path(path, poses))
        return Status.SUCCESS


class TruncatePathLocal(Node):
    """Action node that keeps the part of a path around the robot."""

    names = ("TruncatePathLocal",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_path": Port(entry),
        "distance_forward": Port(float, 8.0),
        "distance_backward": Port(float, 4.0),
        "robot_frame": Port(str, ""),
        "pose": Port(entry, None),
        "transform_tolerance": Port(float, 0.2),
        "angular_distance_weight": Port(float, 0.0),
        "max_robot_pose_search_dist": Port(float, inf),
        "output_path": Port(entry, output=True),
    }

    def initialise(self) -> None:
        """Search from the path's begin."""
        self._path: Any = None
        self._nearest = 0

    def update(self) -> Status:
        """Cut the path where the robot, or the given pose, is nearest to it."""
        path = self.ports.get("input_path")
        if path is None:
            return Status.FAILURE
        robot = self._robot(path.header.frame_id)
        if robot is None:
            return Status.FAILURE
        poses = list(path.poses)
        if not poses:
            self.ports.set("output_path", path)
            return Status.SUCCESS
        nearest = self._search(path, poses, robot)
        begin = _at_distance(poses, nearest, self.ports.get("distance_backward"), -1)
        end = _at_distance(poses, nearest, self.ports.get("distance_forward"), 1)
        self.ports.set("output_path", _path(path, poses[begin : end + 1]))
        return Status.SUCCESS

    def _robot(self, frame: str) -> Any:
        pose = self.ports.get("pose")
        if pose is not None:
            return self.services.pose_in(pose, frame)
        return self.services.robot_pose(frame, self.ports.get("robot_frame"))

    def _search(self, path: Any, poses: list[Any], robot: Any) -> int:
        """Return the nearest pose of a path within the largest distance along it from the last one."""
        first = self._nearest if path is self._path else 0
        last = _at_distance(poses, first, self.ports.get("max_robot_pose_search_dist"), 1)
        weight = self.ports.get("angular_distance_weight")

        def cost(index: int) -> float:
            at = poses[index].pose.position
            turn = (_yaw(poses[index]) - float(robot[2]) + pi) % (2.0 * pi) - pi
            return float(hypot(at.x - robot[0], at.y - robot[1]) + weight * abs(turn))

        self._path, self._nearest = path, min(range(first, last + 1), key=cost)
        return self._nearest


class ConcatenatePaths(Node):
    """Action node that puts two paths together; one of them may be missing."""

    names = ("ConcatenatePaths",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_path1": Port(entry, None),
        "input_path2": Port(entry, None),
        "output_path": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Put them together; fail where both are missing or empty."""
        paths = [path for path in (self.ports.get(f"input_path{i}") for i in (1, 2)) if path is not None and path.poses]
        if not paths:
            return Status.FAILURE
        self.ports.set("output_path", _path(paths[0], [pose for path in paths for pose in path.poses]))
        return Status.SUCCESS


def _distance(one: Any, other: Any) -> float:
    a, b = one.pose.position, other.pose.position
    return hypot(b.x - a.x, b.y - a.y)


def _yaw(pose: Any) -> float:
    q = pose.pose.orientation
    return atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def _look_along(before: Any, pose: Any) -> None:
    """Turn a pose to the direction in which it is reached."""
    a, b = before.pose.position, pose.pose.position
    half = 0.5 * atan2(b.y - a.y, b.x - a.x)
    q = pose.pose.orientation
    q.x, q.y, q.z, q.w = 0.0, 0.0, sin(half), cos(half)


def _path(like: Any, poses: list[Any]) -> Any:
    return type(like)(header=like.header, poses=poses)


def _at_distance(poses: list[Any], index: int, distance: float, step: int) -> int:
    """Return the last index in a direction that is at most a distance [m] along the path away from an index."""
    while 0 <= index + step < len(poses):
        distance -= _distance(poses[index], poses[index + step])
        if distance < 0.0:
            break
        index += step
    return index
