"""Registry of extensions: planners, sensors, controllers, verbs, panels and the like.

A *kind* of extension is declared in its layer, beside its contract. An extension is one class in one file, found by

1. the name of a built-in class, in any spelling of ROS's: ``package::Class``, ``package/Class``, or ``Class`` where
   that is unique;
2. the name of an entry point of the kind's group, which an installed package offers;
3. its class path: ``my_package.my_module.MyClass`` or ``my_package.my_module:MyClass``.

No class is imported to list extensions, and only the one that is asked for to find it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    import ast
    from importlib.metadata import EntryPoint

    from daidalos.common.errors import Location

T = TypeVar("T")

BUILT_IN = "built in"
"""Origin of the extensions that are part of this package."""

_parsing = Lock()
"""Held while Python's parser makes a tree: in CPython 3.11 two threads that do so at once raise `SystemError`."""

_CLASS_PATH = r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)+"


class ExtensionError(UserError):
    """Unknown or unusable extension; its location is the parameter that refers to it."""


class UnknownExtension(ExtensionError):
    """Unknown name of an extension."""


class Extension(NamedTuple):
    """Extension that was found and not yet imported.

    Attributes
    ----------
    names : tuple of str
        Names that files give it, the usual one first.
    target : str
        ``module:Class``.
    description : str
        One line without a full stop; empty where only the class itself could tell.
    origin : str
        `BUILT_IN`, or name and version of the distribution whose entry point it is.
    """

    names: tuple[str, ...]
    target: str
    description: str = ""
    origin: str = BUILT_IN

    @property
    def name(self) -> str:
        """Return the usual name."""
        return self.names[0]

    def load(self) -> Any:
        """Import the class; raises whatever its module raises."""
        module, _, attributes = self.target.partition(":")
        loaded: Any = import_module(module)
        for attribute in attributes.split(".") if attributes else ():
            loaded = getattr(loaded, attribute)
        return loaded


def _none() -> Iterable[Extension]:
    return ()


def _same(name: str) -> str:
    return name


class Kind(Generic[T]):
    """Kind of extension.

    Parameters
    ----------
    name : str
        Such as ``planner``; words are joined by underscores.
    group : str
        Group of entry points by which packages add extensions.
    contract : str
        ``module:Class`` that extensions are subclasses of, or whose methods they have if it is a runtime-checkable
        `typing.Protocol`. Imported only to check a class.
    description : str
        What such an extension does: one line without a full stop.
    built_in : callable
        Returns the built-in extensions without importing them.
    normalize : callable
        Brings a name into the form that the table of names has, such as ``libname.so`` into ``name``.
    """

    def __init__(
        self,
        name: str,
        group: str,
        contract: str,
        description: str,
        built_in: Callable[[], Iterable[Extension]] = _none,
        normalize: Callable[[str], str] = _same,
    ) -> None:
        self.name = name
        self.group = group
        self.contract = contract
        self.description = description
        self.built_in = built_in
        self.normalize = normalize

    @property
    def title(self) -> str:
        """Return the name for people."""
        return self.name.replace("_", " ")


def find(kind: Kind[T], name: str, *, asked_by: Location | None = None) -> type[T]:
    """Return the class behind a name.

    Parameters
    ----------
    kind : Kind
    name : str
        Of a built-in extension, of an entry point, or a class path.
    asked_by : Location, optional
        Where the name was written; the error's message names it.

    Raises
    ------
    UnknownExtension
        There is no such extension; the message says which names are near.
    ExtensionError
        It is there, but cannot be imported or does not fulfil the contract.
    """
    return load(kind, locate(kind, name, asked_by=asked_by), asked_by=asked_by)


def locate(kind: Kind[T], name: str, *, asked_by: Location | None = None) -> Extension:
    """Return the extension of a name without importing its class; see `find`."""
    found = (
        _by_name(kind, name, kind.built_in()) or _by_name(kind, name, from_entry_points(kind.group)) or _by_path(name)
    )
    if found is None:
        from daidalos.common.suggestions import hint

        known = [other for extension in listing(kind) for other in extension.names]
        raise UnknownExtension(f"there is no {kind.title} '{name}'{hint(kind.normalize(name), known)}", asked_by)
    return found


def load(kind: Kind[T], extension: Extension, *, asked_by: Location | None = None) -> type[T]:
    """Import the class of an extension; see `find`. Those that are not built in are checked against the contract."""
    described = f"{kind.title} '{extension.name}'"
    if extension.origin not in (BUILT_IN, extension.target.partition(":")[0]):
        described += f" of {extension.origin}"
    try:
        loaded = extension.load()
    except Exception as error:  # code of the user's may raise anything
        reason = str(error) or type(error).__name__
        raise ExtensionError(f"{described} cannot be loaded from {extension.target}: {reason}", asked_by) from error
    if extension.origin == BUILT_IN:
        return loaded  # type: ignore[no-any-return]
    module, _, name = kind.contract.partition(":")
    contract = getattr(import_module(module), name)
    if not (isinstance(loaded, type) and issubclass(loaded, contract)):
        raise ExtensionError(f"{described}: {extension.target} is not a {contract.__name__}", asked_by)
    return loaded


def listing(kind: Kind[Any]) -> list[Extension]:
    """Return the extensions of a kind, built-in ones first, without importing their classes."""
    built_in = list(kind.built_in())
    known = {name for extension in built_in for name in extension.names}
    return [*built_in, *(extension for extension in from_entry_points(kind.group) if extension.name not in known)]


def describe(extension: Extension) -> str:
    """Return an extension's description: one line without the full stop.

    Imports the class if the description is not known otherwise; an extension that cannot be imported is described by
    why.
    """
    if extension.description:
        return extension.description
    try:
        return first_line(extension.load())
    except Exception as error:  # code of the user's may raise anything
        return f"(cannot be loaded: {str(error) or type(error).__name__})".replace("\n", " ")


def first_line(documented: object) -> str:
    """Return the first line of a docstring without its full stop."""
    text = (getattr(documented, "__doc__", None) or "").strip()
    return text.partition("\n")[0].removesuffix(".")


def _by_name(kind: Kind[Any], name: str, extensions: Iterable[Extension]) -> Extension | None:
    """Return the extension of a name, or of the only name whose last part it is."""
    wanted = _spelling(kind.normalize(name))
    leaves = []
    for extension in extensions:
        for other in extension.names:
            spelled = _spelling(kind.normalize(other))
            if spelled == wanted:
                return extension
            if spelled.endswith(f"/{wanted}") and extension not in leaves:
                leaves.append(extension)
    return leaves[0] if len(leaves) == 1 else None


def _spelling(name: str) -> str:
    return name.strip().replace("::", "/")


def from_entry_points(group: str) -> Iterator[Extension]:
    """Yield the extensions of a group of entry points without importing them."""
    from importlib.metadata import entry_points

    for point in entry_points(group=group):
        yield Extension((point.name,), f"{point.module}:{point.attr}".removesuffix(":"), origin=_origin(point))


def _origin(point: EntryPoint) -> str:
    if point.dist is None:
        return "unknown"
    return f"{point.dist.name or 'unknown'} {point.dist.version or ''}".rstrip()


def _by_path(name: str) -> Extension | None:
    """Return the extension of a class path if its module exists."""
    from importlib.util import find_spec

    path = name.strip().replace("::", ".").replace("/", ".").replace(":", ".")
    if not re.fullmatch(_CLASS_PATH, path):
        return None
    module, _, cls = path.rpartition(".")
    try:
        spec = find_spec(module)
    except Exception:  # importing the packages around it runs code of the user's
        return Extension((name,), f"{module}:{cls}", origin=module) if _exists(module.partition(".")[0]) else None
    if spec is None or spec.origin is None:  # not there, or a folder that happens to have that name
        return None
    return Extension((name,), f"{module}:{cls}", origin=module)


def _exists(package: str) -> bool:
    from importlib.util import find_spec

    try:
        return find_spec(package) is not None
    except (ImportError, ValueError):
        return False


@cache
def classes_in(*packages: str, attribute: str = "names") -> tuple[Extension, ...]:
    """Return the classes in the modules of packages that name themselves in a class attribute.

    The files are read and not imported, so the attribute has to be a literal tuple of strings.

    Parameters
    ----------
    *packages : str
        Such as ``daidalos.navigation.planners``.
    attribute : str
        Class attribute with the names.
    """
    return tuple(extension for package in packages for extension in _classes_in(package, attribute))


def _classes_in(package: str, attribute: str) -> Iterator[Extension]:
    import ast
    from importlib.util import find_spec

    spec = find_spec(package)
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        for path in sorted(Path(folder).glob("*.py")):
            text = path.read_text(encoding="utf-8")
            if f"    {attribute} = (" not in text and f"    {attribute}: ClassVar[" not in text:
                continue
            with _parsing:
                body = ast.parse(text, str(path)).body
            for node in body:
                names = _names_of(node, attribute) if isinstance(node, ast.ClassDef) else ()
                if isinstance(node, ast.ClassDef) and names:
                    description = (ast.get_docstring(node) or "").partition("\n")[0].removesuffix(".")
                    yield Extension(names, f"{package}.{path.stem}:{node.name}", description)


def _names_of(definition: ast.ClassDef, attribute: str) -> tuple[str, ...]:
    """Return the strings of a class attribute; starred tuples in it are unpacked."""
    import ast

    for statement in definition.body:
        targets: list[ast.expr] = []
        if isinstance(statement, ast.Assign):
            targets = statement.targets
        elif isinstance(statement, ast.AnnAssign):
            targets = [statement.target]
        if attribute in (getattr(one, "id", "") for one in targets):
            found = (one for one in ast.walk(statement) if isinstance(one, ast.Constant))
            texts = [one for one in found if isinstance(one.value, str)]  # the annotation has an ellipsis
            return tuple(str(one.value) for one in sorted(texts, key=lambda one: (one.lineno, one.col_offset)))
    return ()
