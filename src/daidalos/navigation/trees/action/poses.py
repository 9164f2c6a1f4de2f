"""Action nodes on poses: that of the robot, those of a path, and goals that were passed."""

from math import hypot
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, entry


class GetCurrentPose(Node):
    """Action node that outputs the robot's pose; it fails where that is not known."""

    names = ("GetCurrentPose",)
    PORTS: ClassVar[dict[str, Port]] = {
        "global_frame": Port(str, ""),
        "robot_base_frame": Port(str, ""),
        "current_pose": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Look the pose up."""
        pose = self.services.robot_pose_stamped(self.ports.get("global_frame"), self.ports.get("robot_base_frame"))
        if pose is None:
            return Status.FAILURE
        self.ports.set("current_pose", pose)
        return Status.SUCCESS


class GetPoseFromPath(Node):
    """Action node that outputs one pose of a path; negative indices count from its end."""

    names = ("GetPoseFromPath",)
    PORTS: ClassVar[dict[str, Port]] = {
        "path": Port(entry),
        "index": Port(int, 0),
        "pose": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Look the pose up; fail where the path does not have it."""
        path, index = self.ports.get("path"), self.ports.get("index")
        if path is None or not -len(path.poses) <= index < len(path.poses):
            return Status.FAILURE
        self.ports.set("pose", path.poses[index])
        return Status.SUCCESS


class RemovePassedGoals(Node):
    """Action node that removes goals from the first on as long as the robot is within `radius` [m] of the next."""

    names = ("RemovePassedGoals",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_goals": Port(entry),
        "radius": Port(float, 0.5),
        "global_frame": Port(str, ""),
        "robot_base_frame": Port(str, ""),
        "output_goals": Port(entry, output=True),
        "input_waypoint_statuses": Port(entry, None),
        "output_waypoint_statuses": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Remove what was passed; the last goal stays."""
        goals = list(goals_of(self.ports.get("input_goals")))
        frame, base = self.ports.get("global_frame"), self.ports.get("robot_base_frame")
        while len(goals) > 1:
            robot = self.services.robot_pose(goals[0].header.frame_id or frame, base)
            if robot is None:
                return Status.FAILURE
            at = goals[0].pose.position
            if hypot(at.x - robot[0], at.y - robot[1]) > self.ports.get("radius"):
                break
            goals.pop(0)
        self.ports.set("output_goals", goals)
        self.ports.set("output_waypoint_statuses", self.ports.get("input_waypoint_statuses"))
        return Status.SUCCESS


class AppendGoalPoseToGoals(Node):
    """Action node that adds a pose to the end of goals."""

    names = ("AppendGoalPoseToGoals",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_goals": Port(entry, None),
        "goal_pose": Port(entry),
        "output_goals": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Add the pose; fail where there is none."""
        pose = self.ports.get("goal_pose")
        if pose is None:
            return Status.FAILURE
        self.ports.set("output_goals", [*goals_of(self.ports.get("input_goals")), pose])
        return Status.SUCCESS


class GetNextFewGoals(Node):
    """Action node that outputs the first of some goals."""

    names = ("GetNextFewGoals",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_goals": Port(entry),
        "num_goals": Port(int),
        "output_goals": Port(entry, output=True),
    }

    def update(self) -> Status:
        """Take the first ones; fail where there are none."""
        goals = goals_of(self.ports.get("input_goals"))
        if not goals:
            return Status.FAILURE
        self.ports.set("output_goals", goals[: max(self.ports.get("num_goals"), 0)])
        return Status.SUCCESS


def goals_of(value: Any) -> list[Any]:
    """Return the poses of a list of goals, which newer releases of Nav2 wrap in a message with a field `goals`."""
    return list(getattr(value, "goals", value) or [])
