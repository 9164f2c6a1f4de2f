"""Launches that verbs of `daidalos` run in the foreground."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch import LaunchDescriptionEntity

INTERRUPTED = 130
"""Exit status after Ctrl-C, as a shell has it of a program that the signal ended."""


def run_launch(*entities: LaunchDescriptionEntity) -> int:
    """Run a launch to its end; return its exit status, or `INTERRUPTED` where Ctrl-C ended it."""
    from launch import LaunchDescription, LaunchService

    from daidalos.distribution import complete_environment

    complete_environment()
    service = LaunchService()
    service.include_launch_description(LaunchDescription(entities))
    status = service.run()
    # Ctrl-C of a terminal reaches the processes as well. Where the first of them to end ends the launch before the
    # launch's own turn comes, that was Ctrl-C all the same.
    return INTERRUPTED if service.was_interrupted else status
