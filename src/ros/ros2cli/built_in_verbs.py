"""Modules of the built-in verbs under ROS 2's names: ``ros2topic.verb.echo`` has the class ``EchoVerb``.

The verbs are entry points of the groups ``ros2topic.verb`` and so on; a module of such a name has what the module
of the entry point has.
"""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.metadata import entry_points
from types import ModuleType

_MODULE = re.compile(r"(?P<group>ros2\w+\.verb|ros2cli\.verb\.daemon|ros2\w+\.command)\.(?P<name>\w+)")
_GROUPS = {"ros2cli.verb.daemon": "ros2cli.daemon.verb"}
"""Groups of entry points that are not called as the package of their modules."""


class _Finder(MetaPathFinder):
    """Finder of the modules of built-in verbs and commands."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a verb's module, None for other modules."""
        match = _MODULE.fullmatch(fullname)
        if match is None:
            return None
        group = "ros2cli.command" if match["group"].endswith(".command") else match["group"]
        points = entry_points(group=_GROUPS.get(group, group), name=match["name"])
        return next((ModuleSpec(fullname, _Alias(point.module)) for point in points), None)


class _Alias(Loader):
    """Loader of a module with the content of another one."""

    def __init__(self, original: str) -> None:
        self._original = original

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Return None, for a module as usual."""

    def exec_module(self, module: ModuleType) -> None:
        """Import the other module and take over its content."""
        content = vars(importlib.import_module(self._original))
        vars(module).update({name: value for name, value in content.items() if not name.startswith("__")})
        module.__doc__ = content["__doc__"]


def register() -> None:
    """Make Python find the modules of built-in verbs."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.append(_Finder())
