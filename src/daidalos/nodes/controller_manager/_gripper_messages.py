"""Messages of the gripper actions: with a single position, and with joint states."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.controller_manager._entries import ActionEntry
from daidalos.samples import controllers as samples
from daidalos.samples.fields import time_message


def _single_type() -> Any:
    from control_msgs.action import GripperCommand

    return GripperCommand


def _single_request(goal: Any) -> samples.GripperRequest:
    return samples.GripperRequest(goal.command.position, goal.command.max_effort)


def _fill_single(message: Any, state: samples.GripperState) -> Any:
    message.position, message.effort = state.position, state.effort
    message.stalled, message.reached_goal = state.stalled, state.reached_goal
    return message


def _parallel_type() -> Any:
    from control_msgs.action import ParallelGripperCommand

    return ParallelGripperCommand


def _parallel_request(goal: Any) -> samples.ParallelGripperRequest:
    command = goal.command
    return samples.ParallelGripperRequest(
        position=command.position[0] if command.position else float("nan"),
        max_effort=command.effort[0] if command.effort else 0.0,
        max_velocity=command.velocity[0] if command.velocity else 0.0,
        joint=command.name[0] if command.name else "",
    )


def _joint_state(state: samples.GripperState) -> Any:
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Header

    return JointState(
        header=Header(stamp=time_message(state.stamp_ns)),
        name=[state.joint],
        position=[state.position],
        velocity=[state.velocity],
        effort=[state.effort],
    )


def _parallel_result(state: samples.GripperState) -> Any:
    return _parallel_type().Result(state=_joint_state(state), stalled=state.stalled, reached_goal=state.reached_goal)


SINGLE = ActionEntry(
    _single_type,
    _single_request,
    lambda state: _fill_single(_single_type().Feedback(), state),
    lambda state: _fill_single(_single_type().Result(), state),
)
PARALLEL = ActionEntry(
    _parallel_type,
    _parallel_request,
    lambda state: _parallel_type().Feedback(state=_joint_state(state)),
    _parallel_result,
)
