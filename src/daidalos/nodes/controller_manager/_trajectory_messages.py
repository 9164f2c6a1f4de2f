"""Trajectories of joints as messages."""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.nodes.controller_manager._entries import ActionEntry, ServiceEntry
from daidalos.nodes.conversions import duration_message, nanoseconds, seconds, time_message
from daidalos.nodes.gazebo_ros._conversion import header
from daidalos.samples import controllers as samples

_FIELDS = ("positions", "velocities", "accelerations")


def trajectory_command(message: Any) -> samples.TrajectoryCommand:
    """Return a ``trajectory_msgs/msg/JointTrajectory``."""
    points = tuple(trajectory_point_command(point) for point in message.points)
    return samples.TrajectoryCommand(tuple(message.joint_names), points, nanoseconds(message.header.stamp))


def trajectory_point_command(point: Any) -> samples.TrajectoryPoint:
    """Return a ``trajectory_msgs/msg/JointTrajectoryPoint``."""

    def row(values: Any) -> Any:
        return np.array(values, dtype=np.float64) if len(values) else None

    return samples.TrajectoryPoint(
        seconds(point.time_from_start), *(row(getattr(point, name)) for name in (*_FIELDS, "effort"))
    )


def _point(point: samples.TrajectoryPoint) -> Any:
    from trajectory_msgs.msg import JointTrajectoryPoint

    given = {name: getattr(point, name) for name in _FIELDS} | {"effort": point.efforts}
    return JointTrajectoryPoint(
        time_from_start=duration_message(point.time),
        **{name: values for name, values in given.items() if values is not None},
    )


def trajectory_state(sample: samples.TrajectorySample) -> Any:
    """Return a ``control_msgs/msg/JointTrajectoryControllerState``."""
    from control_msgs.msg import JointTrajectoryControllerState

    return JointTrajectoryControllerState(
        header=header(sample),
        joint_names=list(sample.joints),
        reference=_point(sample.desired),
        feedback=_point(sample.actual),
        error=_point(sample.error),
        output=_point(sample.output),
        speed_scaling_factor=sample.speed,
    )


def _action_type() -> Any:
    from control_msgs.action import FollowJointTrajectory

    return FollowJointTrajectory


def _request(goal: Any) -> samples.TrajectoryRequest:
    def tolerances(rows: Any) -> dict[str, samples.JointTolerance]:
        return {row.name: samples.JointTolerance(row.position, row.velocity, row.acceleration) for row in rows}

    return samples.TrajectoryRequest(
        trajectory_command(goal.trajectory),
        tolerances(goal.path_tolerance),
        tolerances(goal.goal_tolerance),
        seconds(goal.goal_time_tolerance),
    )


def _feedback(feedback: samples.TrajectoryFeedback) -> Any:
    from std_msgs.msg import Header

    return _action_type().Feedback(
        header=Header(stamp=time_message(feedback.stamp_ns)),
        joint_names=list(feedback.joints),
        desired=_point(feedback.desired),
        actual=_point(feedback.actual),
        error=_point(feedback.error),
    )


def _result(result: samples.TrajectoryResult) -> Any:
    return _action_type().Result(error_code=result.code, error_string=result.text)


def _service_type() -> Any:
    from control_msgs.srv import QueryTrajectoryState

    return QueryTrajectoryState


def _fill(response: Any, answer: samples.TrajectoryStateResponse) -> Any:
    response.success = answer.known
    response.message = "" if answer.known else "the trajectory had not begun at that time"
    response.name = list(answer.joints)
    for field, name in (("position", "positions"), ("velocity", "velocities"), ("acceleration", "accelerations")):
        values = getattr(answer.point, name)
        if values is not None:
            setattr(response, field, values)
    return response


ACTION = ActionEntry(_action_type, _request, _feedback, _result)
SERVICE = ServiceEntry(_service_type, lambda request: samples.TrajectoryStateRequest(nanoseconds(request.time)), _fill)
