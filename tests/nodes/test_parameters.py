"""Parameters of nodes: descriptors, values from files, changes at run time, and names that nothing declares."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.nodes.parameters import (
    declare,
    declare_given,
    declare_one,
    given_below,
    location_of,
    typed_value,
    warn_of_undeclared,
)
from daidalos.nodes.runner import create

DOUBLE, STRING, INTEGER_ARRAY = 3, 4, 7


@dataclass(frozen=True)
class Limits(Parameters):
    speed: float = parameter(0.5, "Largest speed.", unit="m/s", above=0.0, maximum=9.0)
    size: float = parameter(1.0, "Size.", unit="m", takes_integer=True)


@dataclass(frozen=True)
class Settings(Parameters):
    rule: str = parameter("plain", "How it works.", choices=("plain", "fancy"))
    counts: tuple[int, ...] = parameter((), "How many.", minimum=0)
    frame: str = parameter("map", "Frame.", read_only=True)
    limits: Limits = group(Limits)

    def check(self) -> None:
        if self.rule == "fancy" and self.limits.speed > 5.0:
            raise ParameterError("rule", "must be plain at that speed")


Make = Callable[..., Node]


@pytest.fixture
def make(tmp_path: Path) -> Iterator[Make]:
    """Makes a node with the text of a parameter file."""
    context = rclpy.Context()
    rclpy.init(context=context)

    def make(text: str = "", **kwargs: Any) -> Node:
        file = tmp_path / "params.yaml"
        file.write_text(text, encoding="utf-8")
        arguments = ["--ros-args", "--params-file", str(file)] if text else []
        return Node("settings", context=context, cli_args=arguments, **kwargs)

    yield make
    rclpy.shutdown(context=context)


def test_parameters_have_descriptors(make: Make) -> None:
    node = make()
    assert declare(node, Settings, "plan", lambda values: None) == Settings()
    speed = node.describe_parameter("plan.limits.speed")
    assert (speed.type, speed.description, speed.read_only) == (DOUBLE, "Largest speed. [m/s]", False)
    assert (speed.floating_point_range[0].from_value, speed.floating_point_range[0].to_value) == (0.0, 9.0)
    assert speed.additional_constraints == "above 0, at most 9"
    rule = node.describe_parameter("plan.rule")
    assert (rule.type, rule.additional_constraints) == (STRING, "one of plain, fancy")
    counts = node.describe_parameter("plan.counts")
    assert (counts.type, len(counts.integer_range)) == (INTEGER_ARRAY, 0)
    assert node.describe_parameter("plan.frame").read_only


def test_values_come_from_files_and_code(make: Make) -> None:
    text = "settings:\n  ros__parameters:\n    rule: fancy\n    counts: [1, 2]\n    limits: {size: 3}\n"
    node = make(text, parameter_overrides=[Parameter("rule", value="plain")])
    assert declare(node, Settings) == Settings("plain", (1, 2), "map", Limits(0.5, 3.0))
    assert node.get_parameter("limits.size").value == 3.0


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("rule: 3", "'rule' of /settings must be a string, got 3"),
        ("limits.speed: 3", "'limits.speed' of /settings must be a float, got 3, an integer; write 3.0"),
        ("limits: {speed: 0.0}", "'limits.speed' of /settings must be above 0, got 0"),
        ("rule: other", "'rule' of /settings must be one of plain, fancy, got 'other'"),
        ("{rule: fancy, limits.speed: 8.0}", "'rule' of /settings must be plain at that speed"),
    ],
)
def test_wrong_values_are_refused_with_file_and_line(make: Make, tmp_path: Path, line: str, problem: str) -> None:
    node = make(f"# about\nsettings:\n  ros__parameters:\n    {line}\n")
    with pytest.raises(ParameterError) as raised:
        declare(node, Settings)
    assert str(raised.value) == f"{tmp_path / 'params.yaml'}:4: parameter {problem}"


def test_the_command_line_is_named(make: Make) -> None:
    node = make()
    node = Node("settings", context=node.context, cli_args=["--ros-args", "-p", "rule:=other"])
    with pytest.raises(ParameterError, match=r"^-p rule:=other: parameter 'rule' of /settings must be one of"):
        declare(node, Settings)


def test_the_launch_file_behind_a_file_is_named(make: Make) -> None:
    node = make("# from: /x/some.launch.py\n/**:\n  ros__parameters:\n    rule: other\n")
    assert str(location_of(node, "rule")) == "/x/some.launch.py"


def test_changes_are_checked_and_passed_on(make: Make) -> None:
    node = make()
    taken: list[Settings] = []
    declare(node, Settings, "plan", taken.append)
    results = node.set_parameters(
        [
            Parameter("plan.limits.speed", value=8.0),
            Parameter("plan.rule", value="fancy"),
            Parameter("plan.limits.speed", value=0.0),
            Parameter("plan.frame", value="odom"),
        ]
    )
    assert [one.successful for one in results] == [True, False, False, False]
    assert results[1].reason == "parameter 'plan.rule' must be plain at that speed"
    assert results[2].reason == "parameter 'plan.limits.speed' must be above 0, got 0"
    assert taken == [Settings(limits=Limits(8.0))]
    together = [Parameter("plan.limits.speed", value=2.0), Parameter("plan.rule", value="fancy")]
    assert node.set_parameters_atomically(together).successful
    assert taken[-1] == Settings("fancy", limits=Limits(2.0))


def test_an_owner_may_refuse_a_change(make: Make) -> None:
    def refuse(values: Settings) -> None:
        raise RuntimeError("not while it drives")

    node = make()
    declare(node, Settings, reconfigure=refuse)
    result = node.set_parameters([Parameter("rule", value="fancy")])[0]
    assert (result.successful, result.reason) == (False, "not while it drives")
    assert node.get_parameter("rule").value == "plain"


def test_without_an_owner_that_takes_changes_all_are_read_only(make: Make) -> None:
    node = make()
    declare(node, Settings)
    assert not node.set_parameters([Parameter("rule", value="fancy")])[0].successful


def test_values_stay_when_they_are_declared_again(make: Make) -> None:
    node = make()
    declare(node, Settings, reconfigure=lambda values: None)
    node.set_parameters([Parameter("rule", value="fancy")])
    taken: list[Settings] = []
    assert declare(node, Settings, reconfigure=taken.append).rule == "fancy"
    node.set_parameters([Parameter("limits.speed", value=0.1)])
    assert taken == [Settings("fancy", limits=Limits(0.1))]


def test_undeclared_names_are_warned_of_once(make: Make, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    node = make(
        "/**:\n  ros__parameters:\n    use_sim_time: false\n    limits.siize: 1.0\n    for_another: 2\n"
        "settings:\n  ros__parameters:\n    limits:\n      sped: 0.1\n    nothing.like.it: 1\n"
        "    qos_overrides./a.b: 1\n"
    )
    declare(node, Settings)
    for _ in range(2):
        warn_of_undeclared(node)
    file = tmp_path / "params.yaml"
    warnings = [line.partition("[settings]: ")[2] for line in capfd.readouterr().err.splitlines() if "[WARN]" in line]
    assert warnings == [
        f"{file}:4: parameter 'limits.siize' of /settings is not declared; did you mean 'limits.size'?",
        f"{file}:9: parameter 'limits.sped' of /settings is not declared; did you mean 'limits.speed'?",
        f"{file}: parameters of /settings that are not declared and have no effect: nothing.like.it (line 10)",
    ]


def test_what_a_range_says_is_said_once(make: Make) -> None:
    @dataclass(frozen=True)
    class Colour(Parameters):
        red: int = parameter(69, "Red.", minimum=0, maximum=255)

    node = make()
    declare(node, Colour)
    red = node.describe_parameter("red")
    (limits,) = red.integer_range
    assert (limits.from_value, limits.to_value, limits.step) == (0, 255, 1)
    assert red.additional_constraints == ""


def test_defaults_may_be_known_only_at_run_time(make: Make) -> None:
    node = make("settings:\n  ros__parameters: {frame: odom}\n")
    values = declare(node, Settings, defaults={"rule": "fancy", "frame": "earth"})
    assert (values.rule, values.frame) == ("fancy", "odom")
    assert node.get_parameter("rule").value == "fancy"


def test_parameters_whose_names_depend_on_others(make: Make, tmp_path: Path) -> None:
    node = make("settings:\n  ros__parameters:\n    zeros: {a: 1, b.c: 2.0}\n    zeros.d: far\n")
    assert given_below(node, "zeros") == ["a", "b.c", "d"]
    assert declare_one(node, "zeros.a", 0.0, "Zero.", takes_integer=True) == 1.0
    assert declare_one(node, "other", 7, "Other.") == 7
    with pytest.raises(ParameterError, match=r"params.yaml:4: parameter 'zeros.d' of /settings must be a float"):
        declare_one(node, "zeros.d", 0.0, "Zero.")


def test_values_of_any_name_have_the_type_of_their_default(make: Make) -> None:
    node = make("settings:\n  ros__parameters:\n    arm.type: 3\n    arm.files: one.yaml\n    leg.files: [a, b]\n")
    declare_given(node)
    assert typed_value(node, "arm.files", ()) == ("one.yaml",)
    assert typed_value(node, "leg.files", ()) == ("a", "b")
    assert typed_value(node, "leg.type", "Leg") == "Leg"
    with pytest.raises(
        ParameterError, match=r"params.yaml:3: parameter 'arm.type' of /settings must be a string, got 3"
    ):
        typed_value(node, "arm.type", "")


def test_a_program_warns_of_what_its_node_does_not_declare(make: Make, capfd: pytest.CaptureFixture[str]) -> None:
    def make_node() -> Node:
        node = make("settings:\n  ros__parameters: {rules: fancy}\n")
        declare(node, Settings)
        return node

    create(make_node)
    assert "parameter 'rules' of /settings is not declared; did you mean 'rule'?" in capfd.readouterr().err
