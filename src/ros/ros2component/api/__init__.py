"""Component containers, their components, and the component types of packages."""

from __future__ import annotations

import subprocess
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from ament_index_python import get_resource, get_resources, has_resource
from ros2cli.services import call

COMPONENTS_RESOURCE_TYPE = "rclcpp_components"
"""Type of the resources by which packages register component types."""

_CONTAINER_SERVICES = {
    "load_node": "composition_interfaces/srv/LoadNode",
    "unload_node": "composition_interfaces/srv/UnloadNode",
    "list_nodes": "composition_interfaces/srv/ListNodes",
}


class ComponentInfo(NamedTuple):
    """Component in a container: its number and its full node name."""

    uid: int
    name: str


def get_package_names_with_component_types() -> list[str]:
    """Return the packages that have registered component types."""
    return list(get_resources(COMPONENTS_RESOURCE_TYPE))


def get_package_component_types(*, package_name: str) -> list[str]:
    """Return the component types that a package has registered."""
    if not has_resource(COMPONENTS_RESOURCE_TYPE, package_name):
        return []
    content, _ = get_resource(COMPONENTS_RESOURCE_TYPE, package_name)
    return [line.split(";")[0] for line in content.splitlines()]


def get_registered_component_types() -> list[tuple[str, list[str]]]:
    """Return every package that has registered component types, with these."""
    return [(name, get_package_component_types(package_name=name)) for name in get_package_names_with_component_types()]


def get_components_in_container(*, node: Any, remote_container_node_name: str) -> tuple[bool, Any]:
    """Return (True, the components in a container as `ComponentInfo`) or (False, why they are not known)."""
    from composition_interfaces.srv import ListNodes

    service = f"{remote_container_node_name}/_container/list_nodes"
    try:
        response = call(node, ListNodes, service, ListNodes.Request())
    except RuntimeError as error:
        return False, str(error)
    found = zip(response.unique_ids, response.full_node_names, strict=True)
    return True, [ComponentInfo(uid, name) for uid, name in found]


def get_components_in_containers(
    *, node: Any, remote_containers_node_names: Iterable[str]
) -> dict[str, tuple[bool, Any]]:
    """Return what `get_components_in_container` returns for each of some containers."""
    return {
        name: get_components_in_container(node=node, remote_container_node_name=name)
        for name in remote_containers_node_names
    }


def load_component_into_container(
    *,
    node: Any,
    remote_container_node_name: str,
    package_name: str,
    plugin_name: str,
    node_name: str | None = None,
    node_namespace: str | None = None,
    log_level: int | None = None,
    remap_rules: Sequence[str] | None = None,
    parameters: Iterable[str] | None = None,
    extra_arguments: Iterable[str] | None = None,
) -> tuple[int, str]:
    """Load a component into a container; return its number and full node name.

    Parameters
    ----------
    node
        The rclpy node that asks.
    remote_container_node_name
        The container.
    package_name, plugin_name
        The component's package and type.
    node_name, node_namespace, log_level
        Of the component's node; its own where None.
    remap_rules
        In the form ``from:=to``.
    parameters, extra_arguments
        Parameters of the component and arguments of the container, in the form ``name:=value``.

    Raises
    ------
    RuntimeError
        When the container does not exist, does not answer or refuses.
    """
    from composition_interfaces.srv import LoadNode

    request = LoadNode.Request(
        package_name=package_name,
        plugin_name=plugin_name,
        node_name=node_name or "",
        node_namespace=node_namespace or "",
        log_level=log_level or 0,
        remap_rules=list(remap_rules or ()),
        parameters=[_parameter(text) for text in parameters or ()],
        extra_arguments=[_parameter(text) for text in extra_arguments or ()],
    )
    # A component's imports may have to be compiled first.
    response = call(node, LoadNode, f"{remote_container_node_name}/_container/load_node", request, answer_s=120.0)
    if not response.success:
        raise RuntimeError(f"Failed to load component: {response.error_message}")
    return response.unique_id, response.full_node_name


def _parameter(text: str) -> Any:
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    name, _, value = text.partition(":=")
    return Parameter(name=name, value=get_parameter_value(value))


def unload_component_from_container(
    *, node: Any, remote_container_node_name: str, component_uids: Iterable[int]
) -> Iterator[tuple[int, bool, str]]:
    """Unload components from a container one by one; yield (number, whether it failed, why) of each.

    Raises
    ------
    RuntimeError
        When the container does not exist or does not answer.
    """
    from composition_interfaces.srv import UnloadNode

    service = f"{remote_container_node_name}/_container/unload_node"
    for uid in component_uids:
        response = call(node, UnloadNode, service, UnloadNode.Request(unique_id=uid))
        yield uid, not response.success, response.error_message


def find_container_node_names(*, node: Any, node_names: Iterable[Any]) -> list[Any]:
    """Return those of some nodes that are containers.

    Parameters
    ----------
    node
        Who asks.
    node_names
        What `ros2node.api.get_node_names` returned.
    """
    services = dict(node.get_service_names_and_types())
    return [
        one
        for one in node_names
        if all(
            kind in services.get(f"{one.full_name}/_container/{name}", ()) for name, kind in _CONTAINER_SERVICES.items()
        )
    ]


def package_with_components_name_completer(prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
    """Return the packages that an argument may be."""
    return get_package_names_with_component_types()


def container_node_name_completer(prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
    """Return the containers that an argument may be."""
    from ros2cli.node.strategy import NodeStrategy
    from ros2node.api import get_node_names

    with NodeStrategy(parsed_args) as node:
        return [one.full_name for one in find_container_node_names(node=node, node_names=get_node_names(node=node))]


class ComponentTypeNameCompleter:
    """Completer of the component types of the package that another argument names.

    Parameters
    ----------
    package_name_key
        The other argument.
    """

    def __init__(self, *, package_name_key: str) -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        return get_package_component_types(package_name=getattr(parsed_args, self.package_name_key))


def add_component_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of a component and its node."""
    package = parser.add_argument("package_name", help="Name of the package where the component is to be found")
    package.completer = package_with_components_name_completer  # type: ignore[attr-defined]  # argcomplete's
    plugin = parser.add_argument("plugin_name", help="Type name of the component to be loaded")
    plugin.completer = ComponentTypeNameCompleter(package_name_key="package_name")  # type: ignore[attr-defined]
    parser.add_argument("-n", "--node-name", help="Component node name")
    parser.add_argument("--node-namespace", help="Component node namespace")
    parser.add_argument("--log-level", help="Component node log level")
    repeated = (
        ("-r", "--remap-rule", "remap_rules", "Component node remapping rules, in the 'from:=to' form"),
        ("-p", "--parameter", "parameters", "Component node parameters, in the 'name:=value' form"),
        ("-e", "--extra-argument", "extra_arguments", "Extra arguments for the container, in the 'name:=value' form"),
    )
    for short, long, dest, text in repeated:
        parser.add_argument(short, long, action="append", dest=dest, help=text)


def run_standalone_container(*, container_node_name: str) -> subprocess.Popen[bytes]:
    """Start a container as a process of its own, and return the process.

    Raises
    ------
    RuntimeError
        When there is no container executable.
    """
    from ros2run.api import get_executable_path

    path = get_executable_path(package_name="rclcpp_components", executable_name="component_container")
    if path is None:
        raise RuntimeError("No component container node found!")
    return subprocess.Popen([path, "--ros-args", "-r", f"__node:={container_node_name}"])
