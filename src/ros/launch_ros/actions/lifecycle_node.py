"""The action that runs a ROS node with a life cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.frontend import Entity
from launch.frontend.expose import expose_action
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

from .lifecycle_transition import LifecycleTransition
from .node import Node

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Parser


@expose_action("lifecycle_node")
class LifecycleNode(Node):
    """Action that runs a node whose transitions are events of the launch, and which the launch can ask for transitions.

    Parameters
    ----------
    name
        The node's name.
    namespace
        The node's namespace.
    autostart
        Whether the node is configured and activated at once.
    **kwargs
        As for `Node`.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__autostart = normalize_typed_substitution(autostart, bool)

    @classmethod
    def parse(  # type: ignore[override]  # as in ROS 2, without `ignore`
        cls, entity: Entity, parser: Parser
    ) -> tuple[type[LifecycleNode], dict[str, Any]]:
        """Read an element `lifecycle_node`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs.setdefault("namespace", parser.parse_substitution(""))
        autostart = entity.get_attr("autostart", data_type=bool, optional=True, can_be_str=True)
        if autostart is not None:
            kwargs["autostart"] = parser.parse_if_substitutions(autostart)
        return cls, kwargs

    @property
    def is_lifecycle_node(self) -> bool:
        """Whether the node has a life cycle: yes."""
        return True

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the node and listen to it."""
        from ..utilities.lifecycle_event_manager import LifecycleEventManager

        self._perform_substitutions(context)
        if self.UNSPECIFIED_NODE_NAME in self.node_name:
            raise RuntimeError("node_name unexpectedly incomplete for lifecycle node")
        entities = list(super().execute(context) or [])
        LifecycleEventManager(self).setup_lifecycle_manager(context)
        if perform_typed_substitution(context, self.__autostart, bool):
            entities.append(LifecycleTransition.bringup(self.node_name))
        return entities
