"""A node with a life cycle that is loaded into a container."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend import Entity
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

from .composable_node import ComposableNode

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Parser


class ComposableLifecycleNode(ComposableNode):
    """Lifecycle node to be loaded into a container.

    Parameters
    ----------
    autostart
        Whether the node is configured and activated at once.
    **kwargs
        As for `ComposableNode`; the node must have a name.
    """

    def __init__(self, *, autostart: bool | SomeSubstitutionsType = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__autostart = normalize_typed_substitution(autostart, bool)

    @classmethod
    def parse(cls, parser: Parser, entity: Entity) -> tuple[type[ComposableLifecycleNode], dict[str, Any]]:
        """Read an element `composable_lifecycle_node`."""
        _, kwargs = super().parse(parser, entity)
        autostart = entity.get_attr("autostart", data_type=bool, optional=True, can_be_str=True)
        if autostart is not None:
            kwargs["autostart"] = parser.parse_if_substitutions(autostart)
        return cls, kwargs

    def autostarts(self, context: LaunchContext) -> bool:
        """Return whether the node is to be configured and activated at once."""
        return bool(perform_typed_substitution(context, self.__autostart, bool))


class LoadedLifecycleNode(Action):
    """Action that configures and activates a node that is being loaded.

    Parameters
    ----------
    node_name
        The node's full name.
    """

    def __init__(self, node_name: str) -> None:
        super().__init__()
        self.node_name = node_name

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Listen to the node, and ask for its first transition."""
        from ..actions.lifecycle_transition import LifecycleTransition
        from ..utilities.lifecycle_event_manager import LifecycleEventManager

        LifecycleEventManager(self).setup_lifecycle_manager(context)
        return [LifecycleTransition.bringup(self.node_name)]
