"""Results of actions that the client offers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosbridge_library.capabilities.advertise_service import offer_of
from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.message_conversion import populate_instance
from rosbridge_library.internal.ros_loader import get_action_result_instance

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class ActionResult(Capability):
    """Operation ``action_result``."""

    action_result_msg_fields: tuple[Field, ...] = (
        (True, "action", str),
        (False, "id", str),
        (False, "values", (dict, str)),
        (True, "status", int),
        (True, "result", bool),
    )

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("action_result", self.action_result)

    def action_result(self, message: dict[str, Any]) -> None:
        """End a goal; with ``result`` false, it is aborted."""
        self.basic_type_check(message, self.action_result_msg_fields)
        handler = offer_of(self.protocol, self.protocol.external_action_list, "Action", message["action"])
        number, values = message.get("id", ""), message.get("values", {})
        if not message["result"] or isinstance(values, str):
            handler.handle_abort(number)
            return
        result = populate_instance(values, get_action_result_instance(handler.action_type))
        handler.handle_result(number, result, message["status"])
