"""The texts that define message types, from the packages that are installed."""

from __future__ import annotations

from functools import cache

from daidalos.bags.message import Definition
from daidalos.interfaces.library import InterfaceNotFound
from daidalos.interfaces.parser import InterfaceError
from daidalos.interfaces.schema import bag_schema
from rosbag2_py._storage import MessageDefinition


class LocalMessageDefinitionSource:
    """Source that finds definitions in the packages that are installed."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type with all that it refers to; an empty, `unknown` one where it is not known."""
        found = _definition(root_topic_type)
        if found is None:
            return MessageDefinition(root_topic_type, "unknown")
        return MessageDefinition(root_topic_type, found.encoding, found.text)


def definition_of(type_name: str) -> Definition | None:
    """Return what a bag holds as the definition of a topic's type; that of the service for the type of its events.

    It is None where no installed package has the type.
    """
    is_event = "/srv/" in type_name and type_name.endswith("_Event")
    return _definition(type_name.removesuffix("_Event") if is_event else type_name)


@cache
def _definition(type_name: str) -> Definition | None:
    from rosidl_runtime_py.get_interfaces import interface_library

    try:
        return Definition(*bag_schema(type_name, interface_library()))
    except (InterfaceNotFound, InterfaceError, ValueError):
        return None
