"""Interface files in IDL."""

import pytest
from lark.exceptions import UnexpectedInput
from rosidl_parser.definition import (
    Action,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    IdlLocator,
    Include,
    Message,
    NamespacedType,
    Service,
    UnboundedSequence,
)
from rosidl_parser.parser import parse_idl_file, parse_idl_string

TEXT = """
#include "geometry_msgs/msg/Point.idl"
// a comment
module pkg { module msg {
  typedef double double__9[9];
  module Thing_Constants {
    @verbatim (language="comment", text="how " "many")
    const unsigned long LIMIT = 0x10;
    const string WORD = "a \\"b\\"";
    const float HALF = -.5e0;
  };
  @verbatim (language="comment", text="A thing." "\\n")
  struct Thing {
    @default (value=TRUE) @unit (value="m")
    boolean on;
    string<5> name;
    sequence<geometry_msgs::msg::Point, 3> points;
    sequence<unsigned long long> counts;
    double__9 matrix;
    long a, b[2];
    /* over
       lines */
    @key
    octet raw;
  };
}; };
"""


def test_a_message():
    content = parse_idl_string(TEXT)
    (include,) = content.get_elements_of_type(Include)
    assert include.locator == "geometry_msgs/msg/Point.idl"
    (message,) = content.get_elements_of_type(Message)
    assert message.structure.namespaced_type == NamespacedType(["pkg", "msg"], "Thing")
    assert [(one.name, one.value) for one in message.constants] == [("LIMIT", 16), ("WORD", 'a "b"'), ("HALF", -0.5)]
    assert message.constants[0].get_comment_lines() == ["how many"]
    assert message.constants[1].type == BoundedString(5)
    types = {member.name: member.type for member in message.structure.members}
    assert types == {
        "on": BasicType("boolean"),
        "name": BoundedString(5),
        "points": BoundedSequence(NamespacedType(["geometry_msgs", "msg"], "Point"), 3),
        "counts": UnboundedSequence(BasicType("uint64")),
        "matrix": Array(BasicType("double"), 9),
        "a": BasicType("int32"),
        "b": Array(BasicType("int32"), 2),
        "raw": BasicType("octet"),
    }
    on, *_, raw = message.structure.members
    assert on.get_annotation_value("default") == {"value": True}
    assert raw.has_annotation("key")
    assert message.structure.has_any_member_with_annotation("unit")
    with pytest.raises(ValueError, match="No 'unit' annotation"):
        raw.get_annotation_value("unit")


def test_services_and_actions():
    def structs(*names):
        inner = "".join(f"struct {name} {{ long x; }};" for name in names)
        return parse_idl_string(f"module p {{ module m {{ {inner} }}; }};")

    (service,) = structs("A_Request", "A_Response").get_elements_of_type(Service)
    assert service.namespaced_type.name == "A"
    assert [one.name for one in service.event_message.structure.members] == ["info", "request", "response"]
    (action,) = structs("A_Goal", "A_Result", "A_Feedback").get_elements_of_type(Action)
    assert action.send_goal_service.request_message.structure.namespaced_type.name == "A_SendGoal_Request"
    assert action.feedback_message.structure.members[1].type.name == "A_Feedback"
    with pytest.raises(ValueError, match="found A_Request, B_Response"):
        structs("A_Request", "B_Response")


def test_faults_are_named(tmp_path):
    with pytest.raises(UnexpectedInput):
        parse_idl_string("module p { struct A { long }; };")
    (tmp_path / "A.idl").write_text("module p { struct A { nothing x; }; };")
    with pytest.raises(ValueError, match=r"A\.idl: the type 'nothing' is not known"):
        parse_idl_file(IdlLocator(tmp_path, "A.idl"))
