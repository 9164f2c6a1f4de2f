"""The texts that define message types, from the packages that are installed."""

from __future__ import annotations

from functools import cache

from daidalos.bags.message import Definition
from daidalos.interfaces.library import InterfaceNotFound
from daidalos.interfaces.parser import InterfaceError
from daidalos.interfaces.schema import message_schema
from rosbag2_py._storage import MessageDefinition


class LocalMessageDefinitionSource:
    """Source that finds definitions in the packages that are installed."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type with all that it refers to; an empty, `unknown` one where it is not known."""
        package, _, name = root_topic_type.partition("/")
        found = definition_of(root_topic_type if "/" in name else f"{package}/msg/{name}")
        if found is None:
            return MessageDefinition(root_topic_type, "unknown")
        return MessageDefinition(root_topic_type, found.encoding, found.text)


@cache
def definition_of(type_name: str) -> Definition | None:
    """Return the definition of a type, None where no installed package has it."""
    from rosidl_runtime_py.get_interfaces import interface_library

    try:
        return Definition(message_schema(type_name, interface_library()))
    except (InterfaceNotFound, InterfaceError, ValueError):
        return None
