"""Timers of nodes for asyncio."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from rclpy.timer import Timer


class AsyncTimer(Timer):
    """Timer that calls a function, perhaps a coroutine function, periodically; made by `AsyncNode.create_timer`.

    Raises
    ------
    RuntimeError
        For a callback that takes more than one argument; one argument is the `TimerInfo`.
    """

    @property
    def callback(self) -> Callable[..., Any] | None:
        """What is called; with a `TimerInfo` when it takes an argument."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., Any] | None) -> None:
        needed = [
            one
            for one in inspect.signature(value).parameters.values()
            if one.default is one.empty and one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)
        ] if value is not None else []  # fmt: skip
        if len(needed) > 1:
            raise RuntimeError("a timer's callback takes no argument, or one for the TimerInfo")
        self._callback = value
        self._with_info = bool(needed)
