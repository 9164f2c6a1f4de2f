"""Behaviours in a loop with a perfect robot."""

import math

import numpy as np
import pytest

from daidalos.navigation.behaviors.assisted_teleop import AssistedTeleop
from daidalos.navigation.behaviors.back_up import BackUp, BackUpCommand
from daidalos.navigation.behaviors.collision import contact_ahead
from daidalos.navigation.behaviors.drive_on_heading import DriveOnHeading, DriveOnHeadingCommand
from daidalos.navigation.behaviors.spin import Spin, SpinCommand
from daidalos.navigation.behaviors.wait import Wait, WaitCommand
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import CollisionAhead, InvalidInput, TimedOut

from ..controllers.scenes import ground

ROUND = Footprint.circle(0.2)
LONG = Footprint.of_corners(np.array([[0.5, 0.1], [0.5, -0.1], [-0.5, -0.1], [-0.5, 0.1]]))
PERIOD = 0.1


def run(behavior, command, costmap, pose=(0.0, 0.0, 0.3), limit=30.0):
    """Run a behaviour until it is done; return the last pose, the time and the velocities."""
    pose, velocity, now, velocities = np.array(pose, dtype=float), np.zeros(3), 0.0, []
    behavior.start(command, pose, now)
    while now < limit:
        step = behavior.step(pose, velocity, costmap, now)
        if step.done:
            assert not step.velocity.any()
            return pose, now, np.array(velocities).reshape(-1, 3)
        velocity = step.velocity
        velocities.append(velocity)
        pose = pose + PERIOD * np.array([velocity[0] * math.cos(pose[2]), velocity[0] * math.sin(pose[2]), velocity[2]])
        pose[2] = (pose[2] + math.pi) % (2.0 * math.pi) - math.pi
        now += PERIOD
    raise AssertionError("the behaviour goes on for ever")


@pytest.mark.parametrize("angle", [1.57, -1.57, 6.28, -9.0, 0.1])
def test_a_spin_turns_by_its_angle_however_large(angle):
    _, now, velocities = run(
        Spin(None, NavigationContext(footprint=ROUND, frequency=10.0)), SpinCommand(angle, 20.0), ground()
    )
    assert PERIOD * velocities[:, 2].sum() == pytest.approx(angle, abs=0.025)
    assert not velocities[:, :2].any()
    assert np.abs(velocities[:, 2]).max() <= 1.0 + 1e-9
    assert now < abs(angle) + 2.0


def test_a_spin_that_takes_too_long_is_ended():
    with pytest.raises(TimedOut, match=r"rad of 6\.28 in time"):
        run(Spin(None, NavigationContext(footprint=ROUND, frequency=10.0)), SpinCommand(6.28, 2.0), ground())


def test_a_long_robot_does_not_spin_into_a_wall():
    wall = ground([(x, 0.4) for x in np.arange(-1.0, 1.0, 0.04)], radius=0.1)
    with pytest.raises(CollisionAhead):
        run(
            Spin(None, NavigationContext(footprint=LONG, frequency=10.0)), SpinCommand(1.57), wall, pose=(0.0, 0.0, 0.0)
        )
    run(Spin(None, NavigationContext(footprint=ROUND, frequency=10.0)), SpinCommand(1.57), wall, pose=(0.0, 0.0, 0.0))


def test_backing_up_goes_straight_back():
    pose, now, _ = run(
        BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)), BackUpCommand(0.3, 0.1), ground()
    )
    assert np.allclose(pose, [-0.3 * math.cos(0.3), -0.3 * math.sin(0.3), 0.3], atol=0.011)
    assert now == pytest.approx(3.0, abs=0.3)


def test_driving_on_heading_goes_straight_ahead():
    pose, _, velocities = run(
        DriveOnHeading(None, NavigationContext(footprint=ROUND, frequency=10.0)),
        DriveOnHeadingCommand(0.4, 0.2),
        ground(),
    )
    assert math.hypot(pose[0], pose[1]) == pytest.approx(0.4, abs=0.011)
    assert velocities[:, 0].max() == pytest.approx(0.2)


def test_an_obstacle_behind_is_seen_before_it_is_touched():
    costmap = ground([(-0.5, 0.0)])
    with pytest.raises(CollisionAhead):
        run(
            BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)),
            BackUpCommand(0.5, 0.1),
            costmap,
            pose=(0.0, 0.0, 0.0),
        )
    run(
        BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)),
        BackUpCommand(0.2, 0.1),
        costmap,
        pose=(0.0, 0.0, 0.0),
    )


def test_a_robot_that_touches_an_obstacle_may_back_away():
    run(
        BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)),
        BackUpCommand(0.2, 0.1),
        ground([(0.15, 0.0)]),
        pose=(0.0, 0.0, 0.0),
    )


def test_backing_up_too_slowly_is_ended():
    with pytest.raises(TimedOut, match="in time"):
        run(BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)), BackUpCommand(1.0, 0.01, 5.0), ground())


@pytest.mark.parametrize(
    ("behavior", "command"),
    [
        (BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)), BackUpCommand(-0.1, 0.1)),
        (BackUp(None, NavigationContext(footprint=ROUND, frequency=10.0)), BackUpCommand(0.1, 0.0)),
        (DriveOnHeading(None, NavigationContext(footprint=ROUND, frequency=10.0)), DriveOnHeadingCommand(0.1, -0.1)),
        (Spin(None, NavigationContext(footprint=ROUND, frequency=10.0)), SpinCommand(math.nan)),
        (Wait(None, NavigationContext(footprint=ROUND, frequency=10.0)), WaitCommand(-1.0)),
        (Wait(None, NavigationContext(footprint=ROUND, frequency=10.0)), WaitCommand(math.nan)),
    ],
)
def test_commands_that_make_no_sense_are_refused(behavior, command):
    with pytest.raises(InvalidInput):
        behavior.start(command, np.zeros(3), 0.0)


def test_waiting_takes_its_time():
    _, now, velocities = run(Wait(None, NavigationContext(footprint=ROUND, frequency=10.0)), WaitCommand(2.0), ground())
    assert now == pytest.approx(2.0, abs=PERIOD)
    assert not velocities.any()


def test_contact_ahead_follows_arcs():
    costmap = ground([(0.6, 0.6)])
    assert contact_ahead(costmap, ROUND, np.zeros(3), 0.5, 0.8, 2.0)
    assert not contact_ahead(costmap, ROUND, np.zeros(3), 0.5, -0.8, 2.0)
    assert not contact_ahead(costmap, ROUND, np.zeros(3), 0.5, 0.8, 0.3)


class TestAssistedTeleop:
    def behave(self, costmap, *, speed=0.4, now=10.0, sent=10.0, **goal):
        behavior = AssistedTeleop(None, NavigationContext(footprint=Footprint.circle(0.2), frequency=10.0))
        behavior.start(goal.get("time_allowance", 0.0), np.array([2.0, 2.0, 0.0]), 9.0)
        behavior.add_command(np.array([speed, 0.0, 0.0]), sent)
        return behavior, behavior.step(np.array([2.0, 2.0, 0.0]), np.zeros(3), costmap, now)

    def ground(self, *, wall_at=None):
        costmap = Costmap.filled(80, 80, 0.05, (0.0, 0.0))
        if wall_at is not None:
            column = round(wall_at / 0.05)
            costmap.costs[:, column:] = 254
            costmap.costs[:, column - 4 : column] = 253
        return costmap

    def test_a_velocity_on_free_ground_is_passed_on(self):
        _, step = self.behave(self.ground())
        assert step.velocity.tolist() == [0.4, 0.0, 0.0]
        assert not step.done
        assert step.feedback == pytest.approx(1.0)

    def test_it_slows_down_in_proportion_to_the_time_until_a_contact(self):
        _, step = self.behave(self.ground(wall_at=2.4))
        assert 0.1 < step.velocity[0] <= 0.2
        _, step = self.behave(self.ground(wall_at=2.25))
        assert step.velocity[0] < 0.05

    @pytest.mark.parametrize(("sent", "speed"), [(9.4, 0.4), (11.0, 0.4), (10.0, np.nan)])
    def test_it_stands_where_the_persons_velocity_is_old_ahead_or_not_finite(self, sent, speed):
        _, step = self.behave(self.ground(), sent=sent, speed=speed)
        assert not step.velocity.any()

    def test_it_ends_when_told_and_fails_when_its_time_is_over(self):
        behavior, _ = self.behave(self.ground())
        behavior.end()
        assert behavior.step(np.zeros(3), np.zeros(3), self.ground(), 10.1).done
        with pytest.raises(TimedOut):
            self.behave(self.ground(), time_allowance=0.5)
