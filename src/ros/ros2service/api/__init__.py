"""Services and their types."""

from __future__ import annotations

from typing import Any

from ros2cli.graph import NameCompleter, NamesAndTypes, TypeCompleter, class_of, visible
from ros2cli.interfaces import interface_names


def get_service_names_and_types(*, node: Any, include_hidden_services: bool = False) -> NamesAndTypes:
    """Return the services in the graph with their types.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    include_hidden_services
        Whether those with a part that begins with an underscore are among them.
    """
    return visible(node.get_service_names_and_types(), include_hidden_services)


def get_service_names(*, node: Any, include_hidden_services: bool = False) -> list[str]:
    """Return the names of the services in the graph; see `get_service_names_and_types`."""
    found = get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)
    return [name for name, _ in found]


def get_service_class(node: Any, service: str, blocking: bool = False, include_hidden_services: bool = False) -> Any:
    """Return the class of a service; None where nobody knows the service.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    service
        The service.
    blocking
        Whether to wait for a service that is not there.
    include_hidden_services
        Whether it may be a hidden service.

    Raises
    ------
    RuntimeError
        When the service has more than one type, or one that is not known here.
    """
    from rosidl_runtime_py.utilities import get_service

    def listing() -> NamesAndTypes:
        return get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)

    return class_of(node, "service", node.resolve_service_name(service), listing, get_service, blocking)


def service_type_completer(**kwargs: Any) -> list[str]:
    """Return all service types."""
    return interface_names("srv")


class ServiceNameCompleter(NameCompleter):
    """Completer of the services that an argument may be.

    Parameters
    ----------
    include_hidden_services_key
        The argument that says whether hidden services are among them.
    """

    def __init__(self, *, include_hidden_services_key: str | None = None) -> None:
        super().__init__(
            lambda node, hidden: get_service_names(node=node, include_hidden_services=hidden),
            include_hidden_services_key,
        )


class ServiceTypeCompleter(TypeCompleter):
    """Completer of the types that an argument may be: those of the service which another argument names, or all.

    Parameters
    ----------
    service_name_key
        The other argument.
    """

    def __init__(self, *, service_name_key: str | None = None) -> None:
        super().__init__(_types_of, service_type_completer, service_name_key)


def _types_of(node: Any, service: str) -> list[str]:
    return dict(get_service_names_and_types(node=node, include_hidden_services=True)).get(
        node.resolve_service_name(service), []
    )
