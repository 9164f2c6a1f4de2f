"""Interfaces in OMG IDL: every built-in one survives the way through it."""

import json
import re

import pytest

from daidalos.interfaces.definition import Kind, messages_of
from daidalos.interfaces.idl import read_idl
from daidalos.interfaces.library import Library
from daidalos.interfaces.parser import InterfaceError, parse

POINT = """
// generated from rosidl_adapter/resource/msg.idl.em
#include "std_msgs/msg/Header.idl"

module shapes {
  module msg {
    typedef double double__3[3];
    typedef std_msgs::msg::Header std_msgs__msg__Header__2[2];
    module Point_Constants {
      @verbatim (language="comment", text="Of both kinds.")
      const uint8 KIND = 3;
      const string NAME = "a \\"b\\"";
      const boolean TRUTH = TRUE;
    };
    @verbatim (language="comment", text=
      "A point" "\\n"
      "in space.")
    struct Point {
      std_msgs__msg__Header__2 headers;
      @unit (value="m") @default (value=1.5)
      double x;
      sequence<float> values;
      @default (value="(1, 2)")
      sequence<long long, 5> some;
      string<10> name;
      /* of
         three */ double__3 y;
      unsigned long long count;
    };
  };
};
"""
POINT_MSG = """\
# A point
# in space.

# Of both kinds.
uint8 KIND=3
string NAME="a \\"b\\""
bool TRUTH=true
std_msgs/Header[2] headers
float64 x 1.5
float32[] values
int64[<=5] some [1, 2]
string<=10 name
float64[3] y
uint64 count
"""


def test_text():
    found = read_idl(POINT, "Point")
    assert found == ("shapes", "msg", "Point", POINT_MSG)
    parse(found.text, "shapes", "msg", "Point")


PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
# How rosidl_adapter spells the types of .msg files.
SPELT = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}


def to_idl(interface):
    """Write an interface as rosidl_adapter does, without its comments."""
    package, kind, _ = interface.name.split("/")
    lines = [f"module {package} {{ module {kind} {{"]
    # The others, such as a service's event, follow from these.
    written = {f"{interface.name}{part}" for part in PARTS[kind]}
    messages = [one for one in messages_of(interface) if one.name in written]
    for message in messages:
        name = message.name.rpartition("/")[2]
        members = []
        for field in message.fields:
            base = SPELT.get(field.type.base, field.type.base).replace("/", "::")
            base += f"<{field.type.string_bound}>" if field.type.string_bound is not None else ""
            if field.type.kind is Kind.ARRAY:
                alias = f"{re.sub(r'[^a-z0-9]', '_', base, flags=re.IGNORECASE)}__{field.type.size}"
                lines.append(f"typedef {base} {alias}[{field.type.size}];")
                base = alias
            elif field.type.kind is not Kind.SINGLE:
                bound = f", {field.type.size}" if field.type.kind is Kind.BOUNDED else ""
                base = f"sequence<{base}{bound}>"
            default = "" if field.default is None else f"@default (value={value_of(field.default)}) "
            members.append(f"{default}{base} {field.name};")
        constants = [
            f"const {SPELT.get(one.type.base, one.type.base)} {one.name} = {value_of(one.value)};"
            for one in message.constants
        ]
        if constants:
            lines += [f"module {name}_Constants {{", *constants, "};"]
        members = members or ["uint8 structure_needs_at_least_one_member;"]
        lines += [f"struct {name} {{", *members, "};"]
    return "\n".join([*lines, "}; };"])


def value_of(value):
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, list):
        return json.dumps(str(tuple(value)))
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def shape(interface):
    def spelt(type_):
        return type_.idl().replace("char", "uint8")

    return [
        (
            message.name,
            [(field.name, spelt(field.type), field.default) for field in message.fields],
            [(one.name, spelt(one.type), one.value) for one in message.constants],
        )
        for message in messages_of(interface)
    ]


def test_all_that_is_built_in_survives():
    library = Library()
    names = [name for package in library.packages() for name in library.names(package)]
    assert len(names) > 200
    for name in names:
        interface = library.get(name)
        found = read_idl(to_idl(interface), name.rpartition("/")[2], name)
        assert "/".join(found[:3]) == name
        assert shape(parse(found.text, found.package, found.kind, found.name)) == shape(interface), name


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("struct Point", "struct Dot", "x.idl: there is no struct 'Point' in a module 'msg'"),
        ("double x", "quad x", "x.idl:21: the type 'quad' is not known"),
        ("struct Point", "enum Point", "x.idl:18: expected 'module' or 'struct' or 'typedef' or 'const', found 'enum'"),
        ("double x;", "double x", "x.idl:22: expected ';', found 'sequence'"),
        ("long long, 5>", "long long, 5", "x.idl:24: expected '>', found 'some'"),
        ("double x;", "double x; $", "x.idl:21: unexpected '$'"),
        ("std_msgs::msg::Header std", "std_msgs::Header std", "x.idl:8: the type 'std_msgs::Header' is not known"),
    ],
)
def test_what_is_no_part_of_the_subset(old, new, fault):
    with pytest.raises(InterfaceError) as told:
        read_idl(POINT.replace(old, new), "Point", "x.idl")
    assert str(told.value).startswith(fault)


def test_the_end_comes_too_early():
    with pytest.raises(InterfaceError, match=r"x\.idl:\d+: expected .*, found 'the end of the file'"):
        read_idl(POINT[: POINT.index("};")], "Point", "x.idl")
