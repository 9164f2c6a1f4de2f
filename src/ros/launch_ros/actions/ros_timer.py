"""The action that waits by ROS's clock and then executes others."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from launch.actions import TimerAction
from launch.events import TimerEvent
from launch.frontend.expose import expose_action

from ..ros_adapters import get_ros_node

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("ros_timer")
class ROSTimer(TimerAction):
    """Action that executes actions after a time that ROS's clock measures, which may be simulated.

    Parameters
    ----------
    period
        The time in seconds.
    actions
        The actions.
    **kwargs
        As for `launch.actions.TimerAction`.
    """

    def __init__(self, *, period: Any, actions: Any, **kwargs: Any) -> None:
        super().__init__(period=period, actions=actions, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[ROSTimer], dict[str, Any]]:
        """Read an element `ros_timer`."""
        _, kwargs = super().parse(entity, parser)
        return cls, kwargs

    def describe(self) -> str:
        """Return the action in words."""
        return f"ROSTimer(period={self.period}, actions=<actions>)"

    async def _wait_to_fire_event(
        self, context: LaunchContext, period: float, completed: asyncio.Future[None], canceled: asyncio.Future[bool]
    ) -> None:
        loop = context.running_loop
        elapsed: asyncio.Future[bool] = loop.create_future()

        def elapse() -> None:
            if not elapsed.done():
                elapsed.set_result(True)

        def on_timer() -> None:
            timer.cancel()
            loop.call_soon_threadsafe(elapse)

        timer = get_ros_node(context).create_timer(period, on_timer)
        try:
            await asyncio.wait([canceled, elapsed], return_when=asyncio.FIRST_COMPLETED)
            if not canceled.done():
                await context.emit_event(TimerEvent(timer_action=self))
            # With the launch the node ends, and the timer with it.
            if not context.is_shutdown:
                timer.cancel()
        finally:
            completed.set_result(None)


RosTimer = ROSTimer
