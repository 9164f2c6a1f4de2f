"""Launch functions that start controllers, and clients of a controller manager's services."""

from typing import Any

_SERVICES = (
    *("bcolors", "cleanup_controller", "configure_controller", "list_controller_types", "list_controllers"),
    *("list_hardware_components", "list_hardware_interfaces", "load_controller", "reload_controller_libraries"),
    *("set_hardware_component_state", "switch_controllers", "unload_controller"),
)
__all__ = _SERVICES


def __getattr__(name: str) -> Any:
    """Import the functions when they are used: launch files have no need of them."""
    if name not in _SERVICES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from controller_manager import controller_manager_services

    return getattr(controller_manager_services, name)
