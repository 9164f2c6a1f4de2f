"""Actions that the client offers no longer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rosbridge_library.capabilities.advertise_service import offer_of
from rosbridge_library.capability import Capability, Field

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class UnadvertiseAction(Capability):
    """Operation ``unadvertise_action``."""

    fields: tuple[Field, ...] = ((True, "action", str),)
    actions_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("unadvertise_action", self.unadvertise_action)

    def unadvertise_action(self, message: dict[str, Any]) -> None:
        """Offer an action no longer."""
        self.basic_type_check(message, self.fields)
        name = message["action"]
        self.check_name(self.actions_glob, name)
        actions = self.protocol.external_action_list
        offer_of(self.protocol, actions, "Action", name).graceful_shutdown()
        del actions[name]
