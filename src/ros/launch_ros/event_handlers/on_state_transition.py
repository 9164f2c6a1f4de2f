"""The reaction to a node that made a transition of its life cycle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from launch.event import Event
from launch.event_handler import EventHandler
from launch.some_entities_type import SomeEntitiesType

from ..events.lifecycle import StateTransition

if TYPE_CHECKING:
    from ..actions import LifecycleNode


class OnStateTransition(EventHandler):
    """Event handler that visits entities when a node made a transition.

    Parameters
    ----------
    entities
        The entities.
    target_lifecycle_node
        The action that runs the node, None for any.
    transition, start_state, goal_state
        Labels of the transition and of the states before and after it, None for any.
    matcher
        Tells whether an event is meant, instead of all these.
    **kwargs
        As for `launch.EventHandler`.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        criteria = {"transition": transition, "start_state": start_state, "goal_state": goal_state}
        if matcher is not None and (target_lifecycle_node is not None or any(criteria.values())):
            raise ValueError("either a matcher or the criteria of the transition can be given, not both")
        self.__target_lifecycle_node = target_lifecycle_node
        self.__criteria = {name: value for name, value in criteria.items() if value is not None}
        super().__init__(matcher=matcher or self.__is_meant, entities=entities, **kwargs)

    def __is_meant(self, event: Event) -> bool:
        if not isinstance(event, StateTransition):
            return False
        target = self.__target_lifecycle_node
        if target is not None and event.action is not target:
            return False
        return all(getattr(event, name) == value for name, value in self.__criteria.items())

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return "<actions>"

    @property
    def matcher_description(self) -> str:
        """Which events the handler is for, in words."""
        parts = ["event is StateTransition"]
        if self.__target_lifecycle_node is not None:
            parts.append(f"event.action is {self.__target_lifecycle_node}")
        parts += [f"event.{name} == '{value}'" for name, value in self.__criteria.items()]
        return " and ".join(parts)
