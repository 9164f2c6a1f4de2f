"""Definitions in .msg, .srv and .action files."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosidl_adapter.parser import (
    BaseType,
    Field,
    InvalidActionSpecification,
    InvalidFieldDefinition,
    InvalidResourceName,
    InvalidServiceSpecification,
    InvalidValue,
    Type,
    UnknownMessageType,
    parse_action_string,
    parse_message_file,
    parse_message_string,
    parse_service_string,
    validate_field_types,
)

TEXT = """# A thing.

# How many [1]
int32 LIMIT=5
string WORD='a=b'
bool on true  # whether it is on
   # or off
float64[<=3] numbers [1.0, 2]
string<=5[] names ["a,b", 'c', d]
Other other
geometry_msgs/Point[2] points
string text "x=y"
"""


def test_a_message():
    message = parse_message_string("pkg", "Thing", TEXT)
    assert [(one.name, one.value) for one in message.constants] == [("LIMIT", 5), ("WORD", "a=b")]
    assert {one.name: (str(one.type), one.default_value) for one in message.fields} == {
        "on": ("bool", True),
        "numbers": ("float64[<=3]", [1.0, 2.0]),
        "names": ("string<=5[]", ["a,b", "c", "d"]),
        "other": ("pkg/Other", None),
        "points": ("geometry_msgs/Point[2]", None),
        "text": ("string", "x=y"),
    }
    assert message.annotations["comment"] == ["A thing."]
    assert message.constants[0].annotations == {"comment": ["How many"], "unit": "1"}
    assert message.fields[0].annotations["comment"] == ["whether it is on", "or off"]
    with pytest.raises(UnknownMessageType, match="geometry_msgs/Point"):
        validate_field_types(message, [BaseType("pkg/Other")])


def test_what_is_written_is_read_again(tmp_path):
    message = parse_message_string("pkg", "Thing", "int8 A=1\nstring<=4 a 'x'\nint8[3] b [1, 2, 3]\n")
    (tmp_path / "Thing.msg").write_text(str(message))
    assert parse_message_file("pkg", str(tmp_path / "Thing.msg")) == message


@given(st.integers(-(2**31), 2**31 - 1), st.floats(allow_nan=False), st.booleans())
def test_default_values(whole, number, switch):
    text = f"int32 a {whole}\nfloat64 b {number!r}\nbool c {switch}"
    assert [one.default_value for one in parse_message_string("pkg", "A", text).fields] == [whole, number, switch]


def test_services_and_actions():
    service = parse_service_string("pkg", "Do", "bool a\n---\nbool b")
    assert (service.request.msg_name, service.response.fields[0].name) == ("Do_Request", "b")
    assert parse_action_string("pkg", "Go", "---\n---\nint8 done").feedback.fields[0].name == "done"
    with pytest.raises(InvalidServiceSpecification):
        parse_service_string("pkg", "Do", "bool a")
    with pytest.raises(InvalidActionSpecification):
        parse_action_string("pkg", "Go", "---")


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("int32", InvalidFieldDefinition),
        ("int32 Upper", NameError),
        ("int32 lower=1", NameError),
        ("uint8 a 256", InvalidValue),
        ("int8[2] a [1]", InvalidValue),
        ("string<=0 a", TypeError),
        ("int8[x] a", TypeError),
        ("Pkg/Thing a", InvalidResourceName),
        ("bool a\nbool a", ValueError),
    ],
)
def test_faults(line, error):
    with pytest.raises(error):
        parse_message_string("pkg", "Thing", line)


def test_types():
    assert Type("int8[3]").is_fixed_size_array()
    assert Type("int8[<=3]").is_dynamic_array()
    assert Type("int8[]") == Type("int8[]") != Type("int8")
    with pytest.raises(TypeError, match="'Type' instance"):
        Field("int8", "a")
