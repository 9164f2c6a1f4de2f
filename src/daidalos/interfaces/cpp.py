"""C++ structs of interface definitions, under the names and with the members of ROS 2's generated headers.

A header's only functions are constructors, setters and ``_visit``, by which `daidalos/cdr.hpp` encodes and decodes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator

from daidalos.interfaces.definition import (
    Action,
    Constant,
    Field,
    FieldType,
    Interface,
    Kind,
    Literal,
    Message,
    Service,
    messages_of,
)
from daidalos.interfaces.generator import module_name

_TYPES = {
    "bool": "bool", "byte": "unsigned char", "char": "unsigned char", "float32": "float", "float64": "double",
    "string": "std::string", "wstring": "std::u16string",
    **{f"{sign}int{n}": f"{sign}int{n}_t" for sign in ("", "u") for n in (8, 16, 32, 64)},
}  # fmt: skip
_EMPTY = Field(FieldType("uint8"), "structure_needs_at_least_one_member")


def header_name(name: str) -> str:
    """Return the header of ``pkg/msg/Name``, such as ``pkg/msg/name.hpp``, by rosidl's rule."""
    package, kind, short = name.split("/")
    return f"{package}/{kind}/{module_name(short)[1:]}.hpp"


def headers(interface: Interface) -> dict[str, str]:
    """Return the headers of an interface by their paths in the include folder.

    The parts of services and actions are in the header of the whole. Each file of rosidl's ``detail`` folder that
    programs name includes the whole, too.
    """
    path = header_name(interface.name)
    package, kind, file = path.split("/")
    stem = file.removesuffix(".hpp")
    details = (f"{package}/{kind}/detail/{stem}__{part}.hpp" for part in ("struct", "traits", "builder"))
    return {path: _header(interface)} | dict.fromkeys(details, f'#pragma once\n#include "{path}"\n')


def _header(interface: Interface) -> str:
    messages = [message for message in messages_of(interface) if not message.name.endswith("_Event")]
    local = {message.name for message in messages}
    nested = dict.fromkeys(name for message in messages for name in message.nested() if name not in local)
    package, kind, _ = interface.name.split("/")
    lines = [
        f"// Generated from {interface.name}.{kind}.",
        "#pragma once",
        *(
            f"#include <{name}>"
            for name in ("array", "cmath", "cstdint", "limits", "memory", "string", "utility", "vector")
        ),
        '#include "daidalos/cdr.hpp"',
        '#include "rosidl_runtime_cpp/message_initialization.hpp"',
        '#include "rosidl_runtime_cpp/traits.hpp"',
        *(f'#include "{header_name(name)}"' for name in nested),
        f"namespace {package}::{kind}",
        "{",
    ]
    for message in messages:
        lines += _struct(message)
    if isinstance(interface, Service):
        lines += _service(interface)
    elif isinstance(interface, Action):
        lines += [*_service(interface.send_goal), *_service(interface.get_result), *_action(interface)]
    lines.append(f"}}  // namespace {package}::{kind}")
    for message in messages:
        lines += _builder(message, package)
    return "\n".join(lines) + "\n"


def _short(name: str) -> str:
    return name.split("/")[2]


def _struct(message: Message) -> Iterator[str]:
    short = _short(message.name)
    yield f"struct {short}"
    yield "{"
    yield f'  static constexpr const char * _MESSAGE_NAME = "{message.name}";'
    yield from _pointers(short)
    for constant in message.constants:
        yield f"  {_constant(constant)}"
    yield f"  {short}() = default;"
    yield f"  explicit {short}(rosidl_runtime_cpp::MessageInitialization) {{}}"
    members = message.fields or (_EMPTY,)
    for field in members:
        yield f"  using _{field.name}_type = {_type(field.type)};"
        yield f"  _{field.name}_type {field.name}{_initializer(field)};"
    for field in message.fields:
        yield f"  {short} & set__{field.name}(const _{field.name}_type & _arg)"
        yield f"  {{this->{field.name} = _arg; return *this;}}"
    yield f"  bool operator==(const {short} & other) const"
    yield f"  {{return {' && '.join(f'{field.name} == other.{field.name}' for field in members)};}}"
    yield f"  bool operator!=(const {short} & other) const {{return !(*this == other);}}"
    yield "  template<typename Self, typename Visitor>"
    yield "  static void _visit(Self & self, Visitor && visitor)"
    visits = " ".join(f'visitor("{field.name}", self.{field.name});' for field in members)
    yield f"  {{{visits}}}"
    yield "};"


def _pointers(short: str) -> Iterator[str]:
    for const, prefix in (("", ""), ("const ", "Const")):
        yield f"  using {prefix}SharedPtr = std::shared_ptr<{const}{short}>;"
        yield f"  using {prefix}UniquePtr = std::unique_ptr<{const}{short}>;"
        yield f"  using {prefix}WeakPtr = std::weak_ptr<{const}{short}>;"


def _builder(message: Message, package: str) -> Iterator[str]:
    """Yield what makes ``pkg::build<pkg::msg::Name>().first(1).second(2)`` a message."""
    if not message.fields:
        return
    _, kind, short = message.name.split("/")
    whole = f"::{package}::{kind}::{short}"
    yield f"namespace {package}::{kind}::builder"
    yield "{"
    after = ""
    for field in reversed(message.fields):
        made = f"Init_{short}_{field.name}"
        result = after or whole
        value = f"{after}(std::move(msg_))" if after else "std::move(msg_)"
        first = field is message.fields[0]
        yield f"class {made}"
        yield "{"
        yield "public:"
        yield f"  {made}() = default;" if first else f"  explicit {made}({whole} msg) : msg_(std::move(msg)) {{}}"
        yield f"  {result} {field.name}({whole}::_{field.name}_type arg)"
        yield f"  {{msg_.{field.name} = std::move(arg); return {value};}}"
        yield "private:"
        yield f"  {whole} msg_;"
        yield "};"
        after = made
    yield f"}}  // namespace {package}::{kind}::builder"
    yield f"namespace {package}"
    yield "{"
    yield "template<typename T> auto build();"
    yield f"template<> inline auto build<{whole}>() {{return {package}::{kind}::builder::{after}();}}"
    yield f"}}  // namespace {package}"


def _service(service: Service) -> Iterator[str]:
    short = _short(service.name)
    yield f"struct {short}"
    yield "{"
    yield f'  static constexpr const char * _SERVICE_NAME = "{service.name}";'
    yield f"  using Request = {_short(service.request.name)};"
    yield f"  using Response = {_short(service.response.name)};"
    yield "};"


def _action(action: Action) -> Iterator[str]:
    short = _short(action.name)
    yield f"struct {short}"
    yield "{"
    yield f'  static constexpr const char * _ACTION_NAME = "{action.name}";'
    yield f"  using Goal = {_short(action.goal.name)};"
    yield f"  using Result = {_short(action.result.name)};"
    yield f"  using Feedback = {_short(action.feedback.name)};"
    yield "  struct Impl"
    yield "  {"
    yield f"    using SendGoalService = {_short(action.send_goal.name)};"
    yield f"    using GetResultService = {_short(action.get_result.name)};"
    yield f"    using FeedbackMessage = {_short(action.feedback_message.name)};"
    yield "  };"
    yield "};"


def _type(type_: FieldType) -> str:
    base = _TYPES.get(type_.base) or "::" + type_.base.replace("/", "::")
    match type_.kind:
        case Kind.ARRAY:
            return f"std::array<{base}, {type_.size}>"
        case Kind.BOUNDED:
            return f"rosidl_runtime_cpp::BoundedVector<{base}, {type_.size}>"
        case Kind.UNBOUNDED:
            return f"std::vector<{base}>"
    return base


def _initializer(field: Field) -> str:
    if field.default is None:
        if field.type.kind is Kind.SINGLE and field.type.base in ("string", "wstring"):
            return ""
        return "{}"
    if isinstance(field.default, list):
        values = ", ".join(_literal(field.type.base, value) for value in field.default)
        return f"{{{{{values}}}}}" if field.type.kind is Kind.ARRAY else f" = {{{values}}}"
    return f" = {_literal(field.type.base, field.default)}"


def _constant(constant: Constant) -> str:
    base, name = constant.type.base, constant.name
    value = _literal(base, constant.value)
    if base in ("string", "wstring"):
        return f"inline static const {_TYPES[base]} {name} = {value};"
    return f"static constexpr {_TYPES[base]} {name} = {value};"


def _literal(base: str, value: Literal) -> str:
    match base:
        case "bool":
            return "true" if value else "false"
        case "string":
            return _text(str(value))
        case "wstring":
            return "u" + json.dumps(str(value))
        case "float32" | "float64":
            return _float(float(value), base)  # type: ignore[arg-type]
        case "int64":
            # The lowest number cannot be written as one literal.
            return f"(-{2**63 - 1}LL - 1)" if value == -(2**63) else f"{value}LL"
        case "uint64":
            return f"{value}ULL"
    return f"(-{2**31 - 1} - 1)" if value == -(2**31) else f"{value}u" if base == "uint32" else str(value)


def _float(value: float, base: str) -> str:
    kind = _TYPES[base]
    if math.isfinite(value):
        return f"static_cast<float>({value!r})" if base == "float32" else repr(value)
    limit = f"std::numeric_limits<{kind}>::{'quiet_NaN' if math.isnan(value) else 'infinity'}()"
    return f"-{limit}" if value < 0 else limit


def _text(value: str) -> str:
    """Return a narrow literal, with each byte that is not plain ASCII as three octal digits."""
    plain = (chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}" for byte in value.encode())
    return f'"{"".join(plain)}"'


def all_headers(interfaces: Iterable[Interface]) -> dict[str, str]:
    """Return the headers of several interfaces by their paths in the include folder."""
    return {path: text for interface in interfaces for path, text in headers(interface).items()}
