"""Guard conditions: callbacks that run when somebody triggers them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.context import Context
from rclpy.exceptions import NotInitializedException
from rclpy.impl.entities import GuardConditionHandle
from rclpy.impl.ready import ReadyHook
from rclpy.utilities import get_default_context


class GuardCondition:
    """Made by `Node.create_guard_condition`."""

    def __init__(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None,
        context: Context | None = None,
    ) -> None:
        context = context or get_default_context()
        if context.handle is None:
            raise NotInitializedException("the context must be initialized before it can have guard conditions")
        self._rcl_hook = ReadyHook(self)
        self._rcl_node: Any = None
        self.__handle = GuardConditionHandle(context.handle, self._rcl_hook)
        self.callback = callback
        self.callback_group = callback_group

    def trigger(self) -> None:
        """Schedule the callback.

        Raises
        ------
        InvalidHandle
            After `destroy`.
        """
        with self.__handle:
            self.__handle.trigger_guard_condition()

    @property
    def handle(self) -> GuardConditionHandle:
        """What is behind the guard condition."""
        return self.__handle

    def destroy(self) -> None:
        """Destroy the handle; use `Node.destroy_guard_condition` instead."""
        self.__handle.destroy_when_not_in_use()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        return (self.callback, ()) if self.callback is not None else None

    def _rcl_has_more(self) -> bool:
        return False
