"""TypeScript types of interface definitions: messages as the page's CDR reader delivers them.

Runs when the project is built; needs the standard library only.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator

from daidalos.interfaces.definition import FieldType, Interface, Kind, Message, Service, messages_of
from daidalos.interfaces.library import Library

_SCALARS = {"bool": "boolean", "string": "string", "wstring": "string", "int64": "bigint", "uint64": "bigint"}
_ARRAYS = {
    # `byte` is signed for @foxglove/rosmsg.
    "byte": "Int8Array", "char": "Uint8Array",
    "int8": "Int8Array", "uint8": "Uint8Array", "int16": "Int16Array", "uint16": "Uint16Array",
    "int32": "Int32Array", "uint32": "Uint32Array", "int64": "BigInt64Array", "uint64": "BigUint64Array",
    "float32": "Float32Array", "float64": "Float64Array",
}  # fmt: skip


def typescript_modules(names: Iterable[str], library: Library, *, ambient: bool = False) -> dict[str, str]:
    """Generate the TypeScript types of interfaces and of all that they refer to.

    A message is an interface of its short name, with an object of the same name for its constants. A service
    ``X`` is ``X_Request``, ``X_Response`` and ``X`` that names both.

    Parameters
    ----------
    names
        Full names such as ``sensor_msgs/msg/LaserScan`` and ``std_srvs/srv/Empty``.
    library
        Where the definitions are found.
    ambient
        Whether to generate namespaces for one declaration file, which have no constants, instead of modules.

    Returns
    -------
    dict
        The text of one module or namespace per ROS package, by the package's name.

    Raises
    ------
    InterfaceNotFound
        When a name, or a name that it refers to, has no definition.
    """
    packages: dict[str, dict[str, Interface]] = {}
    for interface in _with_dependencies(names, library):
        package, _, short = interface.name.split("/")
        other = packages.setdefault(package, {}).setdefault(short, interface)
        if other.name != interface.name:
            raise ValueError(f"{other.name} and {interface.name} have the same name in TypeScript")
    return {package: (_namespace if ambient else _module)(package, packages[package]) for package in sorted(packages)}


def _with_dependencies(names: Iterable[str], library: Library) -> list[Interface]:
    found: dict[str, Interface] = {}
    pending = list(names)
    while pending:
        name = pending.pop()
        if name not in found:
            found[name] = library.get(name)
            pending += [nested for message in _sent(found[name]) for nested in message.nested()]
    return [found[name] for name in sorted(found)]


def _sent(interface: Interface) -> tuple[Message, ...]:
    """Return the messages that a client of the interface sends and receives."""
    return (interface.request, interface.response) if isinstance(interface, Service) else messages_of(interface)


def _module(package: str, interfaces: dict[str, Interface]) -> str:
    imported = _imported(package, interfaces)
    blocks = [f'import type {{ {", ".join(names)} }} from "./{other}";' for other, names in imported.items()]
    blocks += _declarations(interfaces, _constants)
    return "\n\n".join(blocks) + "\n"


def _namespace(package: str, interfaces: dict[str, Interface]) -> str:
    imported = _imported(package, interfaces)
    lines = [f"import {name} = {other}.{name};" for other, names in imported.items() for name in names]
    lines += _declarations(interfaces, lambda message: [])
    return f"export declare namespace {package} {{\n" + "\n".join(lines) + "\n}\n"


def _imported(package: str, interfaces: dict[str, Interface]) -> dict[str, list[str]]:
    """Return the names that are imported from other packages, by these."""
    imported: dict[str, set[str]] = {}
    for interface in interfaces.values():
        for name in [name for message in _sent(interface) for name in message.nested()]:
            other, _, short = name.split("/")
            if other != package:
                imported.setdefault(other, set()).add(short)
    return {other: sorted(imported[other]) for other in sorted(imported)}


def _declarations(interfaces: dict[str, Interface], constants: Callable[[Message], Iterable[str]]) -> Iterator[str]:
    for interface in interfaces.values():
        for message in _sent(interface):
            yield "\n".join([*_declaration(message), *constants(message)])
        if isinstance(interface, Service):
            short = _short(interface.name)
            yield (
                f"/** {interface.name} */\n"
                f"export interface {short} {{\n  Request: {short}_Request;\n  Response: {short}_Response;\n}}"
            )


def _declaration(message: Message) -> list[str]:
    short = _short(message.name)
    lines = [*_comment(f"{message.name}\n{message.comment}".strip(), ""), f"export interface {short} {{"]
    for field in message.fields:
        lines += [*_comment(field.comment, "  "), f"  {field.name}: {_type(field.type)};"]
    return [*lines, "}"]


def _constants(message: Message) -> Iterator[str]:
    if message.constants:
        yield f"export const {_short(message.name)} = {{"
        for constant in message.constants:
            wide = _SCALARS.get(constant.type.base) == "bigint"
            yield f"  {constant.name}: {json.dumps(constant.value)}{'n' if wide else ''},"
        yield "} as const;"


def _type(kind: FieldType) -> str:
    if kind.kind is not Kind.SINGLE and kind.base in _ARRAYS:
        return _ARRAYS[kind.base]
    single = _SCALARS.get(kind.base, "number") if kind.is_primitive else _short(kind.base)
    return single if kind.kind is Kind.SINGLE else f"{single}[]"


def _short(name: str) -> str:
    return name.split("/")[2]


def _comment(text: str, indent: str) -> list[str]:
    lines = [line.strip().replace("*/", "* /") for line in text.splitlines() if line.strip()]
    if len(lines) < 2:
        return [f"{indent}/** {line} */" for line in lines]
    return [f"{indent}/**", *(f"{indent} * {line}" for line in lines), f"{indent} */"]
