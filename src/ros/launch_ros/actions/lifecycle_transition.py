"""The action that takes nodes through transitions of their life cycle."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import launch.logging
from launch import Action
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.event import Event
from launch.event_handler import EventHandler
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..event_handlers import OnStateTransition
from ..events.lifecycle import ChangeState, StateTransition
from ..events.matchers import matches_node_name

if TYPE_CHECKING:
    from launch import LaunchContext

# Numbers and states as in lifecycle_msgs, which only nodes that run need.
CONFIGURE, CLEANUP, ACTIVATE, DEACTIVATE = 1, 2, 3, 4
UNCONFIGURED_SHUTDOWN, INACTIVE_SHUTDOWN, ACTIVE_SHUTDOWN = 5, 6, 7

_STATES = {
    CONFIGURE: ("unconfigured", "configuring", "inactive"),
    CLEANUP: ("inactive", "cleaningup", "unconfigured"),
    ACTIVATE: ("inactive", "activating", "active"),
    DEACTIVATE: ("active", "deactivating", "inactive"),
    UNCONFIGURED_SHUTDOWN: ("unconfigured", "shuttingdown", "finalized"),
    INACTIVE_SHUTDOWN: ("inactive", "shuttingdown", "finalized"),
    ACTIVE_SHUTDOWN: ("active", "shuttingdown", "finalized"),
}


def match_node_name_start_goal(node_name: str, start_state: str, goal_state: str) -> Callable[[Event], bool]:
    """Return a function that returns whether an event is a node's transition between two states."""
    return lambda event: (
        isinstance(event, StateTransition)
        and event.action.node_name == node_name
        and event.start_state == start_state
        and event.goal_state == goal_state
    )


def match_node_name_goal(node_name: str, goal_state: str) -> Callable[[Event], bool]:
    """Return a function that returns whether an event is a node's transition to a state."""
    return lambda event: (
        isinstance(event, StateTransition) and event.action.node_name == node_name and event.goal_state == goal_state
    )


class LifecycleTransition(Action):
    """Action that requests transitions of nodes one after another, each when the one before is done.

    Parameters
    ----------
    lifecycle_node_names
        The full names of the nodes.
    transition_ids
        The transitions, constants of `lifecycle_msgs.msg.Transition`.
    **kwargs
        As for `Action`.

    Raises
    ------
    ValueError
        If no nodes or no transitions are given.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self.__transitions = [
            normalize_to_list_of_substitutions(str(number) if isinstance(number, int) else number)
            for number in transition_ids
        ]
        if not self.__names:
            raise ValueError("No lifecycle_node_names provided.")
        if not self.__transitions:
            raise ValueError("No transition_ids provided.")

    @classmethod
    def bringup(cls, node_name: str) -> LifecycleTransition:
        """Return the action that configures and activates a node."""
        return cls(lifecycle_node_names=[node_name], transition_ids=[CONFIGURE, ACTIVATE])

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Request the first transition, and each next one when its time comes."""
        names = [perform_substitutions(context, name) for name in self.__names]
        transitions = [int(perform_substitutions(context, number)) for number in self.__transitions]
        entities: list[LaunchDescriptionEntity] = []
        for name in names:
            node_name = name if name.startswith("/") else f"/{name}"
            entities += self.__steps(node_name, transitions)
        return entities

    def __steps(self, node_name: str, transitions: list[int]) -> list[LaunchDescriptionEntity]:
        logger = launch.logging.get_logger("launch_ros.actions.lifecycle_transition")
        unknown = [number for number in transitions if number not in _STATES]
        if unknown:
            raise ValueError(f"unknown lifecycle transitions: {unknown}")
        requests = [_request(node_name, number) for number in transitions]
        handlers: list[EventHandler] = []

        def give_up(context: LaunchContext) -> None:
            logger.error(f"a transition of {node_name} failed; transitions after it are left out")
            for handler in handlers:
                if handler in context._event_handlers:
                    context.unregister_event_handler(handler)

        for number, following in itertools.zip_longest(transitions, requests[1:]):
            start, through, goal = _STATES[number]
            if following is not None:
                handlers.append(
                    OnStateTransition(
                        matcher=match_node_name_start_goal(node_name, through, goal),
                        entities=[following],
                        handle_once=True,
                    )
                )
            handlers.append(
                OnStateTransition(
                    matcher=match_node_name_start_goal(node_name, through, start),
                    entities=[OpaqueFunction(function=give_up)],
                )
            )
        return [*(RegisterEventHandler(handler) for handler in handlers), requests[0]]


def _request(node_name: str, transition: int) -> EmitEvent:
    matcher = matches_node_name(node_name)
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matcher, transition_id=transition))
