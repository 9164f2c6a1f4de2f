"""The reaction to what goes into and comes out of a process."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..events.process.process_io import ProcessIO
from ..some_entities_type import SomeEntitiesType
from .on_action_event_base import OnActionEventBase

if TYPE_CHECKING:
    from ..actions.execute_local import ExecuteLocal
    from ..launch_context import LaunchContext

IOCallback = Callable[[ProcessIO], SomeEntitiesType | None]


class OnProcessIO(OnActionEventBase):
    """Event handler that reacts to input and output of a process.

    Parameters
    ----------
    target_action
        The action that runs the process, a function that picks some, or None for all.
    on_stdin, on_stdout, on_stderr
        A function for each stream that takes the event and returns the entities to visit.
    **kwargs
        As for `BaseEventHandler`.
    """

    def __init__(
        self,
        *,
        target_action: Callable[[ExecuteLocal], bool] | ExecuteLocal | None = None,
        on_stdin: IOCallback | None = None,
        on_stdout: IOCallback | None = None,
        on_stderr: IOCallback | None = None,
        **kwargs: Any,
    ) -> None:
        from ..actions.execute_local import ExecuteLocal

        def on_io(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            not_stdout = on_stderr if event.from_stderr else on_stdin
            callback = on_stdout if event.from_stdout else not_stdout
            return None if callback is None else callback(event)

        super().__init__(
            action_matcher=target_action,
            on_event=on_io,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )
