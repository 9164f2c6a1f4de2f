"""Reading .msg, .srv and .action text."""

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.interfaces.definition import (
    INTEGER_RANGES,
    PRIMITIVES,
    Action,
    Constant,
    Field,
    FieldType,
    Kind,
    Message,
    Service,
)
from daidalos.interfaces.parser import InterfaceError, parse, parse_file


def message(text: str) -> Message:
    found = parse(text, "pkg", "msg", "Name", "pkg/msg/Name.msg")
    assert isinstance(found, Message)
    return found


def only_field(text: str) -> Field:
    (field,) = message(text).fields
    return field


def only_constant(text: str) -> Constant:
    (constant,) = message(text).constants
    return constant


# Types


@pytest.mark.parametrize("base", sorted(PRIMITIVES))
def test_primitive_types(base):
    assert only_field(f"{base} x").type == FieldType(base)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("int32[3]", FieldType("int32", Kind.ARRAY, 3)),
        ("int32[<=3]", FieldType("int32", Kind.BOUNDED, 3)),
        ("int32[]", FieldType("int32", Kind.UNBOUNDED)),
        ("string<=5", FieldType("string", string_bound=5)),
        ("wstring<=5[<=3]", FieldType("wstring", Kind.BOUNDED, 3, 5)),
        ("string<=5[2]", FieldType("string", Kind.ARRAY, 2, 5)),
        ("Point", FieldType("pkg/msg/Point")),
        ("other_pkg/Point[]", FieldType("other_pkg/msg/Point", Kind.UNBOUNDED)),
        ("other_pkg/msg/Point", FieldType("other_pkg/msg/Point")),
        ("Header", FieldType("std_msgs/msg/Header")),
    ],
)
def test_types(text, expected):
    assert only_field(f"{text} x").type == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("int32<=3 x", "only strings"),
        ("int32[0] x", "at least 1"),
        ("int32[<=] x", "at least 1"),
        ("int32[-1] x", "not a type"),
        ("int32[3][3] x", "not a type"),
        ("3d x", "not a type"),
        ("pkg/srv/deep/Point x", "not a type"),
        ("point x", "not a type"),
        ("time x", "builtin_interfaces/Time"),
        ("duration x", "builtin_interfaces/Duration"),
    ],
)
def test_bad_types(text, words):
    with pytest.raises(InterfaceError, match=words):
        message(text)


# Names


@pytest.mark.parametrize("name", ["x", "x1", "a_b", "a_1_b2"])
def test_field_names(name):
    assert only_field(f"int32 {name}").name == name


@pytest.mark.parametrize("name", ["X", "1x", "_x", "x_", "a__b", "a-b", "ä"])
def test_bad_field_names(name):
    with pytest.raises(InterfaceError, match="not a field name"):
        message(f"int32 {name}")


@pytest.mark.parametrize("name", ["x", "X_", "_X", "A__B", "1X", "aB"])
def test_bad_constant_names(name):
    with pytest.raises(InterfaceError, match="not a constant name"):
        message(f"int32 {name}=1")


@pytest.mark.parametrize("name", ["a" * 5000 + "-", "A" * 5000 + "-=1"])
def test_a_long_bad_name_is_refused_at_once(name):
    begin = time.thread_time()
    with pytest.raises(InterfaceError):
        message(f"int32 {name}")
    assert time.thread_time() - begin < 1.0


@pytest.mark.parametrize("name", ["lower", "With_Underscore", "3D", "", "Ünicode"])
def test_bad_interface_names(name):
    with pytest.raises(InterfaceError, match="CamelCase"):
        parse("", "pkg", "msg", name)


@pytest.mark.parametrize("text", ["int32 x\nint8 x", "int32 X=1\nint8 X=2"])
def test_a_name_can_be_used_once(text):
    with pytest.raises(InterfaceError, match=r"Name\.msg:2: '[xX]' is defined twice"):
        message(text)


# Constants and defaults


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("int32 A=5", 5),
        ("int32 A = -5", -5),
        ("int32 A=007", 7),
        ("uint8 A=0xff", 255),
        ("int8 A=0b11", 3),
        ("byte A=255", 255),
        ("char A=97", 97),
        ("bool A=true", True),
        ("bool A=0", False),
        ("float32 A=1.125", 1.125),
        ("float64 A=-1e-3", -1e-3),
        ("float64 A=inf", math.inf),
        ("string A=plain text", "plain text"),
        ("string A=  'padded '", "padded "),
        ('string A="say \\"hi\\""', 'say "hi"'),
        ("string A='a = b'", "a = b"),
        ("string A=''", ""),
        ("string A=/a_path", "/a_path"),
        ("wstring A='grün'", "grün"),
    ],
)
def test_constants(text, value):
    constant = only_constant(text)
    assert (constant.name, constant.value) == ("A", value)
    assert type(constant.value) is type(value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("int32 a 5", 5),
        ("float64 a 1", 1.0),
        ("bool a False", False),
        ('string a "x = y"', "x = y"),
        (r"string a 'it\'s'", "it's"),
        (r'string a "C:\dir\\n\n"', "C:\\dir\\n\n"),
        ("int32[2] a [1, -2]", [1, -2]),
        ("int32[] a []", []),
        ("bool[<=3] a [true, false]", [True, False]),
        ("float32[2] a [1.5,2]", [1.5, 2.0]),
        ("string[] a ['a, b', \"c] d\", e]", ["a, b", "c] d", "e"]),
        ('string[3] a ["", "max value", "min value"]', ["", "max value", "min value"]),
    ],
)
def test_defaults(text, value):
    assert only_field(text).default == value


def test_no_default():
    assert only_field("int32 a").default is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("int32 A=", "not a valid int32"),
        ("int32 A=1.5", "not a valid int32"),
        ("int32 A=x", "not a valid int32"),
        ("float64 A=x", "not a valid float64"),
        ("bool A=yes", "true or false"),
        ("uint8 A=256", r"out of range for uint8 \(0 to 255\)"),
        ("uint8 A=-1", "out of range"),
        ("float32 A=1e39", "out of range for float32"),
        ("string A='open", "not closed"),
        ("string A='it''s'", "needs a backslash"),
        ("string<=2 A='abc'", "longer than its bound 2"),
        ("int32[2] A=1", "primitive type"),
        ("Point A=1", "primitive type"),
        ("Point a 1", "takes no default"),
        ("int32[2] a 1", "in brackets"),
        ("int32[2] a [1]", "1 values, the array 2"),
        ("int32[<=2] a [1, 2, 3]", "3 values, the bound is 2"),
        ("int32[] a [1, x]", "not a valid int32"),
        ("int32", "no name"),
    ],
)
def test_bad_values(text, words):
    with pytest.raises(InterfaceError, match=words):
        message(text)


@given(st.sampled_from(sorted(INTEGER_RANGES)), st.integers(-(2**65), 2**65))
def test_integers_are_taken_within_their_range_only(base, value):
    low, high = INTEGER_RANGES[base]
    if low <= value <= high:
        assert only_constant(f"{base} A={value}").value == value
        assert only_field(f"{base} a {value}").default == value
    else:
        with pytest.raises(InterfaceError, match="out of range"):
            message(f"{base} A={value}")


@given(st.floats(allow_nan=False, width=64))
def test_numbers_come_back(value):
    assert only_constant(f"float64 A={value!r}").value == value


@given(st.text(st.characters(exclude_categories=("C", "Zl", "Zp")), max_size=40), st.sampled_from("'\""))
def test_quoted_strings_come_back_whatever_is_in_them(text, quote):
    escaped = text.replace("\\", "\\\\").replace(quote, f"\\{quote}")
    assert only_constant(f"string A={quote}{escaped}{quote}  # a # comment").value == text
    assert only_field(f"string a {quote}{escaped}{quote}").default == text


@given(st.lists(st.integers(0, 255), max_size=20))
def test_arrays_come_back(values):
    assert only_field(f"uint8[] a {values}").default == values


# Comments


def test_the_first_comment_is_that_of_the_message():
    found = message("# What it is.\n# In two lines.\n\n# Of x.\nint32 x  # m\nint32 y\n")
    assert found.comment == "What it is.\nIn two lines."
    assert [field.comment for field in found.fields] == ["Of x.\nm", ""]


@pytest.mark.parametrize(
    ("line", "value", "comment"),
    [
        ("string A='a # b'  # c # d", "a # b", "c # d"),
        ('string A="a \\" # b"  # c', 'a " # b', "c"),
        (r"string A='# \\'  # c", "# \\", "c"),
        ("string A=don't  # it's text", "don't", "it's text"),
        ("string A=plain# no space", "plain", "no space"),
    ],
)
def test_comments_after_strings(line, value, comment):
    constant = only_constant(line)
    assert (constant.value, constant.comment) == (value, comment)


def test_an_apostrophe_in_a_comment_is_no_quote():
    assert only_field("int32 x  # the robot's, isn't it").comment == "the robot's, isn't it"


@pytest.mark.parametrize("text", ["int32\tx", "int32 \t x\t", "  int32   x  ", "int32 x\r\n", "\tint32\tx\t# c"])
def test_white_space_does_not_matter(text):
    assert only_field(text).name == "x"


def test_tabs_around_values():
    assert only_constant("int32\tA\t=\t5").value == 5
    assert only_field("int32\ta\t5").default == 5


@pytest.mark.parametrize("text", ["", "\n\n", "# only a comment"])
def test_a_message_may_be_empty(text):
    assert message(text).fields == ()


# Services and actions


def test_service():
    found = parse("# Adds.\n\nint64 a\nint64 b\n---\nint64 sum", "pkg", "srv", "Add")
    assert isinstance(found, Service)
    assert found.name == "pkg/srv/Add"
    assert [m.name for m in found.messages] == [
        "pkg/srv/Add_Request",
        "pkg/srv/Add_Response",
        "pkg/srv/Add_Event",
    ]
    assert [f.name for f in found.request.fields] == ["a", "b"]
    assert [f.name for f in found.response.fields] == ["sum"]
    assert found.event.fields[1].type == FieldType("pkg/srv/Add_Request", Kind.BOUNDED, 1)


def test_action():
    found = parse("int32 order\n---\nint32[] sequence\n---\n", "pkg", "action", "Fib")
    assert isinstance(found, Action)
    assert [m.name for m in (found.goal, found.result, found.feedback)] == [
        "pkg/action/Fib_Goal",
        "pkg/action/Fib_Result",
        "pkg/action/Fib_Feedback",
    ]
    assert found.send_goal.request.fields[1].type.base == "pkg/action/Fib_Goal"
    assert found.get_result.response.fields[1].type.base == "pkg/action/Fib_Result"
    assert found.feedback_message.fields[1].type.base == "pkg/action/Fib_Feedback"
    assert len(found.messages) == 10


@pytest.mark.parametrize(
    ("kind", "text", "words"),
    [
        ("srv", "int32 a", "has 2 parts separated by '---', this one 1"),
        ("srv", "---\n---", "has 2 parts separated by '---', this one 3"),
        ("action", "---", "has 3 parts separated by '---', this one 2"),
    ],
)
def test_number_of_parts(kind, text, words):
    with pytest.raises(InterfaceError, match=words):
        parse(text, "pkg", kind, "Name")


def test_lines_are_counted_through_all_parts():
    with pytest.raises(InterfaceError, match=r"^f\.action:6: 'BAD' is not a field name"):
        parse("int32 a\n---\n# b\nint32 b\n---\nint32 BAD", "pkg", "action", "Name", "f.action")


# Files


def test_parse_file(tmp_path):
    path = tmp_path / "Point.msg"
    path.write_bytes("\ufeff# A point.\r\n\r\nfloat64 x\r\nfloat64 y\r\n".encode())
    found = parse_file(path, "my_pkg")
    assert isinstance(found, Message)
    assert found.name == "my_pkg/msg/Point"
    assert found.comment == "A point."
    assert [field.name for field in found.fields] == ["x", "y"]


def test_errors_name_file_and_line(tmp_path):
    path = tmp_path / "Point.msg"
    path.write_text("float64 x\n\nflot64 y\n")
    with pytest.raises(InterfaceError) as caught:
        parse_file(path, "my_pkg")
    assert str(caught.value).startswith(f"{path}:3: 'flot64' is not a type")
    assert "\n" not in str(caught.value)


def test_files_of_other_kinds_are_refused(tmp_path):
    with pytest.raises(InterfaceError, match=r"expected a \.msg, \.srv or \.action file"):
        parse_file(tmp_path / "Point.idl", "my_pkg")


def test_a_file_that_is_no_text_is_refused(tmp_path):
    path = tmp_path / "Point.msg"
    path.write_bytes(b"float64 x # \xff\xfe")
    with pytest.raises(InterfaceError, match="byte 12 is not valid UTF-8"):
        parse_file(path, "my_pkg")


@given(st.text(st.sampled_from("aZ_1 =#'\"[]<>/-.,\\\n\tint32string"), max_size=60))
def test_any_text_gives_a_message_or_a_clear_error(text):
    try:
        message(text)
    except InterfaceError as error:
        reason = str(error)
    else:
        reason = "pkg/msg/Name.msg"
    assert reason.startswith("pkg/msg/Name.msg")
