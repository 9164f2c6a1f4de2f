"""The base of all event handlers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from .event import Event
from .launch_description_entity import LaunchDescriptionEntity
from .some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class BaseEventHandler:
    """Event handler: a matcher of events, and the entities to visit when one matches.

    Parameters
    ----------
    matcher
        Answers whether an event is one of those.
    handle_once
        Whether the handler retires after the first event.
    """

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self.__matcher = matcher
        self.__handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        """Whether the handler retires after the first event."""
        return self.__handle_once

    @property
    def handler_description(self) -> str | None:
        """What the handler does, in words, where it is known."""
        return None

    @property
    def matcher_description(self) -> str | None:
        """Which events the handler is for, in words, where it is known."""
        return None

    def matches(self, event: Event) -> bool:
        """Return whether the handler is for this event."""
        return self.__matcher(event)

    def describe(self) -> tuple[str, list[SomeEntitiesType]]:
        """Return the handler in words and the entities that it may yield."""
        text = (
            f"{type(self).__name__}(matcher='{self.matcher_description}', "
            f"handler='{self.handler_description}', handle_once={self.handle_once})"
        )
        return text, []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """React to an event; the event is in the context's locals while its entities are visited."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """An event handler with a fixed list of entities.

    Parameters
    ----------
    matcher
        Answers whether an event is one that the handler is for.
    entities
        Visited whenever such an event comes.
    handle_once
        Whether the handler retires after the first event.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self.__entities: list[LaunchDescriptionEntity] | None
        if entities is None or isinstance(entities, list):
            self.__entities = entities
        elif isinstance(entities, LaunchDescriptionEntity):
            self.__entities = [entities]
        else:
            self.__entities = list(entities)

    @property
    def entities(self) -> list[LaunchDescriptionEntity] | None:
        """The entities that are visited when the event comes."""
        return self.__entities

    def describe(self) -> tuple[str, list[SomeEntitiesType]]:
        """Return the handler in words and the entities that it yields."""
        text, _ = super().describe()
        return text, list(self.entities or [])

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Yield the handler's entities."""
        super().handle(event, context)
        return self.entities
