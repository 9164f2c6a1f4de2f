"""Write the Python package of an interface package: one module a definition, as rosidl lays them out.

Runs when the project is built, and when `colcon` builds a user's package; needs the standard library only.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from daidalos.interfaces.definition import (
    PRIMITIVES,
    Action,
    Field,
    FieldType,
    Interface,
    Kind,
    Literal,
    Message,
    Service,
    messages_of,
)
from daidalos.interfaces.description import Lookup, describe

_INTEGERS = PRIMITIVES - {"bool", "byte", "float32", "float64", "string", "wstring"}
_NUMBERS = _INTEGERS | {"float32", "float64"}
_EMPTY = {
    "bool": "False",
    "byte": "b'\\x00'",
    "float32": "0.0",
    "float64": "0.0",
    "string": "''",
    "wstring": "''",
}
_HINTS = {
    "bool": "bool",
    "byte": "bytes",
    "float32": "float",
    "float64": "float",
    "string": "str",
    "wstring": "str",
}


def write_package(package: str, interfaces: Iterable[Interface], lookup: Lookup, target: Path) -> list[Path]:
    """Write `target`/`package` with a module for each interface.

    Parameters
    ----------
    package
        The ROS package's name.
    interfaces
        Its definitions.
    lookup
        Finds the definitions of referenced types.
    target
        A folder on the import path.

    Returns
    -------
    list of Path
        The files of the package; those whose content did not change are left untouched.
    """
    folder = target / package
    written = [_write(folder / "__init__.py", f'"""Interfaces of the ROS package {package}."""\n')]
    by_kind: dict[str, list[Interface]] = {}
    for interface in interfaces:
        by_kind.setdefault(interface.name.split("/")[1], []).append(interface)
    for kind, members in by_kind.items():
        for member in members:
            module = module_name(_short(member.name))
            written.append(_write(folder / kind / f"{module}.py", module_source(member, lookup)))
        written.append(_write(folder / kind / "__init__.py", _init_source(package, kind, members)))
    written.append(_write(folder / "py.typed", ""))
    return written


def module_name(name: str) -> str:
    """Return the module of an interface as rosidl names it: ``TFMessage`` -> ``_tf_message``."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return "_" + re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


def module_source(interface: Interface, lookup: Lookup) -> str:
    """Return the text of the module that holds the interface's classes."""
    own = {message.name for message in messages_of(interface)}
    lines = [
        f'"""{interface.name}: generated from its definition; changes here are lost."""',
        "",
        "from __future__ import annotations",
        "",
        "from typing import Any",
        "",
        "from daidalos.interfaces import message as _m",
    ]
    lines += sorted({_import(base) for m in messages_of(interface) for base in m.nested() if base not in own})
    for message in messages_of(interface):
        lines += ["", "", *_message_source(message, lookup)]
    if isinstance(interface, Service):
        lines += ["", "", *_service_source(interface, lookup)]
    elif isinstance(interface, Action):
        for service in (interface.send_goal, interface.get_result):
            lines += ["", "", *_service_source(service, lookup)]
        lines += ["", "", *_action_source(interface, lookup)]
    return "\n".join(lines) + "\n"


def _write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def _init_source(package: str, kind: str, members: list[Interface]) -> str:
    """Return an `__init__` that imports each module when its class is first asked for."""
    modules = {}
    for member in members:
        for name in _exports(member):
            modules[name] = module_name(_short(member.name))
    lines = [
        f'"""The {kind} interfaces of {package}, imported when they are used."""',
        "",
        "from importlib import import_module as _import_module",
        "from typing import TYPE_CHECKING as _TYPE_CHECKING",
        "",
        "if _TYPE_CHECKING:",
        *(f"    from {package}.{kind}.{module} import {name} as {name}" for name, module in modules.items()),
        "",
        "_MODULES = {",
        *(f"    {name!r}: {module!r}," for name, module in modules.items()),
        "}",
        f"__all__ = {sorted(modules)!r}",
        "",
        "",
        "def __getattr__(name):",
        "    module = _MODULES.get(name)",
        "    if module is None:",
        "        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')",
        "    value = getattr(_import_module(f'{__name__}.{module}'), name)",
        "    globals()[name] = value",
        "    return value",
        "",
        "",
        "def __dir__():",
        "    return sorted({*globals(), *_MODULES})",
    ]
    return "\n".join(lines) + "\n"


def _exports(interface: Interface) -> Iterator[str]:
    """Yield the class names that ROS 2 offers in the package's `__init__`, and their parts."""
    yield _short(interface.name)
    if isinstance(interface, Message):
        return
    for message in interface.messages:
        yield _short(message.name)
    if isinstance(interface, Action):
        yield _short(interface.send_goal.name)
        yield _short(interface.get_result.name)


def _short(name: str) -> str:
    return name.rsplit("/", 1)[1]


def _import(base: str) -> str:
    package, kind, short = base.split("/")
    module = module_name(short if kind == "msg" else short.partition("_")[0])
    return f"from {package}.{kind}.{module} import {short} as {_alias(base)}"


def _alias(base: str) -> str:
    """Return the name of a nested class inside a module; two packages may both have a `Point`."""
    package, _, short = base.split("/")
    return f"{package}__{short}"


def _class_of(base: str, owner: Message) -> str:
    """Return how a module refers to the class `base`: by its plain name when it lives in the same module."""
    package, kind, short = base.split("/")
    same = owner.name.split("/")[:2] == [package, kind] and kind != "msg"
    if same and short.partition("_")[0] == _short(owner.name).partition("_")[0]:
        return short
    return _alias(base)


def _message_source(message: Message, lookup: Lookup) -> Iterator[str]:
    type_hash = describe(message, lookup).type_hash()
    message = replace(message, fields=tuple(_pythonic(field) for field in message.fields))
    short = _short(message.name)
    fields = message.fields
    yield f"class {short}(_m.Message):"
    yield from _docstring(message)
    yield ""
    yield f"    __slots__ = [{', '.join(repr('_' + f.name) for f in fields)}]"
    yield f"    _TYPE_NAME = {message.name!r}"
    yield f"    _TYPE_HASH = {type_hash!r}"
    yield "    _fields_and_field_types = {"
    for field in fields:
        yield f"        {field.name!r}: {field.type.idl()!r},"
    yield "    }"
    yield "    _FIELDS = ("
    for field in fields:
        yield f"        {_field_spec(field, message)},"
    yield "    )"
    for constant in message.constants:
        yield f"    {constant.name} = {_literal(constant.type, constant.value)}"
    for field in fields:
        if field.default is not None:
            yield f"    {field.name.upper()}__DEFAULT = {_default(field, message)}"
    yield ""
    yield from _init(message)
    for field in fields:
        yield ""
        yield from _property(field, message)
    frozen = [c.name for c in message.constants]
    frozen += [f"{f.name.upper()}__DEFAULT" for f in fields if f.default is not None]
    if frozen:
        yield ""
        yield ""
        yield f"{short}._frozen = frozenset({frozen!r})"


def _pythonic(field: Field) -> Field:
    """Return the field under a name that Python's grammar allows: `from` becomes `from_`."""
    return replace(field, name=f"{field.name}_") if keyword.iskeyword(field.name) else field


def _docstring(message: Message) -> Iterator[str]:
    text = message.comment.strip().replace("\\", "\\\\").replace('"""', "'''")
    summary = text or f"{message.name}."
    described = [field for field in message.fields if field.comment]
    if not described and "\n" not in summary:
        yield f'    """{summary}"""'
        return
    yield f'    """{summary.splitlines()[0]}'
    for line in summary.splitlines()[1:]:
        yield f"    {line}".rstrip()
    if described:
        yield ""
        yield "    Attributes"
        yield "    ----------"
        for field in described:
            yield f"    {field.name} : {field.type.idl()}"
            for line in field.comment.replace("\\", "\\\\").replace('"""', "'''").splitlines():
                yield f"        {line}".rstrip()
    yield '    """'


def _field_spec(field: Field, message: Message) -> str:
    kind = field.type
    base = repr(kind.base) if kind.is_primitive else _class_of(kind.base, message)
    return f"({field.name!r}, {base}, {kind.kind.value!r}, {kind.size}, {kind.string_bound})"


def _literal(kind: FieldType, value: object) -> str:
    if kind.base == "byte":
        return repr(bytes([int(value)]))  # type: ignore[call-overload]
    if kind.base in {"float32", "float64"} and value in (float("inf"), float("-inf")):
        return f"float({str(value)!r})"
    if isinstance(value, float) and value != value:
        return "float('nan')"
    return repr(value)


def _default(field: Field, message: Message) -> str:
    """Return the expression of a field's initial value."""
    kind, value = field.type, field.default
    if kind.kind is Kind.SINGLE:
        if not kind.is_primitive:
            return f"{_class_of(kind.base, message)}()"
        return _literal(kind, value) if value is not None else _EMPTY.get(kind.base, "0")
    if value is None:
        return _empty(kind, message)
    items = f"[{', '.join(_literal(kind, item) for item in _items(value))}]"
    if kind.base not in _NUMBERS:
        return items
    if kind.kind is Kind.ARRAY:
        return f"_m.check_array({field.name!r}, {items}, {kind.base!r}, {kind.size})"
    return f"_m.check_numbers({field.name!r}, {items}, {kind.base!r})"


def _items(value: Literal) -> list[object]:
    return list(value) if isinstance(value, list) else [value]


def _empty(kind: FieldType, message: Message) -> str:
    if kind.kind is not Kind.ARRAY:
        return f"_m.array({_typecode(kind.base)!r})" if kind.base in _NUMBERS else "[]"
    if kind.base in _NUMBERS:
        return f"_m.zeros({kind.base!r}, {kind.size})"
    if kind.is_primitive:
        return f"[{_EMPTY[kind.base]}] * {kind.size}"
    return f"[{_class_of(kind.base, message)}() for _ in range({kind.size})]"


def _typecode(base: str) -> str:
    from daidalos.interfaces.message import TYPECODES

    return TYPECODES[base]


def _hint(field: Field, message: Message) -> str:
    kind = field.type
    one = _HINTS.get(kind.base, "int") if kind.is_primitive else _class_of(kind.base, message)
    if kind.kind is Kind.SINGLE:
        return one
    return "Any" if kind.base in _NUMBERS else f"list[{one}]"


def _init(message: Message) -> Iterator[str]:
    parameters = []
    for field in message.fields:
        if field.type.kind is Kind.SINGLE and field.type.is_primitive:
            parameters.append(f"{field.name}: {_hint(field, message)} = {_default(field, message)}")
        else:
            parameters.append(f"{field.name}: {_hint(field, message)} | None = None")
    star = "*, " if parameters else ""
    yield f"    def __init__(self, {star}{''.join(p + ', ' for p in parameters)}**unknown: object) -> None:"
    yield "        if unknown:"
    yield "            _m.reject(self, unknown)"
    for field in message.fields:
        yield from _initial(field, message)


def _initial(field: Field, message: Message) -> Iterator[str]:
    name = field.name
    if field.type.kind is Kind.SINGLE and field.type.is_primitive:
        exact = {"float64": "float", "string": "str", "wstring": "str", "bool": "bool"}.get(field.type.base)
        if exact and field.type.string_bound is None:
            yield f"        if {name}.__class__ is {exact}:"
            yield f"            self._{name} = {name}"
            yield "        else:"
            yield f"            self.{name} = {name}"
        else:
            yield f"        self.{name} = {name}"
        return
    yield f"        if {name} is None:"
    yield f"            self._{name} = {_default(field, message)}"
    yield "        else:"
    yield f"            self.{name} = {name}"


def _property(field: Field, message: Message) -> Iterator[str]:
    name, hint = field.name, _hint(field, message)
    yield "    @property"
    yield f"    def {name}(self) -> {hint}:"
    yield f"        return self._{name}"
    yield ""
    yield f"    @{name}.setter"
    yield f"    def {name}(self, value: {hint}) -> None:"
    yield from (f"        {line}" for line in _setter(field, message))


def _setter(field: Field, message: Message) -> Iterator[str]:
    """Yield the setter's lines: the common right type costs one comparison, all else goes to a check."""
    name, kind = field.name, field.type
    if kind.kind is not Kind.SINGLE:
        yield f"self._{name} = {_check_many(field, message)}"
        return
    if kind.base == "float64":
        condition, check = "value.__class__ is not float", f"_m.check_float({name!r}, value, 'float64')"
    elif kind.base == "bool":
        condition, check = "value.__class__ is not bool", f"_m.check_bool({name!r}, value)"
    elif kind.base in {"string", "wstring"} and kind.string_bound is None:
        condition, check = "value.__class__ is not str", f"_m.check_string({name!r}, value)"
    elif not kind.is_primitive:
        one = _class_of(kind.base, message)
        condition, check = f"value.__class__ is not {one}", f"_m.check_message({name!r}, value, {one})"
    else:
        yield f"self._{name} = {_check_one(kind, name, 'value')}"
        return
    yield f"if {condition}:"
    yield f"    value = {check}"
    yield f"self._{name} = value"


def _check_one(kind: FieldType, name: str, value: str) -> str:
    if kind.base == "byte":
        return f"_m.check_byte({name!r}, {value})"
    if kind.base in {"float32", "float64"}:
        return f"_m.check_float({name!r}, {value}, {kind.base!r})"
    if kind.base in {"string", "wstring"}:
        return f"_m.check_string({name!r}, {value}, {kind.string_bound})"
    return f"_m.check_int({name!r}, {value}, {kind.base!r})"


def _check_many(field: Field, message: Message) -> str:
    name, kind = field.name, field.type
    if kind.base in _NUMBERS:
        if kind.kind is Kind.ARRAY:
            return f"_m.check_array({name!r}, value, {kind.base!r}, {kind.size})"
        return f"_m.check_numbers({name!r}, value, {kind.base!r}, {kind.size})"
    if kind.base == "bool":
        check = "_m.check_bool"
    elif kind.base == "byte":
        check = "_m.check_byte"
    elif kind.is_primitive:
        check = f"lambda n, v: _m.check_string(n, v, {kind.string_bound})" if kind.string_bound else "_m.check_string"
    else:
        check = f"lambda n, v: _m.check_message(n, v, {_class_of(kind.base, message)})"
    return f"_m.check_list({name!r}, value, {check}, {kind.kind.value!r}, {kind.size})"


def _service_source(service: Service, lookup: Lookup) -> Iterator[str]:
    short = _short(service.name)
    yield f"class {short}(_m.Service):"
    yield f'    """{service.name}: request, response and the event of its introspection."""'
    yield ""
    yield f"    _TYPE_NAME = {service.name!r}"
    yield f"    _TYPE_HASH = {describe(service, lookup).type_hash()!r}"
    yield f"    Request = {_short(service.request.name)}"
    yield f"    Response = {_short(service.response.name)}"
    yield f"    Event = {_short(service.event.name)}"


def _action_source(action: Action, lookup: Lookup) -> Iterator[str]:
    short = _short(action.name)
    yield "from action_msgs.msg._goal_status_array import GoalStatusArray as _GoalStatusArray  # noqa: E402"
    yield "from action_msgs.srv._cancel_goal import CancelGoal as _CancelGoal  # noqa: E402"
    yield ""
    yield ""
    yield f"class {short}(_m.Action):"
    yield f'    """{action.name}: goal, result, feedback and the interfaces built from them."""'
    yield ""
    yield f"    _TYPE_NAME = {action.name!r}"
    yield f"    _TYPE_HASH = {describe(action, lookup).type_hash()!r}"
    yield f"    Goal = {_short(action.goal.name)}"
    yield f"    Result = {_short(action.result.name)}"
    yield f"    Feedback = {_short(action.feedback.name)}"
    yield ""
    yield "    class Impl:"
    yield '        """The services and messages that carry the action."""'
    yield ""
    yield f"        SendGoalService = {_short(action.send_goal.name)}"
    yield f"        GetResultService = {_short(action.get_result.name)}"
    yield f"        FeedbackMessage = {_short(action.feedback_message.name)}"
    yield "        CancelGoalService = _CancelGoal"
    yield "        GoalStatusMessage = _GoalStatusArray"
