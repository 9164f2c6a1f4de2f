"""The action that loads nodes into a container."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import launch.logging
from launch import Action
from launch.frontend.expose import expose_action
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..descriptions import ComposableNode
from ..ros_adapters import get_ros_node, run_with_ros_node
from ..utilities.evaluate_parameters import evaluate_parameters
from ..utilities.namespace_utils import make_namespace_absolute, prefix_namespace
from ..utilities.to_parameters_list import to_parameters_list
from ..utilities.track_node_names import add_node_name, get_node_name_count

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser

    from .composable_node_container import ComposableNodeContainer

_TIMEOUT = 1.0


@expose_action("load_composable_node")
class LoadComposableNodes(Action):
    """Action that loads nodes into a container that runs.

    Parameters
    ----------
    composable_node_descriptions
        The nodes.
    target_container
        The container's action, or its full name.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: list[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        from .node import Node

        self.__composable_node_descriptions = list(composable_node_descriptions)
        self.__target_container: Node | list[Substitution] = (
            target_container
            if isinstance(target_container, Node)
            else normalize_to_list_of_substitutions(target_container)
        )
        self.__container_name: str | None = None
        self.__client: Any = None
        self.__loading: asyncio.Future[None] | None = None
        self.__logger = launch.logging.get_logger(__name__)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[LoadComposableNodes], dict[str, Any]]:
        """Read an element `load_composable_node`."""
        from .composable_node_container import parse_composable_nodes

        _, kwargs = super().parse(entity, parser)
        kwargs["target_container"] = parser.parse_substitution(entity.get_attr("target"))
        kwargs["composable_node_descriptions"] = parse_composable_nodes(entity, parser)
        return cls, kwargs

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return a future that is done when the nodes are loaded."""
        return self.__loading

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start loading the nodes."""
        wanted = [
            description
            for description in self.__composable_node_descriptions
            if description.condition is None or description.condition.evaluate(context)
        ]
        if not wanted:
            return None
        import composition_interfaces.srv

        self.__container_name = self.__full_container_name(context)
        self.__client = get_ros_node(context).create_client(
            composition_interfaces.srv.LoadNode, f"{self.__container_name}/_container/load_node"
        )
        # Names, parameters and remappings are those of the present scope.
        requests = [get_composable_node_load_request(description, context) for description in wanted]
        for request in requests:
            if request.node_name:
                name = prefix_namespace(request.node_namespace or "/", request.node_name)
                self.__note_name(context, name)
        autostarted = [
            request for description, request in zip(wanted, requests, strict=True) if description.autostarts(context)
        ]
        self.__loading = run_with_ros_node(context, self.__load, context, requests)
        return [_bringup(request, context) for request in autostarted] or None

    def __note_name(self, context: LaunchContext, name: str) -> None:
        add_node_name(context, name)
        count = get_node_name_count(context, name)
        if count > 1:
            self.__logger.warning(
                f"there are now at least {count} nodes with the name {name} created within this launch context"
            )

    def __full_container_name(self, context: LaunchContext) -> str:
        if isinstance(self.__target_container, list):
            return make_namespace_absolute(perform_substitutions(context, self.__target_container))
        name = self.__target_container.node_name
        if self.__target_container.UNSPECIFIED_NODE_NAMESPACE in name:
            return make_namespace_absolute(name.rpartition("/")[2])
        return name

    def __load(self, context: LaunchContext, requests: list[Any]) -> None:
        """Load one node after another; runs in a thread of its own."""
        while not self.__client.wait_for_service(timeout_sec=_TIMEOUT):
            if context.is_shutdown:
                self.__logger.warning(f"Abandoning wait for the container '{self.__container_name}', due to shutdown.")
                return
        for request in requests:
            response = self.__call(context, request)
            if response is None:
                return
            if response.success:
                if not request.node_name and response.full_node_name:
                    self.__note_name(context, response.full_node_name)
                self.__logger.info(f"Loaded node '{response.full_node_name}' in container '{self.__container_name}'")
            else:
                self.__logger.error(
                    f"Failed to load node '{request.node_name or request.plugin_name}' of type "
                    f"'{request.plugin_name}' in container '{self.__container_name}': {response.error_message}"
                )

    def __call(self, context: LaunchContext, request: Any) -> Any:
        done = threading.Event()
        future = self.__client.call_async(request)
        future.add_done_callback(lambda _: done.set())
        while not done.wait(_TIMEOUT):
            if context.is_shutdown:
                self.__logger.warning(f"Abandoning wait for the container '{self.__container_name}', due to shutdown.")
                future.cancel()
                return None
        if future.exception() is not None:
            raise future.exception()
        return future.result()


def get_composable_node_load_request(composable_node_description: ComposableNode, context: LaunchContext) -> Any:
    """Return the request that loads a node.

    Parameters
    ----------
    composable_node_description
        The node.
    context
        The launch context.
    """
    import composition_interfaces.srv

    description = composable_node_description
    request = composition_interfaces.srv.LoadNode.Request()
    request.package_name = perform_substitutions(context, description.package)
    request.plugin_name = perform_substitutions(context, description.node_plugin)
    if description.node_name is not None:
        request.node_name = perform_substitutions(context, description.node_name)
    own = None if description.node_namespace is None else perform_substitutions(context, description.node_namespace)
    namespace = prefix_namespace(context.launch_configurations.get("ros_namespace"), own)
    if namespace is not None:
        request.node_namespace = make_namespace_absolute(namespace) if namespace else "/"
    request.remap_rules = [f"{source}:={destination}" for source, destination in _remappings(description, context)]
    parameters = [*_global_parameters(context), *evaluate_parameters(context, description.parameters or [])]
    request.parameters = to_parameters_list(context, request.node_name, request.node_namespace, parameters)
    if description.extra_arguments is not None:
        extra = evaluate_parameters(context, description.extra_arguments)
        request.extra_arguments = to_parameters_list(context, request.node_name, request.node_namespace, extra)
    return request


def _remappings(description: ComposableNode, context: LaunchContext) -> list[tuple[str, str]]:
    own = [
        (perform_substitutions(context, source), perform_substitutions(context, destination))
        for source, destination in description.remappings or []
    ]
    return [*context.launch_configurations.get("ros_remaps", []), *own]


def _global_parameters(context: LaunchContext) -> list[Any]:
    entries: list[Any] = context.launch_configurations.get("global_params", [])
    return [dict([entry]) if isinstance(entry, tuple) else Path(entry).absolute() for entry in entries]


def _bringup(request: Any, context: LaunchContext) -> Action:
    from ..descriptions.composable_lifecycle_node import LoadedLifecycleNode

    return LoadedLifecycleNode(prefix_namespace(request.node_namespace or "/", request.node_name))
