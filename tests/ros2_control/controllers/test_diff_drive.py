"""Differential drive, against closed forms."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.common.parameters import ParameterError
from daidalos.control.contracts import Controller
from daidalos.control.interfaces import Interfaces
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import VelocityCommand, VelocitySample
from daidalos.samples.sensors import OdometrySample, TransformSample

TYPE = "diff_drive_controller/DiffDriveController"
PERIOD = PERIOD_NS * 1e-9
WHEELS = {"left_wheel_names": ["left"], "right_wheel_names": ["right"], "wheel_separation": 0.4, "wheel_radius": 0.1}


class Rig:
    """A controller on ideal wheels, which turn as they are told."""

    def __init__(self, context: dict[str, Any] | None = None, **values: Any) -> None:
        self.warnings: list[str] = []
        context = {"warn": self.warnings.append} | (context or {})
        self.controller: Controller
        self.commands: Interfaces
        self.states: Interfaces
        self.controller, self.commands, self.states = alone(TYPE, None, context, **(WHEELS | values))
        self.now = 0
        self.said: list[Any] = []

    def send(self, speed: float, turn: float, stamp_ns: int = 0) -> None:
        topic, subscription = next(iter(self.controller.subscriptions.items()))
        linear, angular = np.array((speed, 0.0, 0.0)), np.array((0.0, 0.0, turn))
        if topic == "~/cmd_vel":
            subscription.take(VelocityCommand(linear, angular, stamp_ns))
        else:
            assert topic == "~/cmd_vel_unstamped"
            subscription.take(TwistCommand(linear, angular))

    def run(self, seconds: float, speed: float | None = None, turn: float = 0.0) -> np.ndarray:
        rows = []
        for _ in range(round(seconds / PERIOD)):
            if speed is not None:
                self.send(speed, turn)
            self.now += PERIOD_NS
            self.said += cycle(self.controller, self.now)
            rows.append(self.commands.values.copy())
            if self.states.names:
                if self.states.names[0].endswith("position"):
                    self.states.values[:] += self.commands.values * PERIOD
                else:
                    self.states.values[:] = self.commands.values
        return np.array(rows)

    def odometry(self) -> list[OdometrySample]:
        return [one for one in self.said if isinstance(one, OdometrySample)]


def test_wheels_turn_as_the_kinematics_say() -> None:
    rig = Rig()
    left, right = rig.run(0.1, 1.0, 2.0)[-1]
    assert left == pytest.approx((1.0 - 2.0 * 0.2) / 0.1)
    assert right == pytest.approx((1.0 + 2.0 * 0.2) / 0.1)


def test_multipliers_correct_the_sizes() -> None:
    rig = Rig(wheel_separation_multiplier=1.5, left_wheel_radius_multiplier=0.5, right_wheel_radius_multiplier=2.0)
    left, right = rig.run(0.1, 1.0, 2.0)[-1]
    assert left == pytest.approx((1.0 - 2.0 * 0.3) / 0.05)
    assert right == pytest.approx((1.0 + 2.0 * 0.3) / 0.2)


@pytest.mark.parametrize("options", [{}, {"position_feedback": False}, {"open_loop": True}])
def test_an_arc_ends_where_geometry_says(options: dict[str, Any]) -> None:
    rig = Rig(publish_rate=100.0, **options)
    rig.run(2.0, 0.5, 0.4)
    rig.run(0.01)  # measures what was driven in the cycle before
    last = rig.odometry()[-1]
    radius, angle = 0.5 / 0.4, 0.4 * 2.0
    assert last.position[:2] == pytest.approx([radius * math.sin(angle), radius * (1 - math.cos(angle))], rel=1e-9)
    assert 2 * math.atan2(last.orientation[2], last.orientation[3]) == pytest.approx(angle)
    assert last.linear[0] == pytest.approx(0.5)
    assert last.angular[2] == pytest.approx(0.4)


def test_several_wheels_a_side_turn_alike_and_are_averaged() -> None:
    rig = Rig(left_wheel_names=["a", "b"], right_wheel_names=["c", "d"], publish_rate=100.0)
    assert rig.run(0.1, 1.0, 2.0)[-1] == pytest.approx([6.0, 6.0, 14.0, 14.0])
    rig.run(0.03, 0.0)
    before = rig.odometry()[-1].position
    rig.states.values[:] += [0.2, 0.4, 0.2, 0.4]
    rig.run(0.01)
    assert np.linalg.norm(rig.odometry()[-1].position - before) == pytest.approx(0.3 * 0.1)


def test_old_commands_stop_the_base() -> None:
    rig = Rig(cmd_vel_timeout=0.2)
    rig.send(1.0, 0.0)
    rows = rig.run(0.5)
    assert rows[:20] == pytest.approx(10.0)
    assert rows[20:] == pytest.approx(0.0)
    rig.send(1.0, 0.0, stamp_ns=rig.now - 250_000_000)
    assert "is 0.250 s old" in rig.warnings[0]
    rig.send(1.0, 0.0, stamp_ns=rig.now - 150_000_000)
    rows = rig.run(0.2)
    assert rows[:5] == pytest.approx(10.0)
    assert rows[5:] == pytest.approx(0.0)


def test_plain_velocities_have_their_own_topic() -> None:
    rig = Rig(use_stamped_vel=False)
    assert rig.run(0.1, 1.0)[-1] == pytest.approx([10.0, 10.0])


def test_limits_hold_and_can_be_heard() -> None:
    rig = Rig(
        publish_limited_velocity=True,
        linear={"x": {"max_velocity": 0.5, "max_acceleration": 1.0}},
        angular={"z": {"has_velocity_limits": True, "max_velocity": 0.3, "min_velocity": -0.1}},
    )
    rig.run(0.2, 2.0, -9.0)
    out = [one for one in rig.said if isinstance(one, VelocitySample)]
    assert [one.linear[0] for one in out] == pytest.approx(np.arange(1, 21) * PERIOD)
    assert out[-1].angular[2] == pytest.approx(-0.1)
    assert len(out) == 20


def test_odometry_comes_at_its_rate_with_a_transform() -> None:
    rig = Rig(publish_rate=25.0, pose_covariance_diagonal=[0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    rig.run(1.0, 0.1)
    stamps = np.array([one.stamp_ns for one in rig.odometry()])
    assert np.all(np.diff(stamps) == 40_000_000)
    assert len([one for one in rig.said if isinstance(one, TransformSample)]) == len(stamps)
    assert rig.odometry()[0].pose_covariance.reshape(6, 6) == pytest.approx(np.diag([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))


@pytest.mark.parametrize(
    ("values", "namespace", "frame"),
    [
        ({}, "/", "odom"),
        ({}, "/robot1", "robot1/odom"),
        ({"tf_frame_prefix": "tb3"}, "/robot1", "tb3/odom"),
        ({"tf_frame_prefix_enable": False, "odom_frame_id": "world"}, "/robot1", "world"),
    ],
)
def test_frames_have_a_prefix(values: dict[str, Any], namespace: str, frame: str) -> None:
    rig = Rig({"namespace": namespace}, **values)
    rig.run(0.05)
    assert rig.odometry()[0].frame_id == frame
    assert rig.odometry()[0].child_frame_id == frame.replace("odom", "base_link").replace("world", "base_link")


def test_it_stands_when_it_stops() -> None:
    rig = Rig()
    rig.run(0.1, 1.0)
    rig.controller.deactivate()
    assert not rig.commands.values.any()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"right_wheel_names": ["a", "b"]}, "'right_wheel_names' has 2 elements, left_wheel_names has 1"),
        ({"wheel_radius": 0.0}, "'wheel_radius' must be above 0"),
        ({"left_wheel_names": []}, "'left_wheel_names' must not be empty"),
        ({"linear": {"x": {"max_velocity": 1.0, "min_velocity": 2.0}}}, r"'linear\.x\.min_velocity' is above"),
    ],
)
def test_wrong_parameters_are_named(values: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Rig(**values)


def test_velocities_that_are_no_numbers_are_ignored() -> None:
    rig = Rig()
    rig.run(0.05, 1.0)
    rig.send(math.nan, 0.0)
    assert rig.warnings == ["a velocity that is not a number was ignored"]
    assert rig.run(0.05)[-1] == pytest.approx([10.0, 10.0])
