"""An action that keeps a launch out of the graphs of others."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING

from launch import Action
from launch.event_handlers import OnShutdown

if TYPE_CHECKING:
    from launch import LaunchContext

_VARIABLE = "ROS_DOMAIN_ID"


class EnableRmwIsolation(Action):
    """Action that sets a ROS domain of its own for this process and what is launched afterwards.

    The domain is free again when the launch is shut down, and the environment as it was.
    """

    def execute(self, context: LaunchContext) -> None:
        """Choose the domain."""
        from domain_coordinator import domain_id

        kept = ExitStack()
        domain = kept.enter_context(domain_id())
        before = context.environment.get(_VARIABLE)
        context.environment[_VARIABLE] = str(domain)

        def restore(event: object, launch_context: LaunchContext) -> None:
            if before is None:
                launch_context.environment.pop(_VARIABLE, None)
            else:
                launch_context.environment[_VARIABLE] = before
            kept.close()

        context.register_event_handler(OnShutdown(on_shutdown=restore))
