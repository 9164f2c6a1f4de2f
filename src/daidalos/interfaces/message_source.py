"""Source text of a message class: its fields as properties with checked setters."""

from __future__ import annotations

import keyword
from collections.abc import Iterator
from dataclasses import replace

from daidalos.interfaces.definition import PRIMITIVES, Field, FieldType, Kind, Literal, Message
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


def message_source(message: Message, lookup: Lookup) -> Iterator[str]:
    """Yield the lines of a message class; its module imports nested classes of other modules by their `alias`."""
    type_hash = describe(message, lookup).type_hash()
    message = replace(message, fields=tuple(_pythonic(field) for field in message.fields))
    short = short_name(message.name)
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
    """Return the field with a valid Python name: `from` becomes `from_`."""
    return replace(field, name=f"{field.name}_") if keyword.iskeyword(field.name) else field


def _builtin(name: str, message: Message) -> str:
    """Return the expression of something built into Python, also where a field of the message has its name."""
    return f"_m.builtins.{name}" if any(field.name == name for field in message.fields) else name


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
        return f"{'-' if value == float('-inf') else ''}_m.math.inf"
    if isinstance(value, float) and value != value:
        return "_m.math.nan"
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
    return f"[{_class_of(kind.base, message)}() for _ in {_builtin('range', message)}({kind.size})]"


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
    yield f"    def __init__(self, {star}{''.join(p + ', ' for p in parameters)}**_unknown: object) -> None:"
    yield "        if _unknown:"
    yield "            _m.reject(self, _unknown)"
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
    yield f"    @{_builtin('property', message)}"
    yield f"    def {name}(self) -> {hint}:"
    yield f"        return self._{name}"
    yield ""
    yield f"    @{name}.setter"
    yield f"    def {name}(self, value: {hint}) -> None:"
    yield from (f"        {line}" for line in _setter(field, message))


def _setter(field: Field, message: Message) -> Iterator[str]:
    """Yield the lines of a setter; the correct type costs one comparison, everything else calls a check."""
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


def short_name(name: str) -> str:
    """Return the last part of an interface's name."""
    return name.rsplit("/", 1)[1]


def alias(base: str) -> str:
    """Return the name of a nested class inside a module; two packages may both have a `Point`."""
    package, _, short = base.split("/")
    return f"{package}__{short}"


def _class_of(base: str, owner: Message) -> str:
    """Return the expression by which a module refers to the class `base`."""
    package, kind, short = base.split("/")
    same = owner.name.split("/")[:2] == [package, kind] and kind != "msg"
    if same and short.partition("_")[0] == short_name(owner.name).partition("_")[0]:
        return short
    return alias(base)
