"""How turtles move, against closed forms and what ROS 2's tutorials show."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.nodes.turtlesim._turtle import SIZE, UPDATE_S, Turtle, normalized

angles = st.floats(-50.0, 50.0)


def run(turtle: Turtle, seconds: float, start_s: float = 0.0) -> None:
    for step in range(round(seconds / UPDATE_S)):
        turtle.step(start_s + step * UPDATE_S)


def test_a_circle_closes() -> None:
    turtle = Turtle("turtle1", 5.0, 5.0, 0.0)
    steps = 250  # an angle of 4 s * 1.5708 rad/s
    farthest = 0.0
    for step in range(steps):
        turtle.command(1.0, 0.0, math.tau / (steps * UPDATE_S), step * UPDATE_S)
        turtle.step(step * UPDATE_S)
        farthest = max(farthest, turtle.y - 5.0)
    assert (turtle.x, turtle.y) == pytest.approx((5.0, 5.0), abs=1e-3)
    assert turtle.theta == pytest.approx(0.0, abs=1e-4)
    assert farthest == pytest.approx(2 * steps * UPDATE_S / math.tau, rel=0.01)  # the diameter


def test_a_command_lasts_a_second() -> None:
    turtle = Turtle("turtle1", 1.0, 5.0, 0.0)
    turtle.command(2.0, 0.0, 0.0, 0.0)
    run(turtle, 3.0)
    assert turtle.x == pytest.approx(1.0 + 2.0 * (1.0 + UPDATE_S), abs=2.0 * UPDATE_S)
    assert turtle.forward == 0.0


def test_sideways() -> None:
    turtle = Turtle("turtle1", 5.0, 5.0, math.pi / 2)
    turtle.command(0.0, 1.0, 0.0, 0.0)
    run(turtle, 0.8)
    assert (turtle.x, turtle.y) == pytest.approx((4.2, 5.0), abs=1e-6)  # to the left of up


def test_walls_hold_and_say_where_it_would_have_gone() -> None:
    turtle = Turtle("turtle1", SIZE, 5.0, 0.0)
    turtle.command(2.0, 0.0, 0.0, 0.0)
    # What the tutorials show: "Clamping from [x=11.120889, y=5.544445]".
    assert turtle.step(0.0) == pytest.approx((11.120889, 5.0), abs=1e-6)
    assert turtle.x == SIZE
    assert Turtle("", 5.0, 5.0, 0.0).step(0.0) is None


@pytest.mark.parametrize(
    ("start", "goal", "delta"),
    [(0.0, 1.57, -1.568000316619873), (1.5568, -1.57, 3.1200008392333984)],
)
def test_rotations_end_where_those_of_the_tutorials_do(start: float, goal: float, delta: float) -> None:
    turtle = Turtle("turtle1", 5.0, 5.0, float(np.float32(start)))
    begun = turtle.theta
    for step in range(1000):
        turtle.turn_towards(goal, step * UPDATE_S)
        if turtle.angular == 0.0:
            break
        turtle.step(step * UPDATE_S)
    assert turtle.angle_to(begun) == pytest.approx(delta, abs=1e-6)


def test_the_first_rotation_of_the_tutorial_to_the_last_digit() -> None:
    turtle = Turtle("turtle1", 5.0, 5.0, 0.0)
    while turtle.turn_towards(1.57, 0.0) and turtle.angular:
        turtle.step(0.0)
    assert turtle.angle_to(0.0) == -1.568000316619873


@given(angles, angles)
def test_turning_goes_the_short_way(theta: float, goal: float) -> None:
    turtle = Turtle("", 5.0, 5.0, normalized(theta))
    assert abs(turtle.angle_to(goal)) <= math.pi + 1e-6
    assert math.cos(turtle.theta + turtle.angle_to(goal)) == pytest.approx(math.cos(goal), abs=1e-4)


@given(angles)
def test_headings_stay_the_same_when_normalized(angle: float) -> None:
    assert -math.pi - 1e-6 <= normalized(angle) <= math.pi + 1e-6
    assert math.sin(normalized(angle)) == pytest.approx(math.sin(angle), abs=1e-5)


def test_teleports() -> None:
    turtle = Turtle("turtle1", 5.0, 5.0, 0.0)
    turtle.teleport_relative(2.0, math.pi / 2)
    assert (turtle.x, turtle.y) == pytest.approx((5.0, 7.0), abs=1e-6)
    turtle.teleport(-3.0, 4.0, 7.0)
    assert turtle.theta == pytest.approx(7.0 - math.tau, abs=1e-6)
    assert turtle.step(0.0) == (-3.0, 4.0)
    assert (turtle.x, turtle.y) == (0.0, 4.0)
