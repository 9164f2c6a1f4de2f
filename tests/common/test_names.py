"""Notations of names."""

import pytest

from daidalos.common.names import camel_case, snake_case


@pytest.mark.parametrize(
    ("name", "expected"), [("talker", "Talker"), ("send_goal", "SendGoal"), ("vector3_node", "Vector3Node"), ("", "")]
)
def test_camel_case(name, expected):
    assert camel_case(name) == expected


@pytest.mark.parametrize(("name", "expected"), [("Talker", "talker"), ("SendGoal", "send_goal"), ("", "")])
def test_snake_case(name, expected):
    assert snake_case(name) == expected
