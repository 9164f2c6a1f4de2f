"""Specification and entries of a new package."""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class NewPackage:
    """Package to be created; `build_type` is ``ament_python``, ``ament_cmake`` or ``cmake``."""

    name: str
    package_format: int
    description: str
    maintainer_name: str
    maintainer_email: str
    license: str
    build_type: str
    dependencies: tuple[str, ...] = ()
    node_name: str | None = None
    library_name: str | None = None

    def fault(self) -> str | None:
        """Return what is wrong with the names, None if they are valid."""
        if not re.fullmatch(r"[a-zA-Z][a-zA-Z0-9_-]*", self.name):
            return (
                f"'{self.name}' is not a valid package name: it must begin with a letter and consist of letters, "
                "digits, '_' and '-'"
            )
        if self.build_type == "ament_python" and not (self.name.isidentifier() and not keyword.iskeyword(self.name)):
            return f"'{self.name}' is not a valid name of a Python package"
        if self.build_type == "ament_python" and self.name == "test":
            return "a package of type 'ament_python' cannot be named 'test', as the folder of its tests is"
        for what, name in (("node", self.node_name), ("library", self.library_name)):
            if name and not re.fullmatch(r"[a-zA-Z_]\w*", name):
                return f"'{name}' is not a valid {what} name: it must consist of letters, digits and '_'"
        return None


@dataclass(frozen=True)
class Entry:
    """File, or folder if `text` is None; `note` is printed before its creation."""

    path: str
    text: str | None = None
    note: str = ""
