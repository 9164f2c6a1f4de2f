"""Panels and displays of the page that installed packages bring, each an ES module named by an entry point.

The value of an entry point is ``package:file.js``: a file, built or plain, in the folder of an importable package. The
page loads it from this server, and with it whatever it imports from below the same folder.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from urllib.parse import quote

from daidalos.common.extensions import BUILT_IN, Extension, Kind, from_entry_points, listing
from daidalos.studio.files import BUILT_IN_EXTENSIONS, STATIC, find_file

_SUFFIXES = frozenset({".js", ".mjs"})


class PageModuleError(Exception):
    """A module that cannot be served; the text is shown in its panel or display."""


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
    return PageModules(*(tuple(_served(kind, each) for each in _brought(kind)) for kind in KINDS))


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
    found = (each for known in KINDS if known.name == kind for each in _brought(known) if each.name == name)
    for extension in found:
        try:
            return find_file(_file(extension).parent, path)
        except PageModuleError:
            return None
    return None


def _brought(kind: Kind[Any]) -> Iterator[Extension]:
    return (each for each in listing(kind) if each.origin != BUILT_IN)


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
        raise PageModuleError(f"the package {package} cannot be imported: {error}") from None
    if spec is None:
        raise PageModuleError(f"there is no package {package}")
    for folder in spec.submodule_search_locations or ():
        path = Path(folder) / file
        if path.is_file():
            return path
    raise PageModuleError(f"the package {package} has no file {file}")


def _known(name: str, group: str) -> Iterator[Extension]:
    """Yield the page's own panels or displays, then those of packages, with their descriptions."""
    own: dict[str, str] = {}
    if (STATIC / BUILT_IN_EXTENSIONS).is_file():
        own = json.loads((STATIC / BUILT_IN_EXTENSIONS).read_text(encoding="utf-8"))[name]
    for each, description in own.items():
        yield Extension((each,), "", description)
    for extension in from_entry_points(group):
        if extension.name not in own:
            yield extension._replace(description=_description(extension))


def _description(extension: Extension) -> str:
    """Return the first line of a module's first comment."""
    try:
        text = _file(extension).read_text(encoding="utf-8", errors="replace")
    except PageModuleError as error:
        return f"({error})"
    first = text.lstrip().partition("\n")[0]
    return first.strip("/* ").removesuffix(".") if first.startswith(("//", "/*")) else extension.target


def _kind(name: str, contract: str, description: str) -> Kind[Any]:
    group = f"daidalos.{name}s"
    return Kind(name, group, f"daidalos-studio.d.ts:{contract}", description, partial(_known, name, group))


PANELS = _kind("studio_panel", "Panel", "a part of the studio's page; an ES module, package:file.js")
DISPLAYS = _kind(
    "studio_display", "DisplayModule", "draws messages in the studio's 3-D view; an ES module, package:file.js"
)
KINDS = (PANELS, DISPLAYS)
