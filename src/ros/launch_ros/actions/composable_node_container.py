"""The action that runs a process into which nodes are loaded."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.frontend import Entity
from launch.frontend.expose import expose_action
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType

from ..descriptions import ComposableNode
from .load_composable_nodes import LoadComposableNodes
from .node import Node

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Parser


@expose_action("node_container")
class ComposableNodeContainer(Node):
    """Action that runs a container, and loads nodes into it.

    Parameters
    ----------
    name
        The container's name.
    namespace
        The container's namespace.
    composable_node_descriptions
        The nodes.
    **kwargs
        As for `Node`.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        composable_node_descriptions: list[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__composable_node_descriptions = composable_node_descriptions

    @classmethod
    def parse(  # type: ignore[override]  # as in ROS 2, without `ignore`
        cls, entity: Entity, parser: Parser
    ) -> tuple[type[ComposableNodeContainer], dict[str, Any]]:
        """Read an element `node_container`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs.setdefault("namespace", parser.parse_substitution(""))
        kwargs["composable_node_descriptions"] = parse_composable_nodes(entity, parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the container, and have the nodes loaded."""
        entities = list(super().execute(context) or [])
        # Which nodes are loaded is decided now, by the conditions in the present scope.
        wanted = [
            description
            for description in self.__composable_node_descriptions or []
            if description.condition is None or description.condition.evaluate(context)
        ]
        if wanted:
            entities.append(LoadComposableNodes(composable_node_descriptions=wanted, target_container=self))
        return entities


def parse_composable_nodes(entity: Entity, parser: Parser) -> list[ComposableNode]:
    """Read the elements for nodes that are loaded."""
    from ..descriptions import ComposableLifecycleNode

    descriptions: list[ComposableNode] = []
    for tag, cls in (("composable_node", ComposableNode), ("composable_lifecycle_node", ComposableLifecycleNode)):
        for child in entity.get_attr(tag, data_type=list[Entity], optional=True) or []:
            description_class, kwargs = cls.parse(parser, child)
            child.assert_entity_completely_parsed()
            descriptions.append(description_class(**kwargs))
    return descriptions
