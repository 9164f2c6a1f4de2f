"""The controller as a whole: it goes where it should, around what is in the way, or says that it cannot."""

import numpy as np
import pytest

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.mppi.validators.default_optimal_trajectory_validator import (
    DefaultOptimalTrajectoryValidator,
    DefaultOptimalTrajectoryValidatorParameters,
)
from daidalos.navigation.controllers.mppi_controller import (
    AckermannConstraints,
    MppiController,
    MppiParameters,
    VisualizerParameters,
)
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl

from .scenes import control, ground, line

ROBOT = Footprint.circle(0.2)


def drive(path, costmap, cycles=120, **more):
    """Simulate a perfect robot that follows; return its poses and velocities."""
    controller = MppiController(MppiParameters(**more), NavigationContext(footprint=ROBOT))
    pose, velocity, poses, velocities = np.zeros(3), np.zeros(3), [], []
    for _ in range(cycles):
        passed = int(np.argmin(np.hypot(*(path[:, :2] - pose[:2]).T)))
        velocity = controller.compute_velocity_commands(control(path[passed:], costmap, pose, velocity))
        c, s = np.cos(pose[2] + 0.5 * velocity[2] * 0.05), np.sin(pose[2] + 0.5 * velocity[2] * 0.05)
        vx, vy, turn = velocity
        pose = pose + 0.05 * np.array([vx * c - vy * s, vx * s + vy * c, turn])
        poses.append(pose)
        velocities.append(velocity)
    return np.array(poses), np.array(velocities)


def test_a_straight_path_is_followed_straight_and_fast():
    poses, velocities = drive(line((2.5, 0.0)), ground(), 80)
    assert np.abs(poses[:, 1]).max() < 0.03
    assert velocities[20:60, 0].mean() > 0.4
    assert np.abs(velocities[10:60, 2]).mean() < 0.15


@pytest.mark.slow
def test_it_stops_at_the_goal():
    poses, velocities = drive(line((2.0, 0.0)), ground(), 140)
    assert np.hypot(*(poses[-1, :2] - (2.0, 0.0))) < 0.1
    assert np.abs(velocities[-10:, 0]).max() < 0.1


def test_limits_of_velocity_and_acceleration_hold():
    _, velocities = drive(line((1.0, 1.5)), ground(), 80, vx_max=0.26, wz_max=1.0)
    assert velocities[:, 0].max() <= 0.26 + 1e-6
    assert np.abs(velocities[:, 2]).max() <= 1.0 + 1e-6
    steps = np.abs(np.diff(velocities, axis=0, prepend=np.zeros((1, 3))))
    assert steps[:, 0].max() <= 2.5 * 0.05 + 1e-5
    assert steps[:, 2].max() <= 3.2 * 0.05 + 1e-5


@pytest.mark.slow
def test_it_drives_around_what_the_planner_did_not_know():
    costmap = ground([(1.2, 0.02), (1.25, 0.02)])
    poses, _ = drive(line((2.5, 0.0)), costmap, 160)
    assert np.hypot(*(poses[-1, :2] - (2.5, 0.0))) < 0.3
    assert min(np.hypot(*(p[:2] - (1.22, 0.02))) for p in poses) > 0.2


def test_contact_that_can_not_be_avoided_is_told():
    wall = ground([(0.33, y) for y in np.arange(-2.0, 2.0, 0.04)])
    fast = control(line((2.5, 0.0)), wall, velocity=(1.0, 0.0, 0.0))
    with pytest.raises(NoValidControl, match="touch an obstacle"):
        MppiController(MppiParameters(vx_max=1.0), NavigationContext(footprint=ROBOT)).compute_velocity_commands(fast)


def test_in_a_closet_it_stands():
    around = np.arange(-0.24, 0.25, 0.03)
    walls = [(x, y) for x in around for y in around if max(abs(x), abs(y)) > 0.2]
    poses, _ = drive(line((2.5, 0.0)), ground(walls), 40)
    assert np.hypot(*poses[-1, :2]) < 0.1


def test_the_same_seed_drives_the_same_way():
    once, again = (drive(line((1.5, 0.5)), ground(), 20)[1] for _ in range(2))
    assert np.array_equal(once, again)


def test_speed_limits_and_their_end():
    controller = MppiController(None, NavigationContext(footprint=ROBOT))
    given = control(line((2.5, 0.0)), velocity=(0.1, 0.0, 0.0))
    controller.set_speed_limit(0.1, percentage=False)
    assert controller.compute_velocity_commands(given)[0] <= 0.1 + 1e-6
    controller.set_speed_limit(0.0, percentage=False)
    assert controller.compute_velocity_commands(given)[0] > 0.15


def test_the_predicted_trajectory_begins_at_the_robot():
    controller = MppiController(None, NavigationContext(footprint=ROBOT))
    controller.compute_velocity_commands(control(line((2.5, 0.0))))
    assert controller.trajectory.shape == (56, 3)
    assert np.hypot(*controller.trajectory[0, :2]) < 0.05
    assert controller.trajectory[-1, 0] > 0.5


@pytest.mark.slow
def test_a_robot_that_moves_sideways_does():
    poses, velocities = drive(line((0.0, 1.5), heading=0.0), ground(), 120, motion_model="Omni")
    assert np.hypot(*(poses[-1, :2] - (0.0, 1.5))) < 0.15
    assert np.abs(velocities[:, 1]).max() > 0.3
    assert np.abs(velocities[:, 1]).max() <= 0.5 + 1e-6


@pytest.mark.slow
def test_a_robot_that_steers_keeps_to_its_circle():
    constraints = AckermannConstraints(min_turning_r=0.5)
    poses, velocities = drive(line((2.0, 0.6)), ground(), 160, motion_model="Ackermann", ackermann=constraints)
    assert np.hypot(*(poses[-1, :2] - (2.0, 0.6))) < 0.3
    assert (np.abs(velocities[:, 2]) <= 2.0 * np.abs(velocities[:, 0]) + 1e-5).all()


def test_noise_that_is_not_drawn_again_is_the_same_in_each_cycle():
    given = control(line((2.5, 0.0)))
    same, other = (
        MppiController(MppiParameters(regenerate_noises=again, open_loop=False), NavigationContext(footprint=ROBOT))
        for again in (False, True)
    )
    for controller, equal in ((same, True), (other, False)):
        first = controller.compute_velocity_commands(given)
        controller.reset()
        assert np.array_equal(first, controller.compute_velocity_commands(given)) == equal


def shown(controller):
    return {output.topic: output.give() for output in controller.outputs}


def test_what_is_shown_of_a_cycle():
    parameters = MppiParameters(visualize=True, visualizer=VisualizerParameters(trajectory_step=10, time_step=4))
    controller = MppiController(parameters, NavigationContext(footprint=ROBOT))
    assert set(shown(controller).values()) == {None}
    path = line((2.5, 0.0))
    controller.compute_velocity_commands(control(path, ground()))
    outputs = shown(controller)
    assert outputs["trajectories"].points.shape == (100, 14, 2)
    assert outputs["trajectories"].costs.shape == (100,)
    assert np.array_equal(outputs["transformed_global_plan"], path)
    assert outputs["optimal_trajectory"].shape == (56, 3)
    controller.reconfigure(MppiParameters(publish_optimal_trajectory=True))
    assert [topic for topic, value in shown(controller).items() if value is not None] == ["optimal_trajectory"]
    controller.reconfigure(MppiParameters())
    assert all(value is None for value in shown(controller).values())


class Refusing(DefaultOptimalTrajectoryValidator):
    """A validator that refuses everything, and keeps the scene."""

    def is_valid(self, trajectory, scene):
        self.scene = scene
        return False


def test_what_the_validator_refuses_is_not_driven():
    controller = MppiController(MppiParameters(), NavigationContext(footprint=ROBOT))
    controller._validator = Refusing()
    with pytest.raises(NoValidControl):
        controller.compute_velocity_commands(control(line((2.5, 0.0)), ground()))


@pytest.mark.parametrize(
    ("seconds", "outline", "x", "y", "is_valid"),
    [
        (2.0, False, 0.5, 0.0, False),
        (0.5, False, 0.5, 0.0, True),
        (0.0, False, 0.5, 0.0, True),
        (2.0, False, 0.5, 0.27, True),
        (2.0, True, 0.5, 0.27, False),
        (2.0, True, 0.5, 0.8, True),
    ],
)
def test_the_validator_looks_for_contact_in_the_next_seconds(seconds, outline, x, y, is_valid):
    wide = Footprint.of_corners(np.array([[0.2, 0.3], [0.2, -0.3], [-0.2, -0.3], [-0.2, 0.3]]))
    controller = MppiController(MppiParameters(), NavigationContext(footprint=wide))
    seen = controller._validator = Refusing(None, NavigationContext(footprint=wide))
    with pytest.raises(NoValidControl):
        controller.compute_velocity_commands(control(line((2.5, 0.0)), ground([(x, y)])))
    ahead = np.stack([np.arange(0.0, 1.4, 0.025), np.zeros(56), np.zeros(56)], axis=-1)
    parameters = DefaultOptimalTrajectoryValidatorParameters(
        collision_lookahead_time=seconds, consider_footprint=outline
    )
    assert DefaultOptimalTrajectoryValidator(parameters).is_valid(ahead, seen.scene) is is_valid
