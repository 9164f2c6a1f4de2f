"""Goals that the client sends."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from action_msgs.msg import GoalStatus

from rosbridge_library.capability import Capability, Field, split_id
from rosbridge_library.internal.actions import ActionClientHandler
from rosbridge_library.internal.message_conversion import extract_values

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class SendActionGoal(Capability):
    """Operations ``send_action_goal`` and ``cancel_action_goal``; goals run beside each other."""

    send_action_goal_msg_fields: tuple[Field, ...] = (
        (True, "action", str),
        (True, "action_type", str),
        (False, "feedback", (bool, type(None))),
        (False, "fragment_size", (int, type(None))),
        (False, "compression", (str, type(None))),
        (False, "id", (str, int, type(None))),
    )
    cancel_action_goal_msg_fields: tuple[Field, ...] = (
        (True, "action", str),
        (False, "id", (str, int, type(None))),
    )
    actions_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self.client_handler_list: dict[Any, ActionClientHandler] = {}
        protocol.register_operation("send_action_goal", self.send_action_goal)
        protocol.register_operation("cancel_action_goal", self.cancel_action_goal)

    def send_action_goal(self, message: dict[str, Any]) -> None:
        """Send a goal; the client gets ``action_result``, with ``result`` false where it failed."""
        self.basic_type_check(message, self.send_action_goal_msg_fields)
        asked = message["action"]
        action, number = split_id(asked, message.get("id"))
        try:
            self.check_name(self.actions_glob, action)
            self.check_room(len(self.client_handler_list), "goals are under way")
            if number is not None and number in self.client_handler_list:
                raise ValueError(f"a goal of id {number!r} is under way")
        except Exception as error:
            self._fail(asked, number, error)
            return

        def succeeded(values: dict[str, Any]) -> None:
            self.client_handler_list.pop(key, None)
            self._respond(asked, number, values["result"], values["status"], True)

        def failed(error: Exception) -> None:
            self.client_handler_list.pop(key, None)
            self._fail(asked, number, error)

        feedback = partial(self._feedback, asked, number) if message.get("feedback") else None
        handler = ActionClientHandler(
            action, message["action_type"], message.get("args", []), succeeded, failed, feedback,
            self.protocol.node_handle,
        )  # fmt: skip
        key = id(handler) if number is None else number
        self.client_handler_list[key] = handler
        handler.start()

    def cancel_action_goal(self, message: dict[str, Any]) -> None:
        """Ask for a goal to be cancelled."""
        self.basic_type_check(message, self.cancel_action_goal_msg_fields)
        _, number = split_id(message["action"], message.get("id"))
        handler = self.client_handler_list.get(number)
        if handler is None:
            raise LookupError(f"there is no goal of id {number!r}")
        handler.send_goal_helper.cancel_goal()

    def _fail(self, action: str, number: Any, error: Exception) -> None:
        self.protocol.log("error", f"send_action_goal {type(error).__name__}: {error}", number)
        self._respond(action, number, str(error), GoalStatus.STATUS_UNKNOWN, False)

    def _respond(self, action: str, number: Any, values: Any, status: int, result: bool) -> None:
        response = {"op": "action_result", "action": action, "values": values, "status": status, "result": result}
        self.protocol.send(response if number is None else {**response, "id": number})

    def _feedback(self, action: str, number: Any, message: Any) -> None:
        feedback = {"op": "action_feedback", "action": action, "values": extract_values(message.feedback)}
        self.protocol.send(feedback if number is None else {**feedback, "id": number})

    def finish(self) -> None:
        """Cancel the goals of a client that has left."""
        for handler in list(self.client_handler_list.values()):
            handler.send_goal_helper.cancel_goal()
        self.client_handler_list.clear()
        self.protocol.unregister_operation("send_action_goal")
        self.protocol.unregister_operation("cancel_action_goal")
