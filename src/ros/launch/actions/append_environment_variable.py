"""The action that adds to an environment variable."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import (
    NormalizedValueType,
    normalize_typed_substitution,
    perform_typed_substitution,
)
from ._named import NamedValueAction

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("append_env")
class AppendEnvironmentVariable(NamedValueAction):
    """Action that adds a value to an environment variable with a list, such as PATH, for processes started later.

    Parameters
    ----------
    name
        The variable's name; one that is not set yet is set.
    value
        What is added.
    prepend
        Whether it is added at the front.
    separator
        What stands between two values.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.__prepend = normalize_typed_substitution(prepend, bool)
        self.__separator = normalize_to_list_of_substitutions(separator)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[AppendEnvironmentVariable], dict[str, Any]]:
        """Read an element `append_env`."""
        _, kwargs = super().parse(entity, parser)
        prepend = entity.get_attr("prepend", optional=True, data_type=bool, can_be_str=True)
        if prepend is not None:
            kwargs["prepend"] = parser.parse_if_substitutions(prepend)
        separator = entity.get_attr("separator", optional=True)
        if separator is not None:
            kwargs["separator"] = parser.parse_substitution(separator)
        return cls, kwargs

    @property
    def prepend(self) -> NormalizedValueType:
        """Whether it is added at the front."""
        return self.__prepend

    @property
    def separator(self) -> list[Substitution]:
        """What stands between two values."""
        return self.__separator

    def execute(self, context: LaunchContext) -> None:
        """Change the variable."""
        name = perform_substitutions(context, self.name)
        value = perform_substitutions(context, self.value)
        if name in context.environment:
            present = context.environment[name]
            separator = perform_substitutions(context, self.separator)
            prepend = perform_typed_substitution(context, self.prepend, bool)
            value = f"{value}{separator}{present}" if prepend else f"{present}{separator}{value}"
        context.environment[name] = value
