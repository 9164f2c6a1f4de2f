"""The action that waits and then executes others."""

from __future__ import annotations

import asyncio
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from ..action import Action
from ..event import Event
from ..event_handler import EventHandler
from ..event_handlers import OnShutdown
from ..events import TimerEvent
from ..frontend.expose import expose_action
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import is_a_subclass
from ..utilities.type_utils import (
    NormalizedValueType,
    coerce_to_type,
    normalize_typed_substitution,
    perform_typed_substitution,
)
from .group_action import GroupAction
from .opaque_function import OpaqueFunction

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("timer")
class TimerAction(Action):
    """Action that executes actions after a time.

    They see the launch configurations and the environment of the moment when the time began.

    Parameters
    ----------
    period
        The time in seconds.
    actions
        The actions.
    cancel_on_shutdown
        Whether stopping the launch ends the wait; otherwise the launch goes on until the actions were
        executed.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if isinstance(period, str):
            warnings.warn("'period' of TimerAction is a number of seconds, not a string", stacklevel=2)
            period = coerce_to_type(period, float)
        self.__period = normalize_typed_substitution(period, float)
        self.__actions = list(actions)
        self.__cancel_on_shutdown = normalize_typed_substitution(cancel_on_shutdown, bool)
        self.__context_locals: dict[str, Any] = {}
        self.__launch_configurations: dict[str, str] = {}
        self.__environment: dict[str, str] = {}
        self._completed_future: asyncio.Future[None] | None = None
        self.__canceled = False
        self._canceled_future: asyncio.Future[bool] | None = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[TimerAction], dict[str, Any]]:
        """Read an element `timer`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["period"] = parser.parse_if_substitutions(entity.get_attr("period", data_type=float, can_be_str=True))
        cancel = entity.get_attr("cancel_on_shutdown", optional=True, data_type=bool, can_be_str=True)
        if cancel is not None:
            kwargs["cancel_on_shutdown"] = parser.parse_if_substitutions(cancel)
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children]
        return cls, kwargs

    @property
    def period(self) -> NormalizedValueType:
        """The time in seconds."""
        return self.__period

    @property
    def actions(self) -> list[LaunchDescriptionEntity]:
        """The actions."""
        return self.__actions

    def describe(self) -> str:
        """Return the action in words."""
        return f"TimerAction(period={self.period}, actions=<actions>)"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the actions."""
        return [(f"after {self.period} sec", self.actions)]

    def handle(self, context: LaunchContext) -> SomeEntitiesType | None:
        """Yield the actions, in a scope like the one in which the timer began."""
        context.extend_locals(self.__context_locals)
        return GroupAction([OpaqueFunction(function=self.__restore_scope), *self.actions])

    def __restore_scope(self, context: LaunchContext) -> None:
        context.launch_configurations.clear()
        context.launch_configurations.update(self.__launch_configurations)
        context.environment.clear()
        context.environment.update(self.__environment)

    def cancel(self) -> None:
        """Cancel the wait; the actions are not executed."""
        self.__canceled = True
        if self._canceled_future is not None and not self._canceled_future.done():
            self._canceled_future.set_result(True)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start waiting."""
        self.__context_locals = dict(context.get_locals_as_dict())
        self.__launch_configurations = dict(context.launch_configurations)
        self.__environment = dict(context.environment)
        loop = context.running_loop
        self._completed_future = completed = loop.create_future()
        self._canceled_future = canceled = loop.create_future()
        if self.__canceled:
            completed.set_result(None)
            return None
        _register_timer_handler(context)
        if perform_typed_substitution(context, self.__cancel_on_shutdown, bool):
            context.register_event_handler(OnShutdown(on_shutdown=self.__on_shutdown, handle_once=True))
        period = perform_typed_substitution(context, self.period, float)
        loop.create_task(self._wait_to_fire_event(context, period, completed, canceled))
        return None

    def __on_shutdown(self, event: Event, context: LaunchContext) -> None:
        self.cancel()

    async def _wait_to_fire_event(
        self, context: LaunchContext, period: float, completed: asyncio.Future[None], canceled: asyncio.Future[bool]
    ) -> None:
        """Wait for the period or for being cancelled, and emit the timer's event after the period."""
        try:
            await asyncio.wait([canceled], timeout=period)
            if not canceled.done():
                await context.emit_event(TimerEvent(timer_action=self))
        finally:
            completed.set_result(None)

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return a future that is done when the wait is over."""
        return self._completed_future


class _TimerEventHandler(EventHandler):
    """Event handler that passes the events of all timers to these."""

    def __init__(self) -> None:
        super().__init__(matcher=lambda event: is_a_subclass(event, TimerEvent))

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return cast("TimerEvent", event).timer_action.handle(context)


def _register_timer_handler(context: LaunchContext) -> None:
    if not any(isinstance(handler, _TimerEventHandler) for handler in context._event_handlers):
        context.register_event_handler(_TimerEventHandler())
