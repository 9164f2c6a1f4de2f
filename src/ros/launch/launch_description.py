"""A launch description: the list of entities that a launch file returns."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from .action import Action
    from .actions.declare_launch_argument import DeclareLaunchArgument
    from .actions.include_launch_description import IncludeLaunchDescription
    from .launch_context import LaunchContext


class LaunchDescription(LaunchDescriptionEntity):
    """Entities to visit one after another, and the arguments they declare.

    Parameters
    ----------
    initial_entities
        The entities in order.
    deprecated_reason
        Set it to have a warning with this reason when the description is visited.
    """

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.__entities = [] if initial_entities is None else list(initial_entities)
        self.__deprecated_reason = deprecated_reason

    def describe(self) -> str:
        """Return a short text that distinguishes this description from others."""
        return repr(self)

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Yield the description's entities."""
        if self.deprecated:
            from .logging import get_logger

            file = context.get_locals_as_dict().get("current_launch_file_path")
            subject = f"launch file [{file}]" if file else "launch description"
            reason = f": {self.deprecated_reason}" if self.deprecated_reason else ""
            get_logger("launch").warning(f"The {subject} is deprecated{reason}")
        return self.__entities

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description's entities."""
        return self.__entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """Return the arguments that the description and what it includes declare, each name once.

        Parameters
        ----------
        conditional_inclusion
            Whether the description itself is only visited under a condition.
        """
        found = self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        return [argument for argument, _ in found]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> list[tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]]:
        """Return the declared arguments, each with the include actions that lead to it, outermost first."""
        found: list[tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]] = []
        _collect_arguments(self.entities, conditional_inclusion, [], found)
        return found

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The description's entities."""
        return self.__entities

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Append an entity."""
        self.__entities.append(entity)

    def add_action(self, action: Action) -> None:
        """Append an action."""
        self.add_entity(action)

    @property
    def deprecated(self) -> bool:
        """Whether the description is deprecated."""
        return self.__deprecated_reason is not None

    @property
    def deprecated_reason(self) -> str | None:
        """Why the description is deprecated, or None where it is not."""
        return self.__deprecated_reason


def _collect_arguments(
    entities: Iterable[LaunchDescriptionEntity],
    conditional: bool,
    includes: list[IncludeLaunchDescription],
    found: list[tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]],
) -> None:
    from .actions.declare_launch_argument import DeclareLaunchArgument
    from .actions.include_launch_description import IncludeLaunchDescription
    from .actions.reset_launch_configurations import ResetLaunchConfigurations

    for entity in entities:
        if isinstance(entity, DeclareLaunchArgument):
            if all(entity.name != argument.name for argument, _ in found):
                entity._conditionally_included = conditional or entity.condition is not None
                found.append((entity, includes))
        elif isinstance(entity, ResetLaunchConfigurations):
            # What is declared after this cannot be set from outside.
            return
        inner = [*includes, entity] if isinstance(entity, IncludeLaunchDescription) else includes
        _collect_arguments(entity.describe_sub_entities(), conditional, inner, found)
        for _, sub_entities in entity.describe_conditional_sub_entities():
            _collect_arguments(sub_entities, True, inner, found)
