"""The form in which every markup language shows a launch file to the actions that read it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class Entity:
    """One element of a launch file: its type's name, attributes and children."""

    @property
    def type_name(self) -> str:
        """The name of the element's type."""
        raise NotImplementedError

    @property
    def parent(self) -> Entity | None:
        """The element around this one."""
        raise NotImplementedError

    @property
    def children(self) -> Sequence[Entity]:
        """The elements inside this one."""
        raise NotImplementedError

    @property
    def location(self) -> tuple[str | None, int | None]:
        """File and line of the element, where they are known."""
        return None, None

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute.

        Parameters
        ----------
        name
            The attribute's name.
        data_type
            `int`, `float`, `bool`, `str`, a list of one of these, a list of `Entity` for elements inside
            this one that have this name, or None for whatever it looks like.
        optional
            Return None instead of failing where there is no such attribute.
        can_be_str
            Accept any string, too, because it may hold substitutions.

        Raises
        ------
        AttributeError
            If there is no such attribute and it is not optional.
        TypeError
            If it is of another type.
        """
        raise NotImplementedError

    def assert_entity_completely_parsed(self) -> None:
        """Check that every attribute and child was read.

        Raises
        ------
        ValueError
            If there are some that nobody asked for.
        """
        raise NotImplementedError
