"""Container as an action server."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Iterable, Mapping
from typing import Any

import smach
from rclpy.action import ActionServer, CancelResponse
from rclpy.node import Node

_POLL_S = 0.05


class ActionServerWrapper:
    """Action server that executes a container for each goal.

    Parameters
    ----------
    node
        The node of the server.
    server_name, action_spec
        The action and its class.
    wrapped_container
        The container.
    succeeded_outcomes, aborted_outcomes, preempted_outcomes
        Outcomes of the container by the status of the goal.
    goal_key, feedback_key, result_key
        Userdata of the container with the goal, the feedback and the result.
    goal_slots_map, feedback_slots_map, result_slots_map
        Userdata of the container by field of the goal, the feedback and the result.
    expand_goal_slots
        Whether every field of the goal is userdata under its name.
    pack_result_slots
        Whether userdata become the fields of the result that have their names.
    """

    def __init__(
        self,
        node: Node,
        server_name: str,
        action_spec: Any,
        wrapped_container: Any,
        succeeded_outcomes: Iterable[str] = (),
        aborted_outcomes: Iterable[str] = (),
        preempted_outcomes: Iterable[str] = (),
        goal_key: str = "action_goal",
        feedback_key: str = "action_feedback",
        result_key: str = "action_result",
        goal_slots_map: Mapping[str, str] | None = None,
        feedback_slots_map: Mapping[str, str] | None = None,
        result_slots_map: Mapping[str, str] | None = None,
        expand_goal_slots: bool = False,
        pack_result_slots: bool = False,
    ) -> None:
        self._node = node
        self._action_spec = action_spec
        self.wrapped_container = wrapped_container
        self._succeeded = set(succeeded_outcomes)
        self._aborted = set(aborted_outcomes)
        self._preempted = set(preempted_outcomes)
        if self._succeeded & self._aborted or self._aborted & self._preempted or self._preempted & self._succeeded:
            node.get_logger().error("Succeeded, aborted, and preempted outcomes are not mutually disjoint")
        self._goal_key, self._feedback_key, self._result_key = goal_key, feedback_key, result_key
        self._goal_slots = dict(goal_slots_map or {})
        self._feedback_slots = dict(feedback_slots_map or {})
        self._result_slots = dict(result_slots_map or {})
        if expand_goal_slots:
            self._goal_slots = {**_same(action_spec.Goal), **self._goal_slots}
        self._packed = _same(action_spec.Result) if pack_result_slots else {}
        self._goal_handle: Any = None
        self.userdata = smach.UserData()
        keys = [goal_key, feedback_key, result_key, *self._goal_slots.values()]
        wrapped_container.register_input_keys(keys)
        wrapped_container.register_transition_cb(self._publish_feedback)
        self._action_server: Any = ActionServer(
            node, action_spec, server_name, self._execute, cancel_callback=lambda goal: CancelResponse.ACCEPT
        )

    def run_server(self) -> None:
        """Do nothing: the server takes goals since it was constructed."""

    def _execute(self, goal_handle: Any) -> Any:
        """Execute the container for a goal, and return the result."""
        self._goal_handle = goal_handle
        goal = goal_handle.request
        self.userdata[self._goal_key] = goal
        self.userdata[self._feedback_key] = self._action_spec.Feedback()
        self.userdata[self._result_key] = self._action_spec.Result()
        for slot, key in self._goal_slots.items():
            self.userdata[key] = getattr(goal, slot)
        outcome = self._run_container(goal_handle)
        result = self.userdata[self._result_key]
        for slot, key in {**self._packed, **self._result_slots}.items():
            if key in self.userdata:
                setattr(result, slot, self.userdata[key])
        if outcome in self._succeeded:
            goal_handle.succeed()
        elif outcome in self._preempted and goal_handle.is_cancel_requested:
            goal_handle.canceled()
        else:
            goal_handle.abort()
        return result

    def _run_container(self, goal_handle: Any) -> str | None:
        container, done = self.wrapped_container, threading.Event()

        def watch() -> None:
            while not done.wait(_POLL_S):
                if goal_handle.is_cancel_requested:
                    self._node.get_logger().info("Preempt on state machine requested!")
                    container.request_preempt()
                    return

        watcher = threading.Thread(target=watch)
        watcher.start()
        seen = smach.Remapper(
            self.userdata,
            container.get_registered_input_keys(),
            {*container.get_registered_output_keys(), self._result_key, self._feedback_key},
        )
        try:
            outcome: str | None = container.execute(seen)
        except Exception:  # code of the user's may raise anything
            self._node.get_logger().error(f"The wrapped container failed: {traceback.format_exc()}")
            outcome = None
        finally:
            done.set()
            watcher.join()
        return outcome

    def _publish_feedback(self, userdata: Any, active_states: Any) -> None:
        if self._goal_handle is None or self._feedback_key not in self.userdata:
            return
        feedback = self.userdata[self._feedback_key]
        if self._feedback_key in userdata:
            feedback = userdata[self._feedback_key]
        for slot, key in self._feedback_slots.items():
            if key in userdata:
                setattr(feedback, slot, userdata[key])
        if self._goal_handle.is_active:
            self._goal_handle.publish_feedback(feedback)


def _same(message_type: Any) -> dict[str, str]:
    """Return the fields of a message, each by its own name."""
    return {field: field for field in message_type.get_fields_and_field_types()}
