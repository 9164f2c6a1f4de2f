"""Panels and displays of the page that installed packages bring, each an ES module named by an entry point.

The value of an entry point is ``package:file.js``: a file, built or plain, in the folder of an importable package. The
page loads it from this server, and with it whatever it imports from below the same folder.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from urllib.parse import quote

from daidalos.common.extensions import Extension, Kind, from_entry_points, listing
from daidalos.studio.files import find_file

_SUFFIXES = frozenset({".js", ".mjs"})


class PageModuleError(Exception):
    """A module that can not be served; the text is shown in its panel or display."""


@dataclass(frozen=True)
class PageModule:
    """An ES module of an installed package: where it is served, or why it is not."""

    name: str
    origin: str
    url: str | None = None
    error: str | None = None


@dataclass(frozen=True)
class PageModules:
    """The panels and displays of installed packages."""

    panels: tuple[PageModule, ...]
    displays: tuple[PageModule, ...]


def page_modules() -> PageModules:
    """Return what the installed packages bring."""
    return PageModules(*(tuple(_served(kind, each) for each in listing(kind)) for kind in KINDS))


def module_file(kind: str, name: str, path: str) -> Path | None:
    """Return the file of a module that is served below ``/extensions/<kind>/<name>/``; None where there is none.

    Parameters
    ----------
    kind : str
        ``studio_panel`` or ``studio_display``.
    name : str
        The entry point's name.
    path : str
        Below the folder of the module.
    """
    found = (each for known in KINDS if known.name == kind for each in listing(known) if each.name == name)
    for extension in found:
        try:
            return find_file(_file(extension).parent, path)
        except PageModuleError:
            return None
    return None


def _served(kind: Kind[Any], extension: Extension) -> PageModule:
    name, origin = extension.name, extension.origin
    try:
        file = _file(extension).name
    except PageModuleError as error:
        return PageModule(name, origin, error=str(error))
    return PageModule(name, origin, f"extensions/{kind.name}/{quote(name, safe='')}/{quote(file)}")


def _file(extension: Extension) -> Path:
    package, _, file = extension.target.partition(":")
    if Path(file).suffix not in _SUFFIXES:
        raise PageModuleError(f"expected package:file.js instead of {extension.target}")
    try:
        spec = find_spec(package)
    except Exception as error:  # importing the packages around it runs code of the user's
        raise PageModuleError(f"the package {package} can not be imported: {error}") from None
    if spec is None:
        raise PageModuleError(f"there is no package {package}")
    for folder in spec.submodule_search_locations or ():
        path = Path(folder) / file
        if path.is_file():
            return path
    raise PageModuleError(f"the package {package} has no file {file}")


def _installed(group: str) -> Iterator[Extension]:
    for extension in from_entry_points(group):
        yield extension._replace(description=_description(extension))


def _description(extension: Extension) -> str:
    """Return the first line of a module's first comment."""
    try:
        text = _file(extension).read_text(encoding="utf-8", errors="replace")
    except PageModuleError as error:
        return f"({error})"
    first = text.lstrip().partition("\n")[0]
    return first.strip("/* ").removesuffix(".") if first.startswith(("//", "/*")) else extension.target


def _kind(name: str, description: str) -> Kind[Any]:
    group = f"daidalos.{name}s"
    return Kind(name, group, "daidalos.studio.extensions:PageModule", description, partial(_installed, group))


PANELS = _kind("studio_panel", "shows and does something in the studio's page; an ES module, package:file.js")
DISPLAYS = _kind("studio_display", "draws messages into the studio's 3-D view; an ES module, package:file.js")
KINDS = (PANELS, DISPLAYS)
