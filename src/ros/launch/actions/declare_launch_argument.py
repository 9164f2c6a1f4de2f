"""The action that declares an argument of a launch file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.entity import Entity
from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """Action that declares an argument, which becomes a launch configuration of the same name.

    Parameters
    ----------
    name
        The argument's name.
    default_value
        Its value where none is passed. An argument without one must be passed.
    description
        What it is for.
    choices
        The values that it may have, any if not said.
    **kwargs
        As for `Action`.

    Raises
    ------
    RuntimeError
        If there are no choices in `choices`, or if the default is not one of them.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__name = name
        self.__choices = None if choices is None else list(choices)
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.__check_choices(default_value)
        self.__description = "no description given" if description is None else description
        if self.__choices is not None:
            ending = "" if self.__description.endswith(".") else "."
            self.__description += f"{ending} Valid choices are: {self.__choices}"
        # Found out by LaunchDescription.get_launch_arguments().
        self._conditionally_included = False

    def __check_choices(self, default_value: SomeSubstitutionsType | None) -> None:
        if self.__choices is None:
            return
        if not self.__choices:
            raise RuntimeError(f"the choices for the launch argument '{self.__name}' are empty")
        if isinstance(default_value, str) and default_value not in self.__choices:
            raise RuntimeError(
                f"the default value '{default_value}' of the launch argument '{self.__name}' is "
                f"not in provided choices: {self.__choices}"
            )

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[DeclareLaunchArgument], dict[str, Any]]:
        """Read an element `arg`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.escape_characters(entity.get_attr("name"))
        default = entity.get_attr("default", optional=True)
        if default is not None:
            kwargs["default_value"] = parser.parse_substitution(default)
        description = entity.get_attr("description", optional=True)
        if description is not None:
            kwargs["description"] = parser.escape_characters(description)
        choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
        if choices is not None:
            kwargs["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
            for choice in choices:
                choice.assert_entity_completely_parsed()
        return cls, kwargs

    @property
    def name(self) -> str:
        """The argument's name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The argument's value where none is passed."""
        return self.__default_value

    @property
    def description(self) -> str:
        """What the argument is for."""
        return self.__description

    @property
    def choices(self) -> list[str] | None:
        """The values that the argument may have."""
        return self.__choices

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration to the default if nothing was passed, and check its value."""
        configurations = context.launch_configurations
        if self.name not in configurations:
            if self.default_value is None:
                raise RuntimeError(
                    f"Required launch argument '{self.name}' (description: '{self.description}') was not provided"
                )
            configurations[self.name] = perform_substitutions(context, self.default_value)
        value = configurations[self.name]
        if self.choices is not None and value not in self.choices:
            raise RuntimeError(
                f"Argument '{self.name}' provided value '{value}' is not valid. Valid options are: {self.choices}"
            )
