"""Lazy packages: a public name is imported from its module when somebody first asks for it.

The names and their modules are read from the package's own `__init__.pyi`, so that editors, type checkers
and the running program share one list.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable
from typing import Any

_IMPORT = re.compile(r"^from \.(\S*) import \(?\s*(\w+) as \2", re.MULTILINE)


def attach_stub(package: str, init_file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` for a package whose `__init__.pyi` lists its names.

    Parameters
    ----------
    package
        The package's `__name__`.
    init_file
        The package's `__file__`.
    """
    names, submodules = _read_stub(init_file + "i")
    public = sorted({*names, *submodules})
    modules = submodules | {module.partition(".")[0] for module in names.values()}

    def __getattr__(name: str) -> Any:
        module = importlib.import_module(package)
        if name in names:
            value = getattr(importlib.import_module(f".{names[name]}", package), name)
        elif name in modules:
            value = importlib.import_module(f"{package}.{name}")
        else:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        setattr(module, name, value)
        return value

    def __dir__() -> list[str]:
        return public

    return __getattr__, __dir__, public


def _read_stub(stub_file: str) -> tuple[dict[str, str], set[str]]:
    """Read the lines `from .module import Name as Name` and `from . import module as module`."""
    names: dict[str, str] = {}
    submodules: set[str] = set()
    with open(stub_file, encoding="utf-8") as stub:
        for module, name in _IMPORT.findall(stub.read()):
            if module:
                names[name] = module
            else:
                submodules.add(name)
    return names, submodules
