"""`component_container`: nodes in one process, loaded and unloaded by services."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.extensions import ExtensionError
from daidalos.nodes.extensions import find_component
from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.runner import run


class ComponentContainer(Node):
    """Loads nodes; each is spun in a thread of its own, so that none holds up another.

    A node whose class has an attribute ``THREADS`` above 1 gets an executor with so many.
    """

    def __init__(self, name: str = "ComponentManager", **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode

        self._loaded: dict[int, tuple[Node, NodeThread]] = {}
        self._next_id = 1
        self.create_service(LoadNode, "~/_container/load_node", self._on_load)
        self.create_service(UnloadNode, "~/_container/unload_node", self._on_unload)
        self.create_service(ListNodes, "~/_container/list_nodes", self._on_list)

    def _on_load(self, request: Any, response: Any) -> Any:
        try:
            kind = find_component(request.package_name, request.plugin_name)
            node = kind(**_arguments(request, self.context))
        except ExtensionError as error:
            return self._refused(response, str(error))
        except Exception as error:  # whatever a component's constructor raises is told to the caller
            return self._refused(response, f"Component constructor threw an exception: {error}")
        if request.log_level:
            node.get_logger().set_level(request.log_level)
        self._loaded[self._next_id] = (node, NodeThread(node, getattr(kind, "THREADS", 1)))
        response.unique_id = self._next_id
        self._next_id += 1
        response.full_node_name = node.get_fully_qualified_name()
        response.success = True
        self.get_logger().info(f"Loaded {request.plugin_name} as {response.full_node_name}")
        return response

    def _refused(self, response: Any, reason: str) -> Any:
        response.success = False
        response.error_message = reason
        self.get_logger().error(reason)
        return response

    def _on_unload(self, request: Any, response: Any) -> Any:
        entry = self._loaded.pop(request.unique_id, None)
        response.success = entry is not None
        if entry is None:
            response.error_message = f"No node found with unique_id: {request.unique_id}"
            return response
        node, thread = entry
        thread.stop()
        node.destroy_node()
        return response

    def _on_list(self, request: Any, response: Any) -> Any:
        response.unique_ids = list(self._loaded)
        response.full_node_names = [node.get_fully_qualified_name() for node, _ in self._loaded.values()]
        return response

    def destroy_node(self) -> None:
        """Unload every node and leave the graph."""
        for node, thread in reversed(list(self._loaded.values())):
            thread.stop()
            node.destroy_node()
        self._loaded.clear()
        super().destroy_node()


def _arguments(request: Any, context: Any) -> dict[str, Any]:
    """Return the constructor's arguments for a load request."""
    arguments = [f"__node:={request.node_name}"] if request.node_name else []
    arguments += [f"__ns:={request.node_namespace}"] if request.node_namespace else []
    arguments += request.remap_rules
    return {
        "context": context,
        "cli_args": [word for rule in arguments for word in ("-r", rule)],
        "parameter_overrides": [Parameter.from_parameter_msg(message) for message in request.parameters],
        "use_global_arguments": False,
    }


def main() -> int:
    """Run the node."""
    return run(ComponentContainer)
