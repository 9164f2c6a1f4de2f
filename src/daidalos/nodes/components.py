"""Nodes that a container can load: which class stands behind a plugin name."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from daidalos.workspaces.executables import BUILT_IN

ENTRY_POINTS = "rclpy_components"
"""Group of entry points by which packages offer components: ``package::Class = module:Class``."""


class ComponentNotFound(LookupError):
    """There is no component of that name."""


def find_component(package: str, plugin: str) -> Any:
    """Return the node class behind a plugin name such as ``nav2_planner::PlannerServer``.

    Raises
    ------
    ComponentNotFound
        When there is none; the message says which the package has.
    """
    for point in entry_points(group=ENTRY_POINTS, name=plugin):
        return point.load()
    place = _built_in(package).get(plugin.replace("/", "::").rpartition("::")[2])
    if place is not None:
        module, name = place
        return getattr(import_module(f"daidalos.nodes.{package}.{module}"), name)
    known = ", ".join(components(package)) or "none"
    raise ComponentNotFound(f"package '{package}' has no component '{plugin}'; there are: {known}")


def components(package: str) -> list[str]:
    """Return the plugin names of a package's components."""
    from_others = [point.name for point in entry_points(group=ENTRY_POINTS) if point.name.startswith(f"{package}::")]
    return sorted({*from_others, *(f"{package}::{name}" for name in _built_in(package))})


def packages() -> list[str]:
    """Return the packages that have components."""
    from_others = {point.name.partition("::")[0] for point in entry_points(group=ENTRY_POINTS)}
    built_in = {folder.name for folder in BUILT_IN.iterdir() if (folder / "__init__.py").is_file()}
    return sorted(from_others | {package for package in built_in if _built_in(package)})


def _built_in(package: str) -> dict[str, tuple[str, str]]:
    """Return the components of a built-in package: name -> (module, class).

    A module holds the component of its own name in camel case. Components that ROS 2 calls otherwise are named in
    the package's ``__init__`` as ``COMPONENTS`` (name -> "module:Class").
    """
    folder = BUILT_IN / package
    if not (folder / "__init__.py").is_file():
        return {}
    found = {
        _camel(path.stem): (path.stem, _camel(path.stem))
        for path in sorted(folder.glob("*.py"))
        if not path.stem.startswith("_") and re.search(rf"^class {_camel(path.stem)}\b", path.read_text("utf-8"), re.M)
    }
    if "COMPONENTS" in (folder / "__init__.py").read_text("utf-8"):
        named: dict[str, str] = import_module(f"daidalos.nodes.{package}").COMPONENTS
        for name, place in named.items():
            module, _, kind = place.partition(":")
            found[name] = (module, kind)
    return found


def _camel(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))
