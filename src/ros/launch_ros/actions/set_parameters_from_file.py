"""The action that sets parameters of nodes from a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend.expose import expose_action
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("set_parameters_from_file")
class SetParametersFromFile(Action):
    """Action that sets parameters from a file for the nodes that follow in the same scope.

    Parameters
    ----------
    filename
        The file.
    **kwargs
        As for `Action`.
    """

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__filename = normalize_to_list_of_substitutions(filename)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[SetParametersFromFile], dict[str, Any]]:
        """Read an element `set_parameters_from_file`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["filename"] = parser.parse_substitution(entity.get_attr("filename"))
        return cls, kwargs

    @property
    def filename(self) -> list[Substitution]:
        """The file."""
        return self.__filename

    def execute(self, context: LaunchContext) -> None:
        """Add the file."""
        filename = perform_substitutions(context, self.filename)
        # A new list, so that the end of the scope brings the present one back.
        present = context.launch_configurations.get("global_params", [])
        context.launch_configurations["global_params"] = [*present, filename]
