"""One entity or several as a flat list."""

from __future__ import annotations

from collections.abc import Iterable

from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType


def normalize_to_list_of_entities(
    entities: SomeEntitiesType | Iterable[SomeEntitiesType],
) -> list[LaunchDescriptionEntity]:
    """Return a flat list of the entities.

    Raises
    ------
    TypeError
        If something among them is not an entity.
    """
    if isinstance(entities, LaunchDescriptionEntity):
        return [entities]
    if isinstance(entities, str) or not isinstance(entities, Iterable):
        raise TypeError(
            f"only launch description entities were expected, but there is {entities!r} of type "
            f"{type(entities).__name__}"
        )
    flat: list[LaunchDescriptionEntity] = []
    for entity in entities:
        flat.extend(normalize_to_list_of_entities(entity))
    return flat
