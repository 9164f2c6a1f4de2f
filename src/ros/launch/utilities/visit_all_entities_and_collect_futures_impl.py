"""The walk through a tree of entities."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_file_error import add_location

if TYPE_CHECKING:
    import asyncio

    from ..launch_context import LaunchContext


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[None]]]:
    """Visit an entity and, depth first, all that it yields; return those that go on with their futures."""
    pairs: list[tuple[LaunchDescriptionEntity, asyncio.Future[None]]] = []
    try:
        sub_entities = entity.visit(context) or []
        own_future = entity.get_asyncio_future()
        if own_future is not None:
            pairs.append((entity, own_future))
        for sub_entity in sub_entities:
            pairs.extend(visit_all_entities_and_collect_futures(sub_entity, context))
        entity._leave(context)
    except Exception as error:
        add_location(error, *getattr(entity, "origin", (None, None)))
        # What has begun has to be waited for, although nobody gets the pairs now.
        for _, future in pairs:
            context.add_completion_future(future)
        raise
    return pairs
