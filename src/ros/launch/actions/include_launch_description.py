"""The action that includes a launch file."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.entity import Entity
from ..frontend.expose import expose_action
from ..launch_description import LaunchDescription
from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_description_source import LaunchDescriptionSource
from ..launch_file_error import add_location
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .set_launch_configuration import SetLaunchConfiguration

if TYPE_CHECKING:
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext

_LOCALS = ("current_launch_file_path", "current_launch_file_directory")


@expose_action("include")
class IncludeLaunchDescription(Action):
    """Action that visits what another launch file, or a launch description at hand, describes.

    Parameters
    ----------
    launch_description_source
        The description, or the launch file as a text; a relative path is looked for in the working
        directory and beside the launch file that includes it.
    launch_arguments
        Names and values of its arguments, as pairs.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            from ..launch_description_sources import AnyLaunchDescriptionSource

            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self.__source = launch_description_source
        self.__outer_locals: dict[str, Any] | None = None
        self.__launch_arguments = () if launch_arguments is None else tuple(launch_arguments)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[IncludeLaunchDescription], dict[str, Any]]:
        """Read an element `include`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["launch_description_source"] = parser.parse_substitution(entity.get_attr("file"))
        arguments = []
        for tag in ("arg", "let"):
            for argument in entity.get_attr(tag, data_type=list[Entity], optional=True) or []:
                name = parser.parse_substitution(argument.get_attr("name"))
                arguments.append((name, parser.parse_substitution(argument.get_attr("value"))))
                argument.assert_entity_completely_parsed()
        if arguments:
            kwargs["launch_arguments"] = arguments
        return cls, kwargs

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        """Where the description comes from."""
        return self.__source

    @property
    def launch_arguments(self) -> Sequence[tuple[SomeSubstitutionsType, SomeSubstitutionsType]]:
        """Names and values of its arguments."""
        return self.__launch_arguments

    def describe(self) -> str:
        """Return the action in words."""
        return f"IncludeLaunchDescription({self.__source.location})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description, if it can be had before launching."""
        description = self.__source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Load the description and yield it with its arguments set."""
        description = self.__source.get_launch_description(context)
        location = self.__source.location
        self.__outer_locals = {name: value for name, value in context.get_locals_as_dict().items() if name in _LOCALS}
        path = os.path.abspath(location) if os.path.isfile(location) else location
        context.extend_locals(
            {"current_launch_file_path": path, "current_launch_file_directory": os.path.dirname(path) or path}
        )
        self.__check_arguments(context, description)
        return [
            *(SetLaunchConfiguration(name, value) for name, value in self.launch_arguments),
            description,
        ]

    def _leave(self, context: LaunchContext) -> None:
        """Restore the location of the launch file that includes this one."""
        if self.__outer_locals is None:
            return
        for name in _LOCALS:
            context._remove_local(name)
        context.extend_locals(self.__outer_locals)
        self.__outer_locals = None

    def __check_arguments(self, context: LaunchContext, description: LaunchDescription) -> None:
        passed = [
            perform_substitutions(context, normalize_to_list_of_substitutions(name))
            for name, _ in self.launch_arguments
        ]
        known = {*passed, *self._arguments_around(context)}
        declared = description.get_launch_arguments_with_include_launch_description_actions()
        for argument, includes in declared:
            if argument._conditionally_included or argument.default_value is not None:
                continue
            for include in includes:
                known.update(include._plain_argument_names())
            if argument.name not in known:
                error = RuntimeError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(passed)}]"
                )
                add_location(error, *(argument.origin if self.origin == (None, None) else self.origin))
                raise error

    def _arguments_around(self, context: LaunchContext) -> set[str]:
        """Return the names of arguments that count as passed beside those of the include: none, as in ROS 2."""
        return set()

    def _plain_argument_names(self) -> set[str]:
        """Return the names of the arguments that it passes on, as far as they are known before launching."""
        from ..substitutions import TextSubstitution

        names = [normalize_to_list_of_substitutions(name) for name, _ in self.launch_arguments]
        return {
            "".join(part.text for part in name if isinstance(part, TextSubstitution))
            for name in names
            if all(isinstance(part, TextSubstitution) for part in name)
        }
