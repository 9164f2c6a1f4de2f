"""Lazy re-export of names that programs import from other modules, such as ``tf2_ros.TransformStamped``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lazy_reexport(module: str, names: Mapping[str, tuple[str, ...]]) -> Callable[[str], Any]:
    """Return a module's ``__getattr__`` that imports re-exported names on first access.

    Parameters
    ----------
    module
        Name of the module that re-exports them.
    names
        The re-exported names, by the module that defines them.
    """
    origins = {name: origin for origin, each in names.items() for name in each}

    def find(name: str) -> Any:
        if name not in origins:
            raise AttributeError(f"module {module!r} has no attribute {name!r}", name=name, obj=sys.modules[module])
        value = getattr(import_module(origins[name]), name)
        setattr(sys.modules[module], name, value)
        return value

    return find
