"""Launches that verbs of `daidalos` run in the foreground."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch import LaunchContext, LaunchDescriptionEntity
    from launch.event import Event

INTERRUPTED = 130
"""Exit status after Ctrl-C, as a shell has it of a program that the signal ended."""


def run_launch(*entities: LaunchDescriptionEntity) -> int:
    """Run a launch to its end; return its exit status, or `INTERRUPTED` where Ctrl-C ended it."""
    from launch import LaunchDescription, LaunchService
    from launch.actions import RegisterEventHandler
    from launch.event_handlers import OnShutdown
    from launch.events import Shutdown

    from daidalos.distribution import complete_environment

    complete_environment()
    interrupted = False

    def note(event: Event, context: LaunchContext) -> None:
        nonlocal interrupted
        interrupted = interrupted or (isinstance(event, Shutdown) and event.due_to_sigint)

    service = LaunchService()
    watch = RegisterEventHandler(OnShutdown(on_shutdown=note))
    service.include_launch_description(LaunchDescription([watch, *entities]))
    status = service.run()
    return INTERRUPTED if interrupted else status
