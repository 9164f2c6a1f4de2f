"""Requests of controllers, with their services and actions."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.controller_manager import _gripper_messages, _trajectory_messages
from daidalos.nodes.controller_manager._entries import ActionEntry, ServiceEntry
from daidalos.samples import controllers as samples


def _set_bool() -> Any:
    from std_srvs.srv import SetBool

    return SetBool


def _trigger() -> Any:
    from std_srvs.srv import Trigger

    return Trigger


def _fill_answer(response: Any, answer: samples.Answer) -> Any:
    response.success, response.message = answer.success, answer.text
    return response


SERVICES: dict[type, ServiceEntry] = {
    samples.TrajectoryStateRequest: _trajectory_messages.SERVICE,
    samples.Switched: ServiceEntry(_set_bool, lambda request: samples.Switched(request.data), _fill_answer),
    samples.Asked: ServiceEntry(_trigger, lambda request: samples.Asked(), _fill_answer),
}
ACTIONS: dict[type, ActionEntry] = {
    samples.TrajectoryRequest: _trajectory_messages.ACTION,
    samples.GripperRequest: _gripper_messages.SINGLE,
    samples.ParallelGripperRequest: _gripper_messages.PARALLEL,
}
