"""The action that marks a launch as ready for its tests."""

from __future__ import annotations

from collections.abc import Callable

from launch import LaunchContext, LaunchDescriptionEntity
from launch.action import Action


class ReadyToTest(Action):
    """Action that marks what was described before it as started."""

    def __init__(self) -> None:
        super().__init__()
        self.__callbacks: list[Callable[[], None]] = []

    def _add_callback(self, callback: Callable[[], None]) -> None:
        """Call a function when the action is executed."""
        self.__callbacks.append(callback)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Call the functions that wait for this."""
        for callback in self.__callbacks:
            callback()
        return None
