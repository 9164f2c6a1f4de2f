"""The action that removes a launch configuration."""

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


@expose_action("unlet")
class UnsetLaunchConfiguration(Action):
    """Removes a launch configuration; one that is not set may be removed.

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
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[UnsetLaunchConfiguration], dict[str, Any]]:
        """Read an element `unlet`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The launch configuration's name."""
        return self.__name

    def execute(self, context: LaunchContext) -> None:
        """Remove the launch configuration."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)
