"""The base of the event handlers for events that belong to an action."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from ..event import Event
from ..event_handler import BaseEventHandler
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType
from ..utilities import is_a_subclass, normalize_to_list_of_entities

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_context import LaunchContext


class OnActionEventBase(BaseEventHandler):
    """Handles one class of events of one action, of those that a function picks, or of all.

    Parameters
    ----------
    action_matcher
        The action, a function that returns whether an action is meant, or None for all.
    on_event
        The entities to visit, or a function that takes the event and the context and returns them.
    target_event_cls
        The class of events; each has an `action`.
    target_action_cls
        The class of actions.
    **kwargs
        As for `BaseEventHandler`.
    """

    def __init__(
        self,
        *,
        action_matcher: Callable[[Any], bool] | Action | None,
        on_event: SomeEntitiesType | Callable[[Any, LaunchContext], SomeEntitiesType | None],
        target_event_cls: type[Event],
        target_action_cls: type[Action],
        **kwargs: Any,
    ) -> None:
        if not (action_matcher is None or callable(action_matcher) or is_a_subclass(action_matcher, target_action_cls)):
            raise TypeError(
                f"{type(self).__name__} is for an instance of {target_action_cls.__name__}, a function "
                f"that picks some, or None for all, but it got {action_matcher!r}"
            )
        self.__target_action_cls = target_action_cls
        self.__target_event_cls = target_event_cls
        self.__action_matcher = action_matcher
        super().__init__(matcher=self.__is_meant, **kwargs)
        self.__on_event: Callable[..., SomeEntitiesType | None] | None = None
        self.__entities: list[LaunchDescriptionEntity] = []
        if callable(on_event):
            self.__on_event = on_event
        else:
            try:
                self.__entities = normalize_to_list_of_entities(on_event)
            except TypeError as error:
                raise TypeError(
                    f"{type(self).__name__} expects a function or entities for its event, but it got {on_event!r}"
                ) from error

    def __is_meant(self, event: Event) -> bool:
        if not is_a_subclass(event, self.__target_event_cls):
            return False
        matcher = self.__action_matcher
        if matcher is None:
            return True
        action = cast("Any", event).action
        if callable(matcher):
            return bool(matcher(action))
        return bool(action == matcher)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or yield the entities."""
        super().handle(event, context)
        return self.__entities if self.__on_event is None else self.__on_event(event, context)

    def describe(self) -> tuple[str, list[SomeEntitiesType]]:
        """Return the handler in words and the entities that it yields, where they are known."""
        text, _ = super().describe()
        return text, list(self.__entities)

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return "<actions>" if self.__on_event is None else f"{self.__on_event}"

    @property
    def matcher_description(self) -> str:
        """Which events the handler is for, in words."""
        event = self.__target_event_cls.__name__
        if self.__action_matcher is None:
            return f"event == {event}"
        target = f"{self.__target_action_cls.__name__}({self.__action_matcher!r})"
        return f"event == {event} and event.action == {target}"
