"""The reaction to the end of a launch."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from ..event import Event
from ..event_handler import BaseEventHandler
from ..events.shutdown import Shutdown
from ..some_entities_type import SomeEntitiesType
from ..utilities import is_a_subclass

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class OnShutdown(BaseEventHandler):
    """Event handler that reacts when the launch is to stop.

    Parameters
    ----------
    on_shutdown
        The entities to visit, or a function that takes the event and the context and returns them.
    **kwargs
        As for `BaseEventHandler`.
    """

    def __init__(
        self,
        *,
        on_shutdown: SomeEntitiesType | Callable[[Shutdown, LaunchContext], SomeEntitiesType | None],
        **kwargs: Any,
    ) -> None:
        super().__init__(matcher=lambda event: is_a_subclass(event, Shutdown), **kwargs)
        if callable(on_shutdown):
            self.__on_shutdown = on_shutdown
        else:
            self.__on_shutdown = lambda event, context: on_shutdown

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or yield the entities."""
        super().handle(event, context)
        return self.__on_shutdown(cast("Shutdown", event), context)

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return f"{self.__on_shutdown}"

    @property
    def matcher_description(self) -> str:
        """Which events the handler is for, in words."""
        return "event issubclass of launch.events.Shutdown"
