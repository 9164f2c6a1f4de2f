"""The action that remaps a name for nodes."""

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


@expose_action("set_remap")
class SetRemap(Action):
    """Action that remaps a name for the nodes that follow in the same scope.

    Parameters
    ----------
    src
        The name.
    dst
        What it becomes.
    **kwargs
        As for `Action`.
    """

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__src = normalize_to_list_of_substitutions(src)
        self.__dst = normalize_to_list_of_substitutions(dst)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[SetRemap], dict[str, Any]]:
        """Read an element `set_remap`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["src"] = parser.parse_substitution(entity.get_attr("from"))
        kwargs["dst"] = parser.parse_substitution(entity.get_attr("to"))
        return cls, kwargs

    @property
    def src(self) -> list[Substitution]:
        """The name."""
        return self.__src

    @property
    def dst(self) -> list[Substitution]:
        """What it becomes."""
        return self.__dst

    def execute(self, context: LaunchContext) -> None:
        """Add the remapping."""
        rule = (perform_substitutions(context, self.src), perform_substitutions(context, self.dst))
        # A new list, so that the end of the scope brings the present one back.
        present = context.launch_configurations.get("ros_remaps", [])
        context.launch_configurations["ros_remaps"] = [*present, rule]
