"""Feedback of actions that the client offers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosbridge_library.capabilities.advertise_service import offer_of
from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.message_conversion import populate_instance
from rosbridge_library.internal.ros_loader import get_action_feedback_instance

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class ActionFeedback(Capability):
    """Operation ``action_feedback``."""

    action_feedback_msg_fields: tuple[Field, ...] = ((True, "action", str), (False, "id", str), (False, "values", dict))

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("action_feedback", self.action_feedback)

    def action_feedback(self, message: dict[str, Any]) -> None:
        """Publish feedback of a goal."""
        self.basic_type_check(message, self.action_feedback_msg_fields)
        handler = offer_of(self.protocol, self.protocol.external_action_list, "Action", message["action"])
        feedback = populate_instance(message.get("values", {}), get_action_feedback_instance(handler.action_type))
        handler.handle_feedback(message.get("id", ""), feedback)
