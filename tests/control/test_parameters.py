"""Parameters of controllers as dataclasses."""

from dataclasses import dataclass, field
from typing import Any

import pytest

from daidalos.control.errors import ParameterError
from daidalos.control.parameters import (
    Leaf,
    above,
    at_least,
    elements_within,
    not_empty,
    one_of,
    parameter,
    parameters_from,
    per_name,
    read_parameters,
    size,
    subset_of,
    unique,
)


@dataclass(frozen=True)
class Gains:
    p: float = parameter(1.0, at_least(0.0))
    rule: str = parameter("plain", one_of("plain", "fancy"))


@dataclass(frozen=True)
class Limits:
    speed: float = parameter(2.0, above(0.0))


@dataclass(frozen=True)
class Example:
    joints: tuple[str, ...] = parameter((), unique, not_empty, read_only=True)
    count: int = parameter(3)
    weights: tuple[float, ...] = parameter((0.5, 0.5), size(2), elements_within(0.0, 1.0))
    kinds: tuple[str, ...] = parameter((), subset_of("position", "velocity"))
    stamped: bool = parameter(default=True)
    limits: Limits = field(default_factory=Limits)
    gains: dict[str, Gains] = field(default_factory=dict, metadata=per_name(Gains, by="joints"))

    def check(self) -> None:
        if self.count > 9:
            raise ParameterError("count", "is more than nine")


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


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"joints": ["a", "a"]}, r"'joints' has something twice"),
        ({"joints": []}, r"'joints' must not be empty"),
        ({"joints": "a"}, r"'joints' should be a list of str, got 'a'"),
        ({"joints": ["a"], "count": 2.5}, r"'count' should be of type int, got 2.5"),
        ({"joints": ["a"], "count": True}, r"'count' should be of type int, got True"),
        ({"joints": ["a"], "weights": [0.1]}, r"'weights' must have 2 elements, got 1"),
        ({"joints": ["a"], "weights": [0.1, 1.5]}, r"'weights' must have elements from 0 to 1, got 1.5"),
        ({"joints": ["a"], "kinds": ["effort"]}, r"'kinds' may have position, velocity, got 'effort'"),
        ({"joints": ["a"], "limits": {"speed": 0.0}}, r"'limits.speed' must be above 0, got 0"),
        ({"joints": ["a"], "gains": {"a": {"p": -1.0}}}, r"'gains.a.p' must be at least 0, got -1"),
        ({"joints": ["a"], "gains": {"a": {"rule": "odd"}}}, r"'gains.a.rule' must be one of plain, fancy, got 'odd'"),
        ({"joints": ["a"], "gains": {"b": {"p": 1.0}}}, r"'gains.b.p' is not known"),
        ({"joints": ["a"], "count": 10}, r"'count' is more than nine"),
    ],
)
def test_what_is_not_allowed_is_named(values: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        parameters_from(Example, values)


def test_a_shell_is_asked_for_each_parameter_with_its_type() -> None:
    asked: dict[str, Leaf] = {}

    def get(leaf: Leaf) -> Any:
        asked[leaf.name] = leaf
        return ["a"] if leaf.name == "joints" else leaf.default

    read_parameters(Example, get)
    assert asked["joints"] == Leaf("joints", (), str, many=True, read_only=True)
    assert asked["gains.a.p"] == Leaf("gains.a.p", 1.0, float, many=False, read_only=False)
    assert asked["limits.speed"].type is float
