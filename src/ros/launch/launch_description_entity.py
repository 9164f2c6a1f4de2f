"""The base of everything that a launch description may contain."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from asyncio import Future

    from .launch_context import LaunchContext


class LaunchDescriptionEntity:
    """Base of everything that the launch service visits: actions and launch descriptions."""

    def describe(self) -> str:
        """Return a short text that distinguishes this entity from others."""
        raise NotImplementedError(f"{type(self).__name__} does not describe itself")

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that visiting this one always yields."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that visiting this one may yield, each group with the condition in words."""
        return []

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the entity and return the entities to visit next, or None."""
        return None

    def _leave(self, context: LaunchContext) -> None:
        """Undo, after the last entity that visiting this one yielded, what was only meant for those."""

    def get_asyncio_future(self) -> Future[None] | None:
        """Return a future that is done when the entity's work is, or None where nothing goes on."""
        return None
