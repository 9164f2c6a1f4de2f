"""The actions that repeat entities."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.common.documents import DocumentError, parse_yaml

from ..action import Action
from ..frontend.expose import expose_action
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions.for_loop_var import ForEachVar, ForLoopIndex
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import coerce_to_type
from .opaque_function import OpaqueFunction

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext

Entities = list[LaunchDescriptionEntity] | None


@expose_action("for_each")
class ForEach(Action):
    """Action that calls a function for each set of values, and visits the entities that it returns.

    Parameters
    ----------
    input_values
        The sets as YAML mappings with semicolons between them: `{name: 'a', id: 1};{name: 'b', id: 2}`. An
        empty text means no round, `{}` a round without values.
    function
        Called once for each set with the values as keyword arguments; returns entities to visit. In a
        launch file in markup, the elements inside `for_each` are repeated, and `$(for-var name)` is a
        value.
    **kwargs
        As for `Action`.
    """

    SEPARATOR = ";"

    def __init__(
        self, input_values: SomeSubstitutionsType, *, function: Callable[..., Entities], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.__input_values = normalize_to_list_of_substitutions(input_values)
        self.__function = function

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[ForEach], dict[str, Any]]:
        """Read an element `for_each`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["input_values"] = parser.parse_substitution(entity.get_attr("values"))
        kwargs["function"] = _repeat_children(entity, parser, ForEachVar)
        return cls, kwargs

    @property
    def input_values(self) -> list[Substitution]:
        """The sets of values."""
        return self.__input_values

    @property
    def function(self) -> Callable[..., Entities]:
        """What is called for each set."""
        return self.__function

    def describe(self) -> str:
        """Return the action in words."""
        values = " + ".join(sub.describe() for sub in self.input_values)
        return f"{type(self).__name__}({values}, function={self.function})"

    def execute(self, context: LaunchContext) -> Entities:
        """Call the function for each set."""
        return _collect(self.function, self._read_sets(context))

    def _read_sets(self, context: LaunchContext) -> list[dict[str, Any]]:
        text = perform_substitutions(context, self.input_values)
        sets = []
        for document in text.split(self.SEPARATOR) if text.strip() else []:
            try:
                values = parse_yaml(document)
            except DocumentError as error:
                raise ValueError(f"'{document}' is not YAML: {error.described}") from error
            if not isinstance(values, dict):
                raise ValueError(f"'{document}' is not a mapping like {{name: 'a', id: 1}}")
            sets.append(values)
        return sets


@expose_action("for")
class ForLoop(Action):
    """Action that calls a function for each index from 0 up, and visits the entities that it returns.

    Parameters
    ----------
    length
        The number of rounds.
    function
        Called once for each round with the index as keyword argument; returns entities to visit. In a
        launch file in markup, the elements inside `for` are repeated, and `$(index name)` is the index.
    name
        The name of that keyword argument, `i` if not said.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        length: SomeSubstitutionsType,
        *,
        function: Callable[..., Entities],
        name: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__length = normalize_to_list_of_substitutions(length)
        self.__function = function
        self.__name = name or "i"

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[ForLoop], dict[str, Any]]:
        """Read an element `for`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["length"] = parser.parse_substitution(entity.get_attr("len"))
        kwargs["name"] = parser.escape_characters(entity.get_attr("name"))
        kwargs["function"] = _repeat_children(entity, parser, ForLoopIndex)
        return cls, kwargs

    @property
    def length(self) -> list[Substitution]:
        """The number of rounds."""
        return self.__length

    @property
    def name(self) -> str:
        """The name of the index."""
        return self.__name

    @property
    def function(self) -> Callable[..., Entities]:
        """What is called for each round."""
        return self.__function

    def describe(self) -> str:
        """Return the action in words."""
        length = " + ".join(sub.describe() for sub in self.length)
        return f"{type(self).__name__}({length}, name={self.name}, function={self.function})"

    def execute(self, context: LaunchContext) -> Entities:
        """Call the function for each round."""
        length = coerce_to_type(perform_substitutions(context, self.length), int)
        return _collect(self.function, [{self.name: index} for index in range(length)])


def _collect(function: Callable[..., Entities], sets: list[dict[str, Any]]) -> Entities:
    signature = inspect.signature(function)
    entities: list[LaunchDescriptionEntity] = []
    for values in sets:
        try:
            signature.bind(**values)
        except TypeError as error:
            raise ValueError(f"the function of the loop does not take the values {values}: {error}") from error
        entities.extend(function(**values) or [])
    return entities


def _repeat_children(entity: Entity, parser: Parser, variable: type[ForEachVar]) -> Callable[..., Entities]:
    """Return a function that makes the entities of one round from the elements inside a loop."""
    # A process runs only once, so every round gets actions of its own; parsing them now finds mistakes early.
    children = entity.children
    for child in children:
        parser.parse_action(child)

    def make_round(**values: Any) -> Entities:
        variables = {variable.get_local_arg_name(name): value for name, value in values.items()}
        before: dict[str, Any] = {}

        def enter(context: LaunchContext) -> None:
            known = context.get_locals_as_dict()
            before.update({name: known[name] for name in variables if name in known})
            context.extend_locals(variables)

        def leave(context: LaunchContext) -> None:
            for name in variables:
                context._remove_local(name)
            context.extend_locals(before)

        actions = [parser.parse_action(child) for child in children]
        return [OpaqueFunction(function=enter), *actions, OpaqueFunction(function=leave)]

    return make_round
