"""Condition nodes on the robot's pose and on distances."""

from math import hypot
from typing import Any, ClassVar

import numpy as np
from py_trees.common import Status

from daidalos.navigation.paths import distances_along
from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext, entry

_FRAMES = {"global_frame": Port(str, ""), "robot_base_frame": Port(str, "")}


class GoalReached(Node):
    """Condition node that succeeds while the robot is within `goal_reached_tol` [m] of the goal."""

    names = ("GoalReached",)
    PORTS: ClassVar[dict[str, Port]] = {"goal": Port(entry), "goal_reached_tol": Port(float, 0.25), **_FRAMES}

    def update(self) -> Status:
        """Compare the poses."""
        goal, frame = self.ports.get("goal"), self.ports.get("global_frame")
        robot = self.services.robot_pose(frame, self.ports.get("robot_base_frame"))
        wanted = None if goal is None else self.services.pose_in(goal, frame)
        if robot is None or wanted is None:
            return Status.FAILURE
        near = hypot(*(wanted - robot)[:2]) <= self.ports.get("goal_reached_tol")
        return Status.SUCCESS if near else Status.FAILURE


class IsGoalNearby(Node):
    """Condition node that succeeds while less than `proximity_threshold` [m] of a path is ahead of the robot.

    The pose of the path that is nearest to the robot is searched for from the last one on, over
    `max_robot_pose_search_dist` [m]; over the whole path where that is negative, or the path is another one.
    """

    names = ("IsGoalNearby",)
    PORTS: ClassVar[dict[str, Port]] = {
        "path": Port(entry),
        "proximity_threshold": Port(float, 1.0),
        "max_robot_pose_search_dist": Port(float, -1.0),
        **_FRAMES,
    }
    _path: Any = None
    _nearest = 0

    def update(self) -> Status:
        """Measure the rest of the path; fail where there is none, or the robot's pose is not known."""
        path = self.ports.get("path")
        if path is None or not path.poses:
            return Status.FAILURE
        robot = self.services.robot_pose(path.header.frame_id, self.ports.get("robot_base_frame"))
        if robot is None:
            return Status.FAILURE
        points = np.array([(pose.pose.position.x, pose.pose.position.y) for pose in path.poses])
        along = distances_along(points)
        reach = self.ports.get("max_robot_pose_search_dist")
        first = self._nearest if path is self._path and reach >= 0.0 else 0
        last = int(np.searchsorted(along, along[first] + reach, side="right")) if reach >= 0.0 else along.size
        away = np.hypot(*(points[first : max(last, first + 1)] - robot[:2]).T)
        self._path, self._nearest = path, first + int(np.argmin(away))
        is_nearby = along[-1] - along[self._nearest] < self.ports.get("proximity_threshold")
        return Status.SUCCESS if is_nearby else Status.FAILURE


class ArePosesNear(Node):
    """Condition node that succeeds where two poses are within `tolerance` [m] of each other."""

    names = ("ArePosesNear",)
    PORTS: ClassVar[dict[str, Port]] = {
        "ref_pose": Port(entry),
        "target_pose": Port(entry),
        "global_frame": Port(str, ""),
        "tolerance": Port(float, 0.5),
    }

    def update(self) -> Status:
        """Compare the poses."""
        poses = [self.ports.get(name) for name in ("ref_pose", "target_pose")]
        places = [
            None if pose is None else self.services.pose_in(pose, self.ports.get("global_frame")) for pose in poses
        ]
        if places[0] is None or places[1] is None:
            return Status.FAILURE
        near = hypot(*(places[0] - places[1])[:2]) <= self.ports.get("tolerance")
        return Status.SUCCESS if near else Status.FAILURE


class DistanceTraveled(Node):
    """Condition node that succeeds each time that the robot is `distance` [m] away from where it last did."""

    names = ("DistanceTraveled",)
    PORTS: ClassVar[dict[str, Port]] = {"distance": Port(float, 1.0), **_FRAMES}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._from: Any = None

    def update(self) -> Status:
        """Compare the robot's pose with the last one."""
        robot = self.services.robot_pose(self.ports.get("global_frame"), self.ports.get("robot_base_frame"))
        if robot is None:
            return Status.FAILURE
        if self._from is None:
            self._from = robot
        if hypot(*(robot - self._from)[:2]) < self.ports.get("distance"):
            return Status.FAILURE
        self._from = robot
        return Status.SUCCESS


class TransformAvailable(Node):
    """Condition node that succeeds from the moment on at which there is a transform between two frames."""

    names = ("TransformAvailable",)
    PORTS: ClassVar[dict[str, Port]] = {"child": Port(str), "parent": Port(str)}
    _was_there = False

    def update(self) -> Status:
        """Look for the transform until it was there."""
        if not self._was_there:
            self._was_there = self.services.can_transform(self.ports.get("parent"), self.ports.get("child"))
        return Status.SUCCESS if self._was_there else Status.FAILURE


class InitialPoseReceived(Node):
    """Condition node that succeeds where `initial_pose_received` is true on the blackboard."""

    names = ("InitialPoseReceived",)
    PORTS: ClassVar[dict[str, Port]] = {"initial_pose_received": Port(entry, None)}

    def update(self) -> Status:
        """Look at the blackboard."""
        received = self.ports.get("initial_pose_received")
        if received is None:
            received = self.ports.blackboard.get("initial_pose_received", False)
        return Status.SUCCESS if received else Status.FAILURE
