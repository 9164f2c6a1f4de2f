"""Trajectories of joints as goals, feedback and results of their action, and answers of their service."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.controller_manager._entries import ActionEntry, ServiceEntry
from daidalos.samples import controllers as samples
from daidalos.samples.fields import nanoseconds, seconds, time_message
from daidalos.samples.special_messages import trajectory_of, trajectory_point


def _action_type() -> Any:
    from control_msgs.action import FollowJointTrajectory

    return FollowJointTrajectory


def _request(goal: Any) -> samples.TrajectoryRequest:
    def tolerances(rows: Any) -> dict[str, samples.JointTolerance]:
        return {row.name: samples.JointTolerance(row.position, row.velocity, row.acceleration) for row in rows}

    return samples.TrajectoryRequest(
        trajectory_of(goal.trajectory),
        tolerances(goal.path_tolerance),
        tolerances(goal.goal_tolerance),
        seconds(goal.goal_time_tolerance),
    )


def _feedback(feedback: samples.TrajectoryFeedback) -> Any:
    from std_msgs.msg import Header

    return _action_type().Feedback(
        header=Header(stamp=time_message(feedback.stamp_ns)),
        joint_names=list(feedback.joints),
        desired=trajectory_point(feedback.desired),
        actual=trajectory_point(feedback.actual),
        error=trajectory_point(feedback.error),
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
