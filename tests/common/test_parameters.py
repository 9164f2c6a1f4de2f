"""Parameters declared as dataclasses: values, checks, groups, changes, tables."""

import math
from dataclasses import dataclass
from typing import Any

import pytest

from daidalos.common.parameters import (
    Leaf,
    ParameterError,
    Parameters,
    build,
    group,
    leaves,
    parameter,
    parameters_from,
    per_name,
    replace,
    table,
    values_of,
)


@dataclass(frozen=True)
class Gains(Parameters):
    p: float = parameter(1.0, "Proportional gain.", minimum=0.0)
    rule: str = parameter("plain", "How it works.", choices=("plain", "fancy"))


@dataclass(frozen=True)
class Limits(Parameters):
    speed: float = parameter(2.0, "Largest speed.", unit="m/s", above=0.0, maximum=9.0)
    rate: float = parameter(math.nan, "Largest rate; NaN for none.", minimum=0.0)

    def check(self) -> None:
        if self.speed == 7.0:
            raise ParameterError("speed", "is seven")


@dataclass(frozen=True)
class Example(Parameters):
    joints: tuple[str, ...] = parameter((), "Joints.", unique=True, not_empty=True, read_only=True)
    count: int = parameter(3, "How many.", maximum=99)
    weights: tuple[float, ...] = parameter((0.5, 0.5), "Weights.", length=2, minimum=0.0, maximum=1.0)
    kinds: tuple[str, ...] = parameter((), "Kinds.", choices=("position", "velocity"))
    stamped: bool = parameter(True, "Whether there are stamps.", name="with.stamps")
    limits: Limits = group(Limits)
    gains: dict[str, Gains] = per_name(Gains, by="joints")

    def check(self) -> None:
        if self.count == len(self.joints):
            raise ParameterError("count", "is the number of joints")


@dataclass(frozen=True)
class Sources(Parameters):
    names: str = parameter("a b", "Names with spaces between them.")
    sources: dict[str, Limits] = per_name(Limits, by="names", at="")


def test_groups_and_names_nest() -> None:
    read = parameters_from(
        Example,
        {"joints": ["a", "b"], "limits": {"speed": 3}, "gains": {"a": {"p": 7.0}, "b": {"rule": "fancy"}}},
    )
    assert read.joints == ("a", "b")
    assert read.limits.speed == 3.0
    assert isinstance(read.limits.speed, float)
    assert read.gains == {"a": Gains(7.0), "b": Gains(1.0, "fancy")}


def test_flat_names_with_dots_are_the_same() -> None:
    nested = {"joints": ["a"], "gains": {"a": {"p": 4.0}}}
    assert parameters_from(Example, {"joints": ["a"], "gains.a.p": 4.0}).gains == parameters_from(Example, nested).gains


def test_groups_by_names_in_a_string_stand_beside_it() -> None:
    read = parameters_from(Sources, {"names": "c  d", "c.speed": 1.0})
    assert {name: one.speed for name, one in read.sources.items()} == {"c": 1.0, "d": 2.0}


def test_a_parameter_may_have_another_name_than_its_field() -> None:
    assert not parameters_from(Example, {"joints": ["a"], "with": {"stamps": False}}).stamped


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"joints": ["a", "a"]}, r"'joints' has duplicates"),
        ({"joints": []}, r"'joints' must not be empty"),
        ({"joints": "a"}, r"'joints' must be a list of strings, got 'a'"),
        ({"count": 2.5}, r"'count' must be an integer, got 2.5"),
        ({"count": True}, r"'count' must be an integer, got True"),
        ({"count": 100}, r"'count' must be at most 99, got 100"),
        ({"weights": [0.1]}, r"'weights' must have 2 elements, got 1"),
        ({"weights": [0.1, 1.5]}, r"'weights' must be at most 1, got 1.5"),
        ({"kinds": ["effort"]}, r"'kinds' may have position, velocity, got 'effort'"),
        ({"limits": {"speed": 0.0}}, r"'limits.speed' must be above 0, got 0"),
        ({"limits": {"speed": math.nan}}, r"'limits.speed' must be above 0, got nan"),
        ({"limits": {"speed": 7.0}}, r"'limits.speed' is seven"),
        ({"gains": {"a": {"p": -1.0}}}, r"'gains.a.p' must be at least 0, got -1"),
        ({"gains": {"a": {"rule": "odd"}}}, r"'gains.a.rule' must be one of plain, fancy, got 'odd'"),
        ({"gains": {"b": {"p": 1.0}}}, r"'gains.b.p' is not declared"),
        ({"cuont": 1}, r"'cuont' is not declared; did you mean 'count'\?"),
        ({"count": 1}, r"'count' is the number of joints"),
    ],
)
def test_what_is_not_allowed_is_named(values: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        parameters_from(Example, {"joints": ["a"]} | values)


def test_an_instance_cannot_be_made_with_a_value_that_is_not_allowed() -> None:
    with pytest.raises(ParameterError, match="'speed' must be above 0"):
        Limits(speed=-1.0)
    assert math.isnan(Limits(rate=math.nan).rate)


def test_a_shell_is_asked_for_each_parameter_with_its_declaration() -> None:
    asked: dict[str, Leaf] = {}

    def get(leaf: Leaf) -> Any:
        asked[leaf.name] = leaf
        return ["a"] if leaf.name == "joints" else leaf.default

    build(Example, get)
    assert asked["joints"].is_array
    assert asked["joints"].constraints.read_only
    assert (asked["gains.a.p"].type, asked["gains.a.p"].default) == (float, 1.0)
    assert asked["limits.speed"].constraints.unit == "m/s"
    assert asked["limits.speed"].constraints.text == "above 0, at most 9"


def test_integers_stand_for_floats_where_a_file_may_say_so() -> None:
    leaf = next(one for one in leaves(Example) if one.name == "limits.speed")
    with pytest.raises(ParameterError, match=r"'limits.speed' must be a float, got 3, an integer; write 3.0"):
        leaf.typed(3, integers=False)
    assert leaf.typed(3) == 3.0


def test_changed_values_are_checked() -> None:
    before = parameters_from(Example, {"joints": ["a"], "gains.a.p": 4.0})
    after = replace(before, {"limits.speed": 3, "with.stamps": False})
    assert (after.limits.speed, after.stamped, after.gains["a"].p) == (3.0, False, 4.0)
    assert values_of(after) == values_of(before) | {"limits.speed": 3.0, "with.stamps": False}
    for changes, message in (
        ({"limits.speed": -1.0}, "must be above 0"),
        ({"count": 1}, "is the number of joints"),
        ({"joints": ["b"]}, "'joints' is read-only"),
        ({"limit.speed": 1.0}, "did you mean 'limits.speed'"),
    ):
        with pytest.raises(ParameterError, match=message):
            replace(before, changes)


def test_a_table_has_every_parameter() -> None:
    text = table(Example)
    assert "| `limits.speed` | float | `2.0` | m/s | above 0, at most 9 | Largest speed. |" in text
    assert "| `joints` | list of strings | `[]` |  | not empty, no duplicates, read-only | Joints. |" in text
    assert "| `gains.<joints>.p` |" in text
    assert len(text.splitlines()) == 2 + len(list(leaves(Example)))
