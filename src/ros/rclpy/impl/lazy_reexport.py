"""Names that programs import from modules of ROS 2 that only use them, such as ``tf2_ros.TransformStamped``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lend(module: str, names: Mapping[str, tuple[str, ...]]) -> Callable[[str], Any]:
    """Make a module's ``__getattr__``, which imports a name when it is asked for: most programs ask for none.

    Parameters
    ----------
    module
        Whose names they seem to be.
    names
        The names, by the modules where they are at home.
    """
    homes = {name: home for home, each in names.items() for name in each}

    def find(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {module!r} has no attribute {name!r}", name=name, obj=sys.modules[module])
        value = getattr(import_module(homes[name]), name)
        setattr(sys.modules[module], name, value)
        return value

    return find
