"""The reaction to a launch description that is to be included."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from ..event import Event
from ..event_handler import EventHandler
from ..events.include_launch_description import IncludeLaunchDescription
from ..some_entities_type import SomeEntitiesType
from ..utilities import is_a_subclass

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class OnIncludeLaunchDescription(EventHandler):
    """Event handler that visits the launch descriptions included in a launch service; parameters as for its base."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: is_a_subclass(event, IncludeLaunchDescription), **kwargs)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Yield the event's launch description."""
        super().handle(event, context)
        return cast("IncludeLaunchDescription", event).launch_description

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return "returns the launch_description in the event"

    @property
    def matcher_description(self) -> str:
        """Which events the handler is for, in words."""
        return "event issubclass of launch.events.IncludeLaunchDescription"
