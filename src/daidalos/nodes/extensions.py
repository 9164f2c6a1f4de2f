"""Registry of the nodes for containers, under ROS 2's names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.extensions import Extension, ExtensionError, Kind, find, listing
from daidalos.common.names import camel_case
from daidalos.workspaces.executables import BUILT_IN, all_left_out

if TYPE_CHECKING:
    from rclpy.node import Node


@cache
def _built_in() -> tuple[Extension, ...]:
    folders = sorted(folder for folder in BUILT_IN.iterdir() if (folder / "__init__.py").is_file())
    return tuple(extension for folder in folders for extension in _components_of(folder))


def _components_of(folder: Path) -> Iterator[Extension]:
    """Yield the components of a built-in package.

    A module holds the component of its own name in camel case. Components that ROS 2 calls otherwise are named in
    the package's ``__init__`` as ``COMPONENTS`` (name -> "module:Class").
    """
    package = folder.name
    named: dict[str, str] = {}
    if "COMPONENTS" in (folder / "__init__.py").read_text("utf-8"):
        named = import_module(f"daidalos.nodes.{package}").COMPONENTS
    for path in sorted(folder.glob("*.py")):
        name = camel_case(path.stem)
        text = "" if path.stem.startswith("_") else path.read_text("utf-8")
        if name not in named and re.search(rf"^class {name}\b", text, re.M):
            named = {**named, name: f"{path.stem}:{name}"}
    for name, place in named.items():
        yield Extension((f"{package}::{name}",), f"daidalos.nodes.{package}.{place}")


COMPONENTS: Kind[Node] = Kind(
    "component",
    "rclpy_components",
    "rclpy.node:Node",
    "a node that a container can load: `ros2 component load`",
    _built_in,
)
KINDS = (COMPONENTS,)


def find_component(package: str, plugin: str) -> type[Node]:
    """Return the node class behind a plugin name such as ``nav2_planner::PlannerServer``.

    Raises
    ------
    ExtensionError
        When there is none, or it cannot be used.
    """
    names = components(package)
    leaf = plugin.replace("/", "::").rpartition("::")[2]
    try:
        return find(
            COMPONENTS, plugin if plugin in names or f"{package}::{leaf}" not in names else f"{package}::{leaf}"
        )
    except ExtensionError as error:
        compiled = [name for name, why in all_left_out(package).items() if " is C++ " in why]
        if plugin in names or not compiled:
            raise
        raise ExtensionError(
            f"{error}; the C++ of package '{package}' was left out of the build: {', '.join(compiled)}"
        ) from None


def components(package: str) -> list[str]:
    """Return the plugin names of a package's components."""
    return sorted({one.name for one in listing(COMPONENTS) if one.name.startswith(f"{package}::")})


def packages() -> list[str]:
    """Return the packages that have components."""
    return sorted({one.name.partition("::")[0] for one in listing(COMPONENTS)})
