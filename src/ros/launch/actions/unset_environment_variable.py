"""The action that removes an environment variable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("unset_env")
class UnsetEnvironmentVariable(Action):
    """Removes an environment variable for the processes started later; one that is not set may be removed.

    Parameters
    ----------
    name
        Its name.
    **kwargs
        As for `Action`.
    """

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[UnsetEnvironmentVariable], dict[str, Any]]:
        """Read an element `unset_env`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The environment variable's name."""
        return self.__name

    def execute(self, context: LaunchContext) -> None:
        """Remove the environment variable."""
        context.environment.pop(perform_substitutions(context, self.name), None)
