"""The reaction to a process that was started."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..events.process.process_started import ProcessStarted
from ..some_entities_type import SomeEntitiesType
from .on_action_event_base import OnActionEventBase

if TYPE_CHECKING:
    from ..actions.execute_process import ExecuteProcess
    from ..launch_context import LaunchContext


class OnProcessStart(OnActionEventBase):
    """Event handler that reacts when a process was started.

    Parameters
    ----------
    target_action
        The action that runs the process, a function that picks some, or None for all.
    on_start
        The entities to visit, or a function that takes the event and the context and returns them.
    **kwargs
        As for `BaseEventHandler`.
    """

    def __init__(
        self,
        *,
        target_action: Callable[[ExecuteProcess], bool] | ExecuteProcess | None = None,
        on_start: SomeEntitiesType | Callable[[ProcessStarted, LaunchContext], SomeEntitiesType | None],
        **kwargs: Any,
    ) -> None:
        from ..actions.execute_process import ExecuteProcess

        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteProcess,
            **kwargs,
        )
