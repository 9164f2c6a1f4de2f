"""Dataclasses as parameters of nodes."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest
import rclpy
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.nodes.parameters import declare_dataclass


@dataclass(frozen=True)
class Settings:
    speed: float = 0.5
    name: str = "x"
    gains: tuple[float, ...] = (1.0, 2.0)
    table: dict[str, int] = field(default_factory=dict)


@pytest.fixture
def context() -> Iterator[rclpy.Context]:
    context = rclpy.Context()
    rclpy.init(context=context)
    yield context
    rclpy.shutdown(context=context)


def test_fields_become_parameters_with_given_values(context: rclpy.Context) -> None:
    given = [Parameter("plan.speed", value=0.7), Parameter("plan.gains", value=[3.0])]
    node = Node("settings", context=context, parameter_overrides=given)
    settings = declare_dataclass(node, Settings, "plan", name="y")
    assert settings == Settings(0.7, "y", (3.0,), {})
    assert node.get_parameter("plan.name").value == "y"
    assert not node.has_parameter("plan.table")
    node.destroy_node()


def test_a_value_of_another_type_is_refused(context: rclpy.Context) -> None:
    node = Node("settings", context=context, parameter_overrides=[Parameter("speed", value="fast")])
    with pytest.raises(InvalidParameterTypeException, match="speed"):
        declare_dataclass(node, Settings)
    node.destroy_node()
