"""Common base of actions that set or remove something by name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from ..action import Action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser


class NamedAction(Action):
    """Action on something that has a name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Self], dict[str, Any]]:
        """Read the action's element."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """Its name."""
        return self.__name


class NamedValueAction(NamedAction):
    """Action that sets the value of something that has a name."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self.__value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Self], dict[str, Any]]:
        """Read the action's element."""
        _, kwargs = super().parse(entity, parser)
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value"))
        return cls, kwargs

    @property
    def value(self) -> list[Substitution]:
        """Its value."""
        return self.__value
