"""The tricycle controller on an ideal wheel."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.common.parameters import ParameterError
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import Asked, VelocityCommand
from daidalos.samples.sensors import OdometrySample, TransformSample

PERIOD = PERIOD_NS * 1e-9


class Rig:
    """A controller on a wheel that does at once what it is told."""

    def __init__(self, **values: Any) -> None:
        given = {"traction_joint_name": "drive", "steering_joint_name": "steer", "wheelbase": 1.5, "wheel_radius": 0.3}
        self.controller, self.commands, self.states = alone(
            "tricycle_controller/TricycleController", **(given | values)
        )
        self.now = 0
        self.said: list[Any] = []

    def run(self, seconds: float, ahead: float | None = None, turn: float = 0.0) -> np.ndarray:
        rows = []
        for _ in range(round(seconds / PERIOD)):
            if ahead is not None:
                linear, angular = np.array((ahead, 0.0, 0.0)), np.array((0.0, 0.0, turn))
                take = self.controller.subscriptions["~/cmd_vel"]
                take.take(take.type(linear, angular))
            self.now += PERIOD_NS
            self.said = cycle(self.controller, self.now)
            self.states.values[:] = self.commands.values
            rows.append(self.commands.values.copy())
        return np.array(rows)

    @property
    def odometry(self) -> OdometrySample:
        return next(one for one in self.said if isinstance(one, OdometrySample))


@pytest.mark.parametrize("ahead", [1.0, -1.0])
@pytest.mark.parametrize("options", [{}, {"open_loop": True}])
def test_a_circle_is_a_circle(ahead: float, options: dict[str, Any]) -> None:
    rig = Rig(**options)
    rig.run(2.0, ahead, 0.3)
    rig.run(0.01)
    angle, radius = 0.3 * 2.0, ahead / 0.3
    assert rig.odometry.position[:2] == pytest.approx(
        [radius * math.sin(angle), radius * (1 - math.cos(angle))], rel=1e-9
    )
    assert rig.odometry.linear[0] == pytest.approx(ahead)
    assert rig.odometry.angular[2] == pytest.approx(0.3)


@pytest.mark.parametrize("turn", [0.5, -0.5])
def test_it_turns_on_the_spot_once_the_wheel_stands_across(turn: float) -> None:
    rig = Rig()
    first, second = rig.run(0.02, 0.0, turn)
    assert first[1] == pytest.approx(math.copysign(math.pi / 2, turn))
    assert abs(first[0]) < 0.05
    assert second[0] == pytest.approx(0.5 * 1.5 / 0.3)


def test_limits_hold() -> None:
    rig = Rig(
        traction={"max_acceleration": 5.0, "max_deceleration": 8.0},
        steering={"max_velocity": 1.0, "max_position": 0.5, "min_position": -0.2},
    )
    rows = rig.run(1.0, 3.0, 2.0)
    assert np.diff(rows[:, 0], prepend=0.0).max() == pytest.approx(0.05)
    assert np.diff(rows[:, 1], prepend=0.0).max() == pytest.approx(0.01)
    assert rows[-1, 1] == pytest.approx(0.5)
    rows = rig.run(1.0, 0.0)
    assert np.diff(rows[:, 0]).min() == pytest.approx(-0.08)
    assert rig.run(1.0, 3.0, -2.0)[-1, 1] == pytest.approx(-0.2)


def test_old_commands_stop_it_and_the_wheel_stays() -> None:
    rig = Rig(cmd_vel_timeout=100)
    rig.run(0.05, 1.0, 0.4)
    angle = rig.commands.values[1]
    assert rig.run(0.2)[-1] == pytest.approx([0.0, angle])
    rig.controller.deactivate()
    assert rig.commands.values == pytest.approx([0.0, angle])


def test_odometry_can_be_reset_or_be_of_velocities_alone() -> None:
    rig = Rig()
    rig.run(0.5, 1.0)
    assert rig.controller.services["~/reset_odometry"].answer(Asked()).success
    rig.run(0.01)
    assert rig.odometry.position[0] == pytest.approx(0.01)
    rig = Rig(odom_only_twist=True, use_stamped_vel=False)
    assert rig.controller.subscriptions["~/cmd_vel"].type is TwistCommand
    rig.run(0.5, 1.0)
    assert not rig.odometry.position.any()
    assert next(one for one in rig.said if isinstance(one, TransformSample)).translation[0] > 0.4
    assert Rig().controller.subscriptions["~/cmd_vel"].type is VelocityCommand


def test_wrong_parameters_are_named() -> None:
    with pytest.raises(ParameterError, match="'wheelbase' must be above 0"):
        Rig(wheelbase=0.0)
    with pytest.raises(ParameterError, match=r"'steering\.min_position' is above"):
        Rig(steering={"min_position": 1.0, "max_position": 0.0})
