"""The base of the actions that run test programs."""

from __future__ import annotations

from typing import Any

from launch import LaunchContext, LaunchDescriptionEntity
from launch.actions import ExecuteProcess, OpaqueFunction, TimerAction
from launch.event import Event
from launch.event_handlers import OnProcessExit
from launch.events import matches_action
from launch.events.process import ShutdownProcess


class Test(ExecuteProcess):
    """Action that runs a test program, for some time at most.

    Parameters
    ----------
    timeout
        Seconds after which it is stopped; None for never.
    **kwargs
        As for `launch.actions.ExecuteProcess`.
    """

    __test__ = False

    def __init__(self, *, timeout: float | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__timeout = timeout
        self.__timer: TimerAction | None = None

    @property
    def timeout(self) -> float | None:
        """Seconds after which the program is stopped."""
        return self.__timeout

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the program."""
        entities = super().execute(context) or []
        if self.__timeout is None:
            return entities
        self.__timer = TimerAction(period=self.__timeout, actions=[OpaqueFunction(function=self.__stop)])
        context.register_event_handler(
            OnProcessExit(target_action=self, on_exit=self.__on_exit, handle_once=True), append=True
        )
        return [*entities, self.__timer]

    def __stop(self, context: LaunchContext) -> None:
        context.emit_event_sync(ShutdownProcess(process_matcher=matches_action(self)))

    def __on_exit(self, event: Event, context: LaunchContext) -> None:
        if self.__timer is not None:
            self.__timer.cancel()
