"""Parameters: declaring, setting, describing, files, and those of other nodes."""

import array
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rclpy.context import Context
from rclpy.exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
)
from rclpy.node import Node
from rclpy.parameter import (
    Parameter,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)
from rclpy.parameter_client import AsyncParameterClient

from ros.rclpy.waiting import executor_of, run_ready

FILE = """
/**:
  ros__parameters: {everywhere: 1, which: wildcard}
/ns/robot:
  ros__parameters: {which: full name, deep: {er: [1, 2]}}
robot:
  ros__parameters: {elsewhere: true}
other:
  ros__parameters: {which: not ours}
"""


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (None, "NOT_SET"),
        (True, "BOOL"),
        (42, "INTEGER"),
        (2.41, "DOUBLE"),
        ("text", "STRING"),
        ([b"a", b"b"], "BYTE_ARRAY"),
        ([True, False], "BOOL_ARRAY"),
        ([1, 2], "INTEGER_ARRAY"),
        ((1, 2), "INTEGER_ARRAY"),
        (array.array("q", [1, 2]), "INTEGER_ARRAY"),
        ([1.5, 2.5], "DOUBLE_ARRAY"),
        (["a", "b"], "STRING_ARRAY"),
    ],
)
def test_values_have_types_and_survive_messages(value: Any, kind: str) -> None:
    parameter = Parameter("name", value=value)
    assert parameter.type_.name == kind
    back = Parameter.from_parameter_msg(parameter.to_parameter_msg())
    assert back.type_ == parameter.type_
    assert (list(back.value) if isinstance(value, (list, tuple, array.array)) else back.value) == (
        list(value) if isinstance(value, (list, tuple, array.array)) else value
    )


def test_types_and_values_must_agree() -> None:
    with pytest.raises(ValueError, match="agree"):
        Parameter("name", Parameter.Type.BOOL_ARRAY, 42)
    with pytest.raises(TypeError, match="type must be"):
        Parameter("name", "INTEGER", 42)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="allowed types"):
        Parameter("name", value={"a": 1})
    with pytest.raises(RuntimeError, match="42"):
        parameter_value_to_python(ParameterValue(type=42))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("True", True),
        ("42", 42),
        ("3.5", 3.5),
        ("foo", "foo"),
        (" ", " "),
        ("", ""),
        ("[1, 2]", [1, 2]),
        ("a: b", "a: b"),
    ],
)
def test_text_means_what_yaml_says(text: str, value: Any) -> None:
    assert parameter_value_to_python(get_parameter_value(text)) == value


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "parameters.yaml"
    path.write_text(FILE)
    return path


def test_initial_values_come_from_files_arguments_and_code(graph: Context, file: Path) -> None:
    arguments = ["--ros-args", "--params-file", str(file), "-p", "everywhere:=2", "-p", "other:speed:=9"]
    node = Node("robot", namespace="ns", cli_args=arguments, parameter_overrides=[Parameter("coded", value="code")])
    declared = {name: node.declare_parameter(name, initial).value for name, initial in (
        ("everywhere", 0), ("which", ""), ("elsewhere", False), ("coded", ""), ("speed", 0), ("deep.er", [0]),
    )}  # fmt: skip
    assert declared == {
        "everywhere": 2, "which": "full name", "elsewhere": False, "coded": "code", "speed": 0, "deep.er": [1, 2],
    }  # fmt: skip
    assert {name: one.value for name, one in node.get_parameters_by_prefix("deep").items()} == {"er": [1, 2]}
    node.destroy_node()


ORDERED = """
/**/robot:
  ros__parameters: {first: 1, last: 1}
/ns/robot:
  ros__parameters: {second: 2, last: 2}
/**/robot:
  ros__parameters: {third: 3}
/*:
  robot:
    ros__parameters: {last: 4}
"""


def test_of_what_a_file_says_of_a_node_the_last_counts(graph: Context, tmp_path: Path) -> None:
    path = tmp_path / "ordered.yaml"
    path.write_text(ORDERED)
    node = Node(
        "robot", namespace="/ns", cli_args=["--ros-args", "--params-file", str(path)],
        automatically_declare_parameters_from_overrides=True,
    )  # fmt: skip
    values = {name: node.get_parameter(name).value for name in ("first", "second", "third", "last")}
    assert values == {"first": 1, "second": 2, "third": 3, "last": 4}
    node.destroy_node()


def test_a_name_alone_is_warned_of_and_what_stands_without_its_namespace_serves(graph: Context) -> None:
    node = Node("robot", parameter_overrides=[Parameter("kp", value=2.0), Parameter("left.kp", value=3.0)])
    with pytest.warns(UserWarning, match="'bare' is declared by its name alone"):
        assert node.declare_parameter("bare").value is None
    assert [one.value for one in node.declare_parameters("left", [("kp", 0.0)])] == [3.0]
    assert [one.value for one in node.declare_parameters("right", [("kp", 0.0)])] == [2.0]
    refused = node.set_parameters([Parameter("left.kp", value="text")])[0]
    assert refused.reason.startswith("Wrong parameter type, expected 'Type.DOUBLE' got 'Type.STRING'")
    node.destroy_node()


def test_files_can_be_read_for_some_nodes(file: Path) -> None:
    found = parameter_dict_from_yaml_file(str(file), True, ["/ns/robot"], "prefix")
    values = {name.removeprefix("prefix."): parameter_value_to_python(one.value) for name, one in found.items()}
    assert (values["everywhere"], values["which"], values["deep.er"]) == (1, "full name", [1, 2])
    with pytest.raises(RuntimeError, match="/nobody"):
        parameter_dict_from_yaml_file(str(file), False, ["/nobody"])
    assert parameter_dict_from_yaml_file(str(file), False, ["other"]).keys() == {"which"}
    with pytest.raises(FileNotFoundError, match="missing"):
        parameter_dict_from_yaml_file("missing.yaml")


def test_overrides_can_declare_themselves(graph: Context) -> None:
    node = Node(
        "tested",
        parameter_overrides=[Parameter("a.b", value=1)],
        automatically_declare_parameters_from_overrides=True,
    )
    assert node.get_parameter("a.b").value == 1
    node.destroy_node()


def test_declaring_needs_sense(node: Node) -> None:
    node.declare_parameter("taken", 1)
    wrong: list[tuple[Any, type[Exception]]] = [
        (("taken", 2), ParameterAlreadyDeclaredException),
        (("", 2), InvalidParameterException),
        ((1, 2), TypeError),
        (("unset", ParameterValue(), ParameterDescriptor()), ValueError),
        (("described", 1, ParameterValue()), TypeError),
        (("untyped", None, ParameterDescriptor()), ValueError),
        (("no type", Parameter.Type.NOT_SET), ValueError),
    ]
    for arguments, error in wrong:
        with pytest.raises(error):
            node.declare_parameter(*arguments)
    with pytest.raises(TypeError, match="tuple length"):
        node.declare_parameters("", [()])
    assert not node.has_parameter("described")


def test_a_value_decides_on_its_type(node: Node) -> None:
    node.declare_parameter("count", 10, ParameterDescriptor(type=ParameterType.PARAMETER_DOUBLE))
    assert node.describe_parameter("count").type == ParameterType.PARAMETER_INTEGER
    node.declare_parameter("message", ParameterValue(type=2, integer_value=4))
    assert node.get_parameter("message").value == 4
    assert not node.set_parameters([Parameter("count", value="ten")])[0].successful
    node.declare_parameter("loose", 1, ParameterDescriptor(dynamic_typing=True))
    assert node.set_parameters([Parameter("loose", value="one")])[0].successful


def test_overrides_of_another_type_are_refused(graph: Context) -> None:
    node = Node("tested", parameter_overrides=[Parameter("count", value="ten")])
    with pytest.raises(InvalidParameterTypeException, match="count"):
        node.declare_parameter("count", 10)
    assert node.declare_parameter("count", 10, ignore_override=True).value == 10
    node.destroy_node()


def test_undeclared_parameters(graph: Context, node: Node) -> None:
    with pytest.raises(ParameterNotDeclaredException):
        node.get_parameter("missing")
    with pytest.raises(ParameterNotDeclaredException):
        node.set_parameters([Parameter("missing", value=1)])
    with pytest.raises(ParameterNotDeclaredException):
        node.undeclare_parameter("missing")
    assert node.get_parameter_or("missing", Parameter("instead", value=1)).value == 1
    free = Node("free", allow_undeclared_parameters=True)
    assert free.get_parameter("missing").type_ == Parameter.Type.NOT_SET
    assert free.set_parameters([Parameter("missing", value=1)])[0].successful
    assert free.get_parameter("missing").value == 1
    assert free.describe_parameter("other") == ParameterDescriptor()


@pytest.mark.parametrize(
    ("value", "successful"), [(0, True), (10, True), (4, True), (12, False), (5, False), (-2, False)]
)
def test_integer_ranges(node: Node, value: int, successful: bool) -> None:
    limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=2)])
    node.declare_parameter("count", 4, limits)
    assert node.set_parameters([Parameter("count", value=value)])[0].successful is successful
    assert node.get_parameter("count").value == (value if successful else 4)


@pytest.mark.parametrize(
    ("value", "successful"), [(0.0, True), (10.0, True), (4.5, True), (12.0, False), (4.25, False), (1e-9, True)]
)
def test_floating_point_ranges(node: Node, value: float, successful: bool) -> None:
    limits = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=10.0, step=0.5)])
    node.declare_parameter("length", 4.5, limits)
    result = node.set_parameters([Parameter("length", value=value)])[0]
    assert result.successful is successful or value == 1e-9


def test_a_value_out_of_its_range_is_not_declared(node: Node) -> None:
    limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=1, step=1)])
    with pytest.raises(InvalidParameterValueException, match="out of range"):
        node.declare_parameters("", [("good", 1, limits), ("bad", 7, limits)])
    assert node.has_parameter("good")
    assert not node.has_parameter("bad")


def test_what_is_read_only_stays(node: Node) -> None:
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    node.declare_parameter("free", 1)
    assert [
        one.successful for one in node.set_parameters([Parameter("fixed", value=2), Parameter("free", value=2)])
    ] == [
        False,
        True,
    ]
    assert not node.set_parameters_atomically([Parameter("free", value=3), Parameter("fixed", value=3)]).successful
    assert (node.get_parameter("fixed").value, node.get_parameter("free").value) == (1, 2)
    with pytest.raises(ParameterImmutableException):
        node.undeclare_parameter("fixed")
    with pytest.raises(ParameterImmutableException):
        node.set_descriptor("fixed", ParameterDescriptor())
    assert node.set_descriptor("free", ParameterDescriptor(name="ignored", description="x")).integer_value == 2
    assert node.describe_parameter("free").name == "free"


def test_callbacks_may_change_refuse_and_follow(node: Node) -> None:
    node.declare_parameter("a", 0)
    node.declare_parameter("double_a", 0)
    log: list[Any] = []

    def prepare(parameters: list[Parameter[Any]]) -> list[Parameter[Any]]:
        doubled = [Parameter("double_a", value=2 * one.value) for one in parameters if one.name == "a"]
        return [*parameters, *doubled]

    def check(parameters: list[Parameter[Any]]) -> SetParametersResult:
        return SetParametersResult(successful=all(one.value < 10 for one in parameters), reason="too much")

    def follow(parameters: list[Parameter[Any]]) -> None:
        log.append([(one.name, one.value) for one in parameters])

    node.add_pre_set_parameters_callback(prepare)
    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(follow)
    assert node.set_parameters([Parameter("a", value=3)])[0].successful
    refused = node.set_parameters([Parameter("a", value=7)])[0]
    assert (refused.successful, refused.reason) == (False, "too much")
    assert log == [[("a", 3), ("double_a", 6)]]
    node.remove_pre_set_parameters_callback(prepare)
    node.remove_on_set_parameters_callback(check)
    node.remove_post_set_parameters_callback(follow)
    assert node.set_parameters([Parameter("a", value=70)])[0].successful
    assert len(log) == 1
    with pytest.raises(ValueError, match="not in list"):
        node.remove_on_set_parameters_callback(check)


def test_changes_are_told_to_everybody(node: Node) -> None:
    received: list[ParameterEvent] = []
    node.create_subscription(ParameterEvent, "/parameter_events", received.append, 10)
    executor = executor_of(node)
    node.declare_parameter("a", 1, ParameterDescriptor(dynamic_typing=True))
    node.set_parameters([Parameter("a", value=2)])
    node.set_parameters([Parameter("a")])
    run_ready(executor)
    kinds = [
        [
            [one.name for one in group]
            for group in (event.new_parameters, event.changed_parameters, event.deleted_parameters)
        ]
        for event in received
    ]
    assert kinds == [[["a"], [], []], [[], ["a"], []], [[], [], ["a"]]]


def test_parameters_of_another_node(graph: Context, file: Path) -> None:
    mine, other = Node("mine", namespace="ns"), Node("robot", namespace="ns", allow_undeclared_parameters=True)
    other.declare_parameter("count", 3)
    other.declare_parameter("loose", 3, ParameterDescriptor(dynamic_typing=True))
    executor = executor_of(mine, other)
    client = AsyncParameterClient(mine, "robot")
    assert client.wait_for_services(0)

    def result(future: Any) -> Any:
        executor.spin_until_future_complete(future, 10)
        return future.result()

    assert [one.integer_value for one in result(client.get_parameters(["count"])).values] == [3]
    answer = result(
        client.set_parameters([Parameter("count", value=4), Parameter("new", value="x").to_parameter_msg()])
    )
    assert [one.successful for one in answer.results] == [True, True]
    assert result(client.set_parameters_atomically([Parameter("count", value=5)])).result.successful
    assert other.get_parameter("count").value == 5
    assert {"count", "loose", "new"} <= set(result(client.list_parameters()).result.names)
    assert result(client.describe_parameters(["count"])).descriptors[0].type == ParameterType.PARAMETER_INTEGER
    assert list(result(client.get_parameter_types(["count"])).types) == [ParameterType.PARAMETER_INTEGER]
    deleted = result(client.delete_parameters(["count", "loose"])).results
    assert [one.successful for one in deleted] == [False, True]
    assert deleted[0].reason == "Static parameter cannot be undeclared"
    called: list[Any] = []
    loaded = result(client.load_parameter_file(str(file), True, callback=called.append))
    assert all(one.successful for one in loaded.results)
    assert other.get_parameter("everywhere").value == 1
    run_ready(executor)
    assert len(called) == 1
    elsewhere = file.with_name("elsewhere.yaml")
    elsewhere.write_text("elsewhere: {ros__parameters: {count: 7}}")
    assert result(client.load_parameter_file(str(elsewhere))).results[0].successful
    assert other.get_parameter("count").value == 7


def test_what_a_callback_adds_must_be_declared(node: Node) -> None:
    node.declare_parameter("known", 0)

    def add(parameters: list[Parameter[Any]]) -> list[Parameter[Any]]:
        return [*parameters, Parameter("unknown", value=1)]

    node.add_pre_set_parameters_callback(add)
    with pytest.raises(ParameterNotDeclaredException, match="unknown"):
        node.set_parameters([Parameter("known", value=1)])
    assert node.get_parameter("known").value == 0


def test_a_static_type_needs_a_value(node: Node) -> None:
    described = ParameterDescriptor(type=ParameterType.PARAMETER_STRING)
    with pytest.raises(ValueError, match="declared without a value"):
        node.declare_parameter("typed", descriptor=described)
