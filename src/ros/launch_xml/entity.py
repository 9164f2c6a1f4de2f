"""An XML element in the form in which launch shows elements of any markup language."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from copy import deepcopy
from typing import Any

from launch.frontend.entity import Entity as BaseEntity
from launch.frontend.type_utils import check_is_list_entity
from launch.utilities.type_utils import get_typed_value

from ._reader import LocatedElement


class Entity(BaseEntity):
    """An XML element.

    A list is written as text with a separator, which the attribute `<name>-sep` names.

    Parameters
    ----------
    xml_element
        The element.
    parent
        The element around it.
    """

    def __init__(self, xml_element: ET.Element, *, parent: Entity | None = None) -> None:
        self.__element = xml_element
        self.__parent = parent
        self.__read_attributes: set[str] = set()
        self.__read_children: set[str] = set()

    @property
    def type_name(self) -> str:
        """The element's tag."""
        return self.__element.tag

    @property
    def parent(self) -> Entity | None:
        """The element around this one."""
        return self.__parent

    @property
    def location(self) -> tuple[str | None, int | None]:
        """File and line of the element, where they are known."""
        return getattr(self.__element, "location", (None, None))

    @property
    def children(self) -> Sequence[Entity]:
        """The elements inside this one."""
        self.__read_children.update(child.tag for child in self.__element)
        return [Entity(child, parent=self) for child in self.__element]

    def without_children(self, leave_out: Callable[[Entity], bool], ignored: tuple[str, ...]) -> Entity:
        """Return a copy without some of the elements inside, and mark this element as read.

        Parameters
        ----------
        leave_out
            Tells of which elements inside there is none in the copy.
        ignored
            Attributes that the elements inside do not have in the copy.
        """
        copy = LocatedElement(self.type_name, dict(self.__element.attrib))
        copy.location = self.location
        for child, element in zip(self.children, self.__element, strict=True):
            if not leave_out(child):
                kept = deepcopy(element)
                for name in ignored:
                    kept.attrib.pop(name, None)
                copy.append(kept)
        self.__read_attributes.update(self.__element.attrib)
        return Entity(copy, parent=self.__parent)

    def assert_entity_completely_parsed(self) -> None:
        """Check that every attribute and child was read.

        Raises
        ------
        ValueError
            If there are some that nobody asked for.
        """
        attributes = set(self.__element.attrib) - self.__read_attributes
        if attributes:
            raise ValueError(f"Unexpected attribute(s) found in `{self.type_name}`: {_listed(attributes)}")
        children = {child.tag for child in self.__element} - self.__read_children
        if children:
            raise ValueError(f"Unexpected nested entity(ies) found in `{self.type_name}`: {_listed(children)}")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute; see `launch.frontend.Entity.get_attr`."""
        value = self.__find(name, data_type)
        if value is None:
            if optional:
                return None
            kind = "nested entity" if check_is_list_entity(data_type) else "attribute"
            raise AttributeError(f"The {kind} `{name}` is missing in `{self.type_name}`")
        if check_is_list_entity(data_type):
            return value
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except ValueError as error:
            raise TypeError(
                f"The attribute `{name}` of `{self.type_name}` is expected to be of type "
                f"{getattr(data_type, '__name__', data_type)}, but `{value}` cannot be converted to it"
            ) from error

    def __find(self, name: str, data_type: Any) -> Any:
        if check_is_list_entity(data_type):
            found = [Entity(child, parent=self) for child in self.__element if child.tag == name]
            if found:
                self.__read_children.add(name)
            return found or None
        value: Any = self.__element.attrib.get(name)
        if value is None:
            return None
        self.__read_attributes.add(name)
        separator = self.__element.attrib.get(f"{name}-sep")
        if separator is None:
            return value
        self.__read_attributes.add(f"{name}-sep")
        return value.split(separator)


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))
