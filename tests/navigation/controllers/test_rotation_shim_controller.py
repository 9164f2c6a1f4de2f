"""Turning to the path and to the goal around another controller."""

import math

import numpy as np
import pytest

from daidalos.navigation.contracts import Controller, NavigationContext
from daidalos.navigation.controllers.rotation_shim_controller import RotationShimController, RotationShimParameters
from daidalos.navigation.costmap.footprint import Footprint

from .scenes import control, ground, line

ROUND = Footprint.circle(0.2)
LONG = Footprint.of_corners(np.array([[0.5, 0.1], [0.5, -0.1], [-0.5, -0.1], [-0.5, 0.1]]))


class Ahead(Controller):
    """Drives ahead."""

    look_ahead = 1.0
    limit = None

    def compute_velocity_commands(self, control):
        return np.array([0.4, 0.0, 0.0])

    def set_speed_limit(self, speed_limit, *, percentage):
        self.limit = (speed_limit, percentage)

    def reset(self):
        pass


def shim(footprint=ROUND, **parameters):
    return RotationShimController(
        RotationShimParameters(**parameters), NavigationContext(footprint=footprint), primary=Ahead()
    )


def test_it_turns_first_and_then_lets_drive_whatever_the_path_does():
    controller = shim()
    side = line((0.0, 2.0))
    assert controller.compute_velocity_commands(control(side))[0] == 0.0
    nearly = control(side, pose=(0.0, 0.0, math.pi / 2 - 0.4))
    assert controller.compute_velocity_commands(nearly)[2] > 0.0
    along = control(side, pose=(0.0, 0.0, math.pi / 2 - 0.2))
    assert controller.compute_velocity_commands(along)[0] == 0.4
    assert controller.compute_velocity_commands(control(side))[0] == 0.4
    controller.reset()
    assert controller.compute_velocity_commands(control(side))[0] == 0.0


def test_within_the_tolerance_it_turns_to_the_goal_and_stays_there():
    controller = shim()
    path = line((0.1, 0.0), heading=2.0)
    assert controller.compute_velocity_commands(control(path))[2] > 0.0
    pushed = control(path, pose=(-0.3, 0.0, 0.0))
    assert controller.compute_velocity_commands(pushed)[0] == 0.0


def test_turning_at_the_goal_can_be_left_to_the_other_controller():
    controller = shim(rotate_to_goal_heading=False)
    assert controller.compute_velocity_commands(control(line((0.1, 0.0), heading=2.0)))[0] == 0.4


def test_a_long_robot_turns_only_where_it_has_room():
    side = line((0.0, 2.0))
    assert shim(LONG).compute_velocity_commands(control(side, ground()))[0] == 0.0
    tight = ground([(0.25, 0.4)], radius=0.1)
    assert shim(LONG).compute_velocity_commands(control(side, tight))[0] == 0.4


def test_limits_are_passed_on():
    controller = shim()
    controller.set_speed_limit(30.0, percentage=True)
    assert controller.primary.limit == (30.0, True)
    assert controller.look_ahead == pytest.approx(1.0)
