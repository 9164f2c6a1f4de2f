"""Actions that the client offers."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from action_msgs.msg import GoalStatus
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from daidalos.transport.steady_timers import STEADY_TIMERS
from rosbridge_library.capabilities.advertise_service import offered_by
from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.message_conversion import extract_values
from rosbridge_library.internal.ros_loader import get_action_class

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol

_RESULT_TIME_NS = 1_000_000_000
"""Time that clients of the graph have to fetch the results of goals that end because the action does."""


class AdvertisedActionHandler:
    """Action of the graph whose goals go to a client.

    Parameters
    ----------
    action_name, action_type
        Name and type of the action.
    protocol
        The client.
    """

    def __init__(self, action_name: str, action_type: str, protocol: Protocol) -> None:
        self.goal_futures: dict[str, Future] = {}
        self.goal_handles: dict[str, Any] = {}
        self.action_name = action_name
        self.action_type = action_type
        self.protocol = protocol
        self._class = get_action_class(action_type)
        self._number = 0
        self.action_server = ActionServer(
            protocol.node_handle,
            self._class,
            action_name,
            self.execute_callback,
            cancel_callback=self.cancel_callback,
            callback_group=ReentrantCallbackGroup(),
        )

    def next_id(self) -> int:
        """Return the number of the next goal."""
        self._number += 1
        return self._number

    async def execute_callback(self, goal: Any) -> Any:
        """Pass a goal to the client and wait for its end; its future holds status and result."""
        number = f"action_goal:{self.action_name}:{self.next_id()}"
        self.goal_handles[number] = goal
        future = self.goal_futures[number] = Future(executor=self.protocol.node_handle.executor)
        self.protocol.send(
            {
                "op": "send_action_goal",
                "id": number,
                "action": self.action_name,
                "action_type": self.action_type,
                "args": extract_values(goal.request),
                "feedback": True,
            }
        )
        try:
            status, result = await future
        finally:
            self.goal_futures.pop(number, None)
            self.goal_handles.pop(number, None)
        if status == GoalStatus.STATUS_SUCCEEDED:
            goal.succeed()
        elif status == GoalStatus.STATUS_CANCELED and goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return result

    def cancel_callback(self, cancel_request: Any) -> CancelResponse:
        """Pass the wish to cancel a goal to the client."""
        for number, handle in list(self.goal_handles.items()):
            if bytes(handle.goal_id.uuid) == bytes(cancel_request.goal_id.uuid):
                self.protocol.send({"op": "cancel_action_goal", "id": number, "action": self.action_name})
        return CancelResponse.ACCEPT

    def handle_feedback(self, goal_id: str, feedback: Any) -> None:
        """Publish the client's feedback."""
        handle = self.goal_handles.get(goal_id)
        if handle is None:
            self.protocol.log("warning", f"Received action feedback for unrecognized id: {goal_id}")
        else:
            handle.publish_feedback(feedback)

    def handle_result(self, goal_id: str, result: Any, status: int) -> None:
        """End a goal with the client's result."""
        future = self.goal_futures.get(goal_id)
        if future is None:
            self.protocol.log("warning", f"Received action result for unrecognized id: {goal_id}")
        else:
            future.set_result((status, result))

    def handle_abort(self, goal_id: str) -> None:
        """Abort a goal that the client could not carry out."""
        self.handle_result(goal_id, self._class.Result(), GoalStatus.STATUS_ABORTED)

    def graceful_shutdown(self) -> None:
        """Offer the action no longer; goals under way are aborted."""
        waiting = list(self.goal_futures)
        if waiting:
            self.protocol.log(
                "warning",
                f"Action {self.action_name} was unadvertised with an action in progress, "
                f"aborting action goals with request IDs {', '.join(waiting)}",
            )
        for number in waiting:
            self.handle_abort(number)
        if waiting:
            STEADY_TIMERS.at(time.monotonic_ns() + _RESULT_TIME_NS, self.action_server.destroy)
        else:
            self.action_server.destroy()


class AdvertiseAction(Capability):
    """Operation ``advertise_action``; an action of another client is taken over."""

    advertise_action_msg_fields: tuple[Field, ...] = ((True, "action", str), (True, "type", str))
    actions_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("advertise_action", self.advertise_action)

    def advertise_action(self, message: dict[str, Any]) -> None:
        """Offer an action."""
        self.basic_type_check(message, self.advertise_action_msg_fields)
        name = message["action"]
        self.check_name(self.actions_glob, name)
        actions = self.protocol.external_action_list
        self.check_room(len(offered_by(self.protocol, actions)), "actions are offered")
        get_action_class(message["type"])  # before the earlier one ends
        earlier = actions.pop(name, None)
        if earlier is not None:
            self.protocol.log("warning", f"Duplicate action advertised. Overwriting {name}.")
            earlier.graceful_shutdown()
        actions[name] = AdvertisedActionHandler(name, message["type"], self.protocol)

    def finish(self) -> None:
        """Offer no more actions."""
        for name in offered_by(self.protocol, self.protocol.external_action_list):
            self.protocol.external_action_list.pop(name).graceful_shutdown()
        self.protocol.unregister_operation("advertise_action")
