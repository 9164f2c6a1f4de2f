"""The action that stops the launch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..events.process.process_exited import ProcessExited
from ..events.shutdown import Shutdown as ShutdownEvent
from ..frontend.expose import expose_action
from .emit_event import EmitEvent

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("shutdown")
class Shutdown(EmitEvent):
    """Action that stops the launch and all its processes.

    Parameters
    ----------
    reason
        Why, for people.
    **kwargs
        As for `Action`.
    """

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Shutdown], dict[str, Any]]:
        """Read an element `shutdown`."""
        _, kwargs = super().parse(entity, parser)
        reason = entity.get_attr("reason", optional=True)
        if reason is not None:
            kwargs["reason"] = parser.escape_characters(reason)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Emit the event that stops the launch."""
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            from ..logging import get_logger

            get_logger("launch").info(f"process[{event.process_name}] was required: shutting down launched system")
        super().execute(context)
