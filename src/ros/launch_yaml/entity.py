"""A YAML mapping or list in the form in which launch shows elements of any markup language."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from launch.frontend.entity import Entity as BaseEntity
from launch.frontend.type_utils import check_is_list_entity
from launch.utilities.type_utils import is_instance_of


class Entity(BaseEntity):
    """A YAML mapping, whose keys are attributes, or a list, whose items are the elements inside.

    Parameters
    ----------
    element
        The mapping or list.
    type_name
        The name of the element's type.
    parent
        The element around it.
    """

    def __init__(self, element: Any, type_name: str | None = None, *, parent: Entity | None = None) -> None:
        self.__element = element
        self.__type_name = type_name
        self.__parent = parent
        self.__read_keys: set[str] = set()
        self.__children_read = False

    @property
    def type_name(self) -> str:
        """The name of the element's type; empty where it was not given."""
        return self.__type_name or ""

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
        """The elements inside this one: the items of a list, or of a mapping's key `children`."""
        self.__children_read = True
        if isinstance(self.__element, dict):
            if "children" not in self.__element:
                raise ValueError(f"Expected entity `{self.type_name}` to have children entities.")
            self.__read_keys.add("children")
            items = self.__element["children"]
        else:
            items = self.__element
        if not isinstance(items, list):
            raise TypeError(f"Expected the children of `{self.type_name}` to be a list, got `{items}`")
        return [self.__child(item) for item in items]

    def __child(self, item: Any) -> Entity:
        if not isinstance(item, dict) or len(item) != 1 or not isinstance(next(iter(item)), str):
            raise RuntimeError(
                "Subentities must be a dictionary with only one key, which is the entity type; "
                f"got `{item}` in `{self.type_name}`"
            )
        type_name, element = next(iter(item.items()))
        child = Entity(element, type_name, parent=self)
        return child if child.location != (None, None) else _LocatedEntity(element, type_name, self, item)

    def assert_entity_completely_parsed(self) -> None:
        """Check that every attribute and child was read.

        Raises
        ------
        ValueError
            If there are some that nobody asked for.
        """
        if isinstance(self.__element, list):
            if not self.__children_read:
                raise ValueError(f"Unexpected nested entity(ies) found in `{self.type_name}`: {self.__element}")
            return
        if not isinstance(self.__element, dict):
            raise ValueError(f"Expected `{self.type_name}` to be a mapping or a list, got `{self.__element}`")
        unread = set(self.__element) - self.__read_keys
        if unread:
            listed = ", ".join(sorted(str(key) for key in unread))
            raise ValueError(f"Unexpected key(s) found in `{self.type_name}`: {listed}")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute; see `launch.frontend.Entity.get_attr`."""
        if not isinstance(self.__element, dict) or name not in self.__element:
            if optional:
                return None
            raise AttributeError(f"The attribute `{name}` is missing in `{self.type_name}`")
        self.__read_keys.add(name)
        data = self.__element[name]
        if check_is_list_entity(data_type):
            if isinstance(data, list) and all(isinstance(item, dict) for item in data):
                return [Entity(item, name, parent=self) for item in data]
            raise TypeError(
                f"The attribute `{name}` of `{self.type_name}` is expected to be a list of mappings, got `{data}`"
            )
        if data_type is float and isinstance(data, int) and not isinstance(data, bool):
            return float(data)
        if not is_instance_of(data, data_type, can_be_str=can_be_str):
            raise TypeError(
                f"The attribute `{name}` of `{self.type_name}` is expected to be of type "
                f"{getattr(data_type, '__name__', data_type)}, got `{data}`"
            )
        return data


class _LocatedEntity(Entity):
    """An element whose value has no place of its own, such as a plain number; it is where its key is."""

    def __init__(self, element: Any, type_name: str, parent: Entity, item: Any) -> None:
        super().__init__(element, type_name, parent=parent)
        self.__item = item

    @property
    def location(self) -> tuple[str | None, int | None]:
        """File and line of the element, where they are known."""
        return getattr(self.__item, "location", (None, None))
