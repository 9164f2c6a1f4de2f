"""The action that removes the launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.entity import Entity
from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """Action that removes all launch configurations but some.

    Parameters
    ----------
    launch_configurations
        Names and values of those that are there afterwards; the values may be taken from those of before.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__launch_configurations = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[ResetLaunchConfigurations], dict[str, Any]]:
        """Read an element `reset`."""
        _, kwargs = super().parse(entity, parser)
        keeps = entity.get_attr("keep", data_type=list[Entity], optional=True)
        kwargs["launch_configurations"] = parse_keeps(keeps or [], parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Remove the configurations."""
        kept = {
            perform_substitutions(context, name): perform_substitutions(context, value)
            for name, value in self.__launch_configurations
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


def parse_keeps(keeps: list[Entity], parser: Parser) -> dict[Any, Any]:
    """Read the elements `keep`, each with a name and a value."""
    parsed: dict[Any, Any] = {}
    for keep in keeps:
        name = tuple(parser.parse_substitution(keep.get_attr("name")))
        parsed[name] = parser.parse_substitution(keep.get_attr("value"))
        keep.assert_entity_completely_parsed()
    return parsed
