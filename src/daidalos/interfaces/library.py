"""Lookup of interface definitions by name in `share` folders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from daidalos.common.errors import Location
from daidalos.interfaces.definition import Action, Interface, Message
from daidalos.interfaces.idl import IdlInterface, read_idl
from daidalos.interfaces.parser import InterfaceError, parse, parse_file

KINDS = ("msg", "srv", "action")
BUILT_IN = Path(__file__).resolve().parent.parent / "share"


class InterfaceNotFound(LookupError):
    """There is no definition with this name."""


class Library:
    """Interface definitions below `share` folders; earlier folders take precedence.

    Parameters
    ----------
    shares
        Folders that hold ``<package>/<msg|srv|action>/<Name>.<msg|srv|action>``, or ``.idl`` where there is none.
    """

    def __init__(self, shares: Iterable[Path] = (BUILT_IN,)) -> None:
        self._shares = tuple(shares)
        self._parsed: dict[Path, Interface] = {}

    def packages(self) -> list[str]:
        """Return the names of the packages that define an interface, sorted."""
        names = {
            folder.parent.name
            for share in self._shares
            for kind in KINDS
            for folder in share.glob(f"*/{kind}")
            if any(folder.glob(f"*.{kind}")) or any(folder.glob("*.idl"))
        }
        return sorted(names)

    def names(self, package: str) -> list[str]:
        """Return the full names of a package's interfaces, sorted within each kind."""
        for share in self._shares:
            found = list(_files(share / package))
            if found:
                return list(dict.fromkeys(f"{package}/{path.parent.name}/{path.stem}" for path in found))
        return []

    def path(self, name: str) -> Path:
        """Return the file that defines ``package/kind/Name``.

        Raises
        ------
        InterfaceNotFound
            When there is none.
        """
        package, kind, short = name.split("/")
        for share in self._shares:
            for suffix in (kind, "idl"):
                path = share / package / kind / f"{short}.{suffix}"
                if path.is_file():
                    return path
        raise InterfaceNotFound(f"no definition of '{name}'")

    def get(self, name: str) -> Interface:
        """Return the definition of ``package/kind/Name``, also of parts such as ``pkg/srv/X_Request``.

        Raises
        ------
        InterfaceNotFound
            When there is none.
        """
        base, part = _split(name)
        path = self.path(base)
        if path not in self._parsed:
            self._parsed[path] = read_definition(path, base.split("/")[0])
        interface = self._parsed[path]
        if not part:
            return interface
        for other in _parts(interface):
            if other.name == name:
                return other
        raise InterfaceNotFound(f"'{base}' has no part '{part}'")


def read_definition(path: Path, package: str) -> Interface:
    """Read a .msg, .srv, .action or .idl file of a package.

    Raises
    ------
    InterfaceError
        Naming the file and the line at fault.
    """
    if path.suffix != ".idl":
        return parse_file(path, package)
    found = _read_idl(path)
    if found.package != package:
        raise InterfaceError(
            f"its module is '{found.package}', expected '{package}' as the package is called", Location(str(path))
        )
    return parse(found.text, package, found.kind, found.name, str(path))


def definition_text(path: Path) -> str:
    """Return what a file says as a .msg, .srv or .action file, which it may be.

    Raises
    ------
    InterfaceError
        Naming the file and the line at fault.
    """
    return _read_idl(path).text if path.suffix == ".idl" else path.read_text(encoding="utf-8")


def _read_idl(path: Path) -> IdlInterface:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise InterfaceError(f"byte {error.start} is not valid UTF-8", Location(str(path))) from None
    return read_idl(text, path.stem, str(path))


def _files(package: Path) -> Iterator[Path]:
    for kind in KINDS:
        folder = package / kind
        yield from sorted([*folder.glob(f"*.{kind}"), *folder.glob("*.idl")], key=lambda path: path.stem)


def _split(name: str) -> tuple[str, str]:
    """Split ``pkg/srv/X_Request`` into ``pkg/srv/X`` and ``Request``; messages have no parts."""
    package, kind, short = name.split("/")
    if kind == "msg":
        return name, ""
    base, _, part = short.partition("_")
    return f"{package}/{kind}/{base}", part


def _parts(interface: Interface) -> Iterator[Interface]:
    if isinstance(interface, Message):
        return
    yield from interface.messages
    if isinstance(interface, Action):
        yield from (interface.send_goal, interface.get_result)


@cache
def built_in() -> Library:
    """Return the library of the definitions that come with this package."""
    return Library()
