"""Python modules and share files of a package with its own messages, services and actions."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from daidalos.common.errors import Location
from daidalos.common.suggestions import hint
from daidalos.interfaces.definition import Interface, messages_of
from daidalos.interfaces.description import Description, IndividualDescription, Lookup, describe
from daidalos.interfaces.generator import write_package
from daidalos.interfaces.library import BUILT_IN, InterfaceNotFound, Library, read_definition
from daidalos.interfaces.parser import InterfaceError
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.installation import Installation


def install_interfaces(
    package: str, files: Sequence[Path], installation: Installation, python_folder: str, prefixes: Sequence[Path]
) -> None:
    """Install the interfaces of a package.

    Parameters
    ----------
    package
        The package's name.
    files
        Its .msg, .srv, .action and .idl files.
    installation
        Where everything goes.
    python_folder
        Where Python packages go, relative to the prefix.
    prefixes
        Where the interfaces of other packages are found, beside the built-in ones.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    try:
        own = {path: read_definition(path, package) for path in files}
    except InterfaceError as error:
        raise WorkspaceError(str(error)) from None
    for path, interface in own.items():
        installation.put(path, f"share/{package}/{interface.name.split('/')[1]}/{path.name}")
    prefixes = [installation.prefix, *prefixes]
    library = Library([*(prefix / "share" for prefix in prefixes), BUILT_IN])
    known = _known_messages(library)
    for path, interface in own.items():
        _check_references(path, interface, library.get, known)
    for path in write_package(package, own.values(), library.get, installation.prefix / python_folder):
        installation.register_installed(path)
    for interface in own.values():
        text = json.dumps(_described(describe(interface, library.get)), indent=2) + "\n"
        installation.write(f"share/{interface.name}.json", text)
    index = sorted(
        f"{interface.name.split('/', 1)[1]}{suffix}"
        for path, interface in own.items()
        for suffix in (".json", path.suffix)
    )
    installation.write(f"share/ament_index/resource_index/rosidl_interfaces/{package}", "\n".join(index))


def _known_messages(library: Library) -> list[str]:
    return [name for package in library.packages() for name in library.names(package) if "/msg/" in name]


def _check_references(path: Path, interface: Interface, lookup: Lookup, known: Sequence[str]) -> None:
    local = {message.name for message in messages_of(interface)}
    for message in messages_of(interface):
        for name in message.nested():
            if name in local:
                continue
            try:
                lookup(name)
            except InterfaceNotFound:
                package, _, short = name.split("/")
                meant = hint(f"{package}/{short}", [other.replace("/msg/", "/") for other in known])
                raise WorkspaceError(
                    f"there is no message '{package}/{short}'{meant}", Location(str(path), _line(path, short))
                ) from None


def _line(path: Path, short: str) -> int:
    """Return the line of the first field of this type."""
    pattern = re.compile(rf"\s*([\w/]+/)?{short}\b")
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    return next((number for number, line in enumerate(lines, 1) if pattern.match(line)), 1)


def _described(description: Description) -> dict[str, object]:
    """Return the description of a type as in rosidl's .json files, with all hashes."""
    hashes = {description.type_description.type_name: description.type_hash()}
    for other in description.referenced:
        hashes[other.type_name] = _hash(other, description)
    return {
        "type_description_msg": {
            "type_description": _plain(description.type_description),
            "referenced_type_descriptions": [_plain(other) for other in description.referenced],
        },
        "type_hashes": [{"type_name": name, "hash_string": value} for name, value in hashes.items()],
    }


def _hash(individual: IndividualDescription, whole: Description) -> str:
    """Return the hash of a type from the part of the description that it needs."""
    by_name = {other.type_name: other for other in whole.referenced}
    needed: set[str] = set()
    pending = [individual]
    while pending:
        for field in pending.pop().fields:
            name = field.nested_type_name
            if name and name not in needed:
                needed.add(name)
                pending.append(by_name[name])
    return Description(individual, tuple(by_name[name] for name in sorted(needed))).type_hash()


def _plain(individual: IndividualDescription) -> dict[str, object]:
    fields = []
    for field in individual.fields:
        values = asdict(field)
        name, default = values.pop("name"), values.pop("default_value")
        order = ("type_id", "capacity", "string_capacity", "nested_type_name")
        fields.append({"name": name, "type": {key: values[key] for key in order}, "default_value": default})
    return {"type_name": individual.type_name, "fields": fields}
