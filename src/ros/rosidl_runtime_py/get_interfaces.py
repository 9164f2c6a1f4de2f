"""Lookup of interfaces."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ament_index_python.packages import get_packages_with_prefixes
from ament_index_python.search_paths import get_all_prefixes

from daidalos.interfaces.library import BUILT_IN, InterfaceNotFound, Library


def interface_library() -> Library:
    """Return the definitions of the user's workspaces and the built-in ones."""
    shares = [Path(prefix) / "share" for prefix in get_all_prefixes()]
    return Library(dict.fromkeys([*shares, BUILT_IN]))


def get_interface_packages() -> dict[str, str]:
    """Return the packages that define interfaces, with the prefix that each is in."""
    library = interface_library()
    return {package: str(library.path(library.names(package)[0]).parents[3]) for package in library.packages()}


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the interfaces of packages (of all where none is named) as ``msg/Name`` and so on.

    Raises
    ------
    LookupError
        When there is no such package; one without interfaces is left out.
    """
    library = interface_library()
    found = {}
    for package in package_names or library.packages():
        names = library.names(package)
        if not names:
            if package in get_packages_with_prefixes():
                continue
            raise LookupError(f"Unknown package '{package}'")
        found[package] = [name.removeprefix(f"{package}/") for name in names]
    return found


def _of_kind(kind: str, package_names: Iterable[str]) -> dict[str, list[str]]:
    found = {
        package: [name for name in names if name.startswith(f"{kind}/")]
        for package, names in get_interfaces(package_names).items()
    }
    return {package: names for package, names in found.items() if names}


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages of packages; see `get_interfaces`."""
    return _of_kind("msg", package_names)


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the services of packages; see `get_interfaces`."""
    return _of_kind("srv", package_names)


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the actions of packages; see `get_interfaces`."""
    return _of_kind("action", package_names)


def get_interface_path(interface_name: str) -> str:
    """Return the file that defines ``package/kind/Name``.

    Raises
    ------
    LookupError
        When there is none.
    ValueError
        When the name has another form.
    """
    parts = interface_name.split("/")
    if len(parts) != 3 or not all(parts):
        raise ValueError(
            f"Invalid name '{interface_name}'. Expected three parts separated by '/', such as 'std_msgs/msg/String'"
        )
    kind = parts[1]
    parts[2] = parts[2].removesuffix(f".{kind}").removesuffix(".idl")
    try:
        return str(interface_library().path("/".join(parts)))
    except InterfaceNotFound:
        share = _share(parts[0])
        if share is None:
            raise LookupError(f"Unknown package '{parts[0]}'") from None
        raise LookupError(f"Could not find the interface '{share / kind / parts[2]}.idl'") from None


def _share(package: str) -> Path | None:
    """Return the share folder of a package, with or without interfaces; None where there is no such package."""
    from ament_index_python.packages import PackageNotFoundError, get_package_share_path

    try:
        return Path(get_package_share_path(package))
    except (PackageNotFoundError, ValueError):
        return None
