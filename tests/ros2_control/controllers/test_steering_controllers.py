"""Steering controllers on ideal wheels, against circles."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.common.parameters import ParameterError
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import SteeringSample, VelocityCommand
from daidalos.samples.sensors import OdometrySample, TransformSample

PERIOD = PERIOD_NS * 1e-9
BICYCLE = {"wheelbase": 1.0, "rear_wheels_names": ["rear"], "front_wheels_names": ["front"], "rear_wheel_radius": 0.25}
TRICYCLE = {
    "wheelbase": 1.0,
    "wheel_track": 0.6,
    "rear_wheels_names": ["right", "left"],
    "front_wheels_names": ["front"],
    "rear_wheels_radius": 0.25,
}
ACKERMANN = {
    "wheelbase": 1.0,
    "rear_wheel_track": 0.6,
    "front_wheel_track": 0.5,
    "rear_wheels_names": ["right", "left"],
    "front_wheels_names": ["front_right", "front_left"],
    "rear_wheels_radius": 0.25,
}
ALL = {"bicycle": BICYCLE, "tricycle": TRICYCLE, "ackermann": ACKERMANN}


class Rig:
    """A controller on wheels that do at once what they are told."""

    def __init__(self, kind: str, **values: Any) -> None:
        type_name = f"{kind}_steering_controller/{kind.title()}SteeringController"
        self.controller, self.commands, self.states = alone(type_name, **(ALL[kind] | values))
        self.driven = 1 if kind == "bicycle" else 2
        self.positions = values.get("position_feedback", False)
        self.now = 0
        self.said: list[Any] = []

    def run(self, seconds: float, speed: float | None = None, turn: float = 0.0) -> None:
        for _ in range(round(seconds / PERIOD)):
            if speed is not None:
                linear, angular = np.array((speed, 0.0, 0.0)), np.array((0.0, 0.0, turn))
                topic, subscription = next(iter(self.controller.subscriptions.items()))
                plain = topic.endswith("_unstamped")
                subscription.take(TwistCommand(linear, angular) if plain else VelocityCommand(linear, angular))
            self.now += PERIOD_NS
            self.said = cycle(self.controller, self.now)
            count = self.driven
            if self.positions:
                self.states.values[:count] += self.commands.values[:count] * PERIOD
            else:
                self.states.values[:count] = self.commands.values[:count]
            self.states.values[count:] = self.commands.values[count:]

    @property
    def odometry(self) -> OdometrySample:
        return next(one for one in self.said if isinstance(one, OdometrySample))


@pytest.mark.parametrize("kind", sorted(ALL))
@pytest.mark.parametrize("options", [{}, {"position_feedback": True}, {"open_loop": True}, {"use_stamped_vel": False}])
def test_a_circle_is_a_circle(kind: str, options: dict[str, Any]) -> None:
    rig = Rig(kind, **options)
    rig.run(2.0, 1.0, 0.5)
    rig.run(0.01)
    last, angle = rig.odometry, 0.5 * 2.0
    assert last.position[:2] == pytest.approx([math.sin(angle) / 0.5, (1 - math.cos(angle)) / 0.5], rel=1e-9)
    assert last.linear[0] == pytest.approx(1.0)
    assert last.angular[2] == pytest.approx(0.5)


def test_a_bicycle_steers_and_drives() -> None:
    rig = Rig("bicycle")
    rig.run(0.01, 1.0, 0.5)
    assert rig.commands.names == ("rear/velocity", "front/position")
    assert rig.commands.values == pytest.approx([4.0, math.atan(0.5)])
    sample = next(one for one in rig.said if isinstance(one, SteeringSample))
    assert sample.steering_commands == pytest.approx([math.atan(0.5)])


def test_standing_keeps_the_wheels_where_they_are() -> None:
    rig = Rig("ackermann", reference_timeout=0.1)
    rig.run(0.05, 1.0, 0.5)
    angles = rig.commands.values[2:].copy()
    rig.run(0.2)
    assert rig.commands.values == pytest.approx([0.0, 0.0, *angles])
    rig.run(0.05, 0.0, 1.0)
    assert rig.commands.values == pytest.approx([0.0, 0.0, *angles])


def test_names_by_what_the_wheels_do() -> None:
    rig = Rig(
        "bicycle",
        rear_wheels_names=[],
        front_wheels_names=[],
        traction_joints_names=["motor"],
        steering_joints_names=["handle"],
        steering_joints_state_names=["fork"],
        rear_wheel_radius=0.0,
        traction_wheel_radius=0.5,
    )
    assert rig.commands.names == ("motor/velocity", "handle/position")
    assert rig.states.names == ("motor/velocity", "fork/position")
    rig.run(0.01, 1.0)
    assert rig.commands.values[0] == pytest.approx(2.0)


def test_the_rear_can_steer() -> None:
    rig = Rig("bicycle", front_steering=False, front_wheel_radius=0.5)
    assert rig.commands.names == ("front/velocity", "rear/position")
    rig.run(0.01, 1.0)
    assert rig.commands.values[0] == pytest.approx(2.0)


def test_wheels_can_wait_for_the_steering() -> None:
    rig = Rig("bicycle", reduce_wheel_speed_until_steering_reached=True)
    rig.run(0.01, 0.5, 5.0)  # the angle is 84 degrees, the wheel is straight
    slow = rig.commands.values[0]
    assert 0.0 < slow < 0.3 * 2.0
    rig.run(0.01, 0.5, 5.0)
    assert rig.commands.values[0] == pytest.approx(2.0)


def test_transforms_are_wanted_or_not() -> None:
    rig = Rig("bicycle", odom_frame_id="world")
    rig.run(0.01)
    transform = next(one for one in rig.said if isinstance(one, TransformSample))
    assert (transform.topic, transform.frame_id, transform.child_frame_id) == ("~/tf_odometry", "world", "base_link")
    rig = Rig("bicycle", enable_odom_tf=False)
    rig.run(0.01)
    assert not any(isinstance(one, TransformSample) for one in rig.said)


def test_it_stands_when_it_stops() -> None:
    rig = Rig("tricycle")
    rig.run(0.05, 1.0, 0.5)
    rig.controller.deactivate()
    assert rig.commands.values == pytest.approx([0.0, 0.0, math.atan(0.5)])


def test_the_steered_wheels_are_as_far_apart_as_the_driven_ones_unless_told_otherwise() -> None:
    angles = []
    for track in (0.0, 0.6):
        rig = Rig("ackermann", front_wheel_track=track)
        rig.run(0.05, 1.0, 0.5)
        angles.append(rig.commands.values[2:].copy())
    assert angles[0] == pytest.approx(angles[1])


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        ("bicycle", {"rear_wheels_names": ["a", "b"]}, "'traction_joints_names' must have 1 elements, got 2"),
        ("ackermann", {"front_wheels_names": ["a"]}, "'steering_joints_names' must have 2 elements, got 1"),
        ("tricycle", {"wheel_track": 0.0}, "'traction_track_width' must be above 0"),
        ("bicycle", {"rear_wheel_radius": 0.0}, "radius of the driven wheels must be above 0"),
        ("bicycle", {"wheelbase": 0.0}, "'wheelbase' must be above 0"),
    ],
)
def test_wrong_parameters_are_named(kind: str, values: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Rig(kind, **values)
