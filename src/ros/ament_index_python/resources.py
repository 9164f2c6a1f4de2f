"""Resources: small marker files by which packages register what they offer, by type and name."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from typing import Literal

from .constants import RESOURCE_INDEX_SUBFOLDER
from .search_paths import get_all_prefixes, get_built_in_prefix


class InvalidResourceTypeNameError(ValueError):
    """The name of a resource type cannot be one."""


class InvalidResourceNameError(ValueError):
    """The name of a resource cannot be one."""


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return what a resource's file holds, and the prefix in which it was found first.

    Parameters
    ----------
    resource_type
        The type, such as 'packages'.
    resource_name
        The name, usually that of a package.

    Raises
    ------
    ValueError
        If one of the names is empty or cannot be one.
    LookupError
        If there is no such resource.
    OSError
        If its file cannot be read.
    """
    prefix = has_resource(resource_type, resource_name)
    if not prefix:
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    path = _resource_path(prefix, resource_type, resource_name)
    if not os.path.isfile(path):
        return "", prefix
    try:
        with open(path, encoding="utf-8") as file:
            return file.read(), prefix
    except OSError as error:
        raise OSError(f"Could not open the resource '{resource_name}' of type '{resource_type}': {error}") from error


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the names of all resources of a type, each with the prefix in which it was found first.

    Raises
    ------
    ValueError
        If the type is empty or cannot be one.
    """
    _check_type(resource_type)
    found: dict[str, str] = {}
    for prefix in get_all_prefixes():
        for name in _names_in(prefix, resource_type):
            found.setdefault(name, prefix)
    return found


def get_resource_types() -> set[str]:
    """Return the types of all resources."""
    types = {"packages"} if any(_built_in_packages()) else set()
    for prefix in get_all_prefixes():
        folder = os.path.join(prefix, RESOURCE_INDEX_SUBFOLDER)
        if os.path.isdir(folder):
            types.update(name for name in os.listdir(folder) if os.path.isdir(os.path.join(folder, name)))
    return types


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the prefix in which a resource is found first, or False.

    Raises
    ------
    ValueError
        If one of the names is empty or cannot be one.
    """
    _check_type(resource_type)
    _check_name(resource_name)
    built_in = get_built_in_prefix()
    for prefix in get_all_prefixes():
        if os.path.isfile(_resource_path(prefix, resource_type, resource_name)):
            return prefix
        if prefix == built_in and resource_type == "packages" and _is_built_in(prefix, resource_name):
            return prefix
    return False


def _check_type(resource_type: str) -> None:
    if not resource_type:
        raise ValueError("The resource type must not be empty")
    if "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' has a slash in its name")


def _check_name(resource_name: str) -> None:
    if not resource_name:
        raise ValueError("The resource name must not be empty")
    if re.search(r"[/\\]", resource_name):
        raise InvalidResourceNameError(f"Resource '{resource_name}' has a slash in its name")


def _resource_path(prefix: str, resource_type: str, resource_name: str) -> str:
    return os.path.join(prefix, RESOURCE_INDEX_SUBFOLDER, resource_type, resource_name)


def _names_in(prefix: str, resource_type: str) -> Iterator[str]:
    folder = os.path.join(prefix, RESOURCE_INDEX_SUBFOLDER, resource_type)
    if os.path.isdir(folder):
        with os.scandir(folder) as entries:
            # Other tools leave hidden files in these folders.
            yield from [entry.name for entry in entries if entry.is_file() and not entry.name.startswith(".")]
    if resource_type == "packages" and prefix == get_built_in_prefix():
        yield from _built_in_packages()


def _built_in_packages() -> Iterator[str]:
    prefix = get_built_in_prefix()
    share = os.path.join(prefix or "", "share")
    if prefix is not None and os.path.isdir(share):
        yield from (name for name in os.listdir(share) if _is_built_in(prefix, name))


def _is_built_in(prefix: str, package_name: str) -> bool:
    return os.path.isfile(os.path.join(prefix, "share", package_name, "package.xml"))
