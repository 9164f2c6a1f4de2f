"""The filter in a world: it tracks, it finds, it notices that it was carried away."""

import math

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError
from daidalos.common.pose2 import compose, inverse, wrap
from daidalos.localization.amcl import Amcl
from daidalos.localization.config import AmclConfig
from daidalos.localization.errors import LocalizationError
from daidalos.mapping.scan import LaserScanData
from navigation.flat_world import FlatRobot, arena

from .wandering import Wanderer, map_of

WORLD = arena()
MAP = map_of(WORLD, 8.0, 6.0)
START = np.array([1.5, 1.5, 0.3])
NEAR = np.diag([0.1, 0.1, 0.05])
GOOD_ODOMETRY = {f"alpha{k}": 0.02 for k in range(1, 6)}


def wandering_from_start(seed=0):
    return Wanderer(FlatRobot(WORLD, START.copy(), beams=180, max_range=12.0, seed=seed), seed)


def errors(filter_, wanderer, steps):
    """Position and yaw errors of the estimates while the robot wanders; shape (steps, 2)."""
    result = np.empty((steps, 2))
    for k in range(steps):
        odometry, scan, truth = wanderer.step()
        pose = filter_.update(odometry, scan).pose
        result[k] = math.hypot(*(pose - truth)[:2]), abs(float(wrap(pose[2] - truth[2])))
    return result


@pytest.mark.slow
@pytest.mark.parametrize("model", ["likelihood_field", "likelihood_field_prob", "beam"])
def test_a_robot_is_tracked(model):
    filter_ = Amcl(AmclConfig(laser_model_type=model), MAP, seed=1)
    filter_.initialize(START, NEAR)
    tracked = errors(filter_, wandering_from_start(1), 300)
    rms = np.sqrt((tracked[50:] ** 2).mean(axis=0))
    assert rms[0] < 0.1
    assert rms[1] < 0.08
    assert tracked[:, 0].max() < 0.4


def test_odometry_alone_would_be_lost():
    wanderer = wandering_from_start(1)
    for _ in range(600):
        odometry, _, truth = wanderer.step()
    assert math.hypot(*(compose(START, odometry) - truth)[:2]) > 0.3


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_robot_is_found_anywhere(seed):
    filter_ = Amcl(AmclConfig(), MAP, seed)
    filter_.global_localization()
    found = errors(filter_, wandering_from_start(seed), 400)
    assert found[0, 0] > 0.3
    assert found[-100:, 0].max() < 0.3
    assert found[-100:, 1].max() < 0.3


@pytest.mark.slow
@pytest.mark.parametrize(("alphas", "finds_itself"), [((0.001, 0.1), True), ((0.0, 0.0), False)])
def test_a_robot_that_was_carried_away_finds_itself_with_recovery(alphas, finds_itself):
    config = AmclConfig(recovery_alpha_slow=alphas[0], recovery_alpha_fast=alphas[1], **GOOD_ODOMETRY)
    filter_ = Amcl(config, MAP, seed=1)
    filter_.initialize(START, NEAR)
    wanderer = wandering_from_start(1)
    errors(filter_, wanderer, 300)
    wanderer.carry((6.5, 3.8, 2.0))
    carried = errors(filter_, wanderer, 900)
    assert carried[0, 0] > 3.0
    assert bool(carried[-100:, 0].max() < 0.3) is finds_itself


@pytest.mark.slow
def test_particles_are_fewer_when_the_robot_is_sure():
    config = AmclConfig(recovery_alpha_slow=0.0, recovery_alpha_fast=0.0, **GOOD_ODOMETRY)
    filter_ = Amcl(config, MAP, seed=2)
    filter_.global_localization()
    wanderer = wandering_from_start(2)
    counts = []
    for _ in range(400):
        odometry, scan, _ = wanderer.step()
        counts.append(filter_.update(odometry, scan).weights.size)
    assert counts[0] == 2000
    assert 500 <= counts[-1] < 1000


def test_while_the_robot_stands_scans_are_not_used_unless_asked_for():
    filter_ = Amcl(AmclConfig(updates_after_initial_pose=2), MAP)
    filter_.initialize(START, NEAR)
    scan = wandering_from_start().robot.scan()
    assert filter_.update(np.zeros(3), scan).updated
    assert filter_.update(np.zeros(3), scan).updated
    assert not filter_.update(np.array([0.1, 0.0, 0.1]), scan).updated
    filter_.request_nomotion_update()
    assert filter_.update(np.array([0.1, 0.0, 0.1]), scan).updated
    assert filter_.update(np.array([0.4, 0.0, 0.1]), scan).updated
    assert filter_.update(np.array([0.4, 0.0, 0.4]), scan).updated


def test_between_scans_the_pose_follows_odometry():
    filter_ = Amcl(AmclConfig(updates_after_initial_pose=1), MAP)
    filter_.initialize(START, NEAR)
    scan = wandering_from_start().robot.scan()
    at_rest = filter_.update(np.zeros(3), scan)
    ahead = filter_.update(np.array([0.2, 0.0, 0.0]), scan)
    assert np.allclose(ahead.pose, compose(at_rest.pose, np.array([0.2, 0.0, 0.0])))
    assert np.allclose(compose(ahead.map_to_odom, np.array([0.2, 0.0, 0.0])), ahead.pose)


def test_an_estimate_is_consistent():
    filter_ = Amcl(AmclConfig(), MAP)
    filter_.initialize(START, NEAR)
    estimate = filter_.update(np.zeros(3), wandering_from_start().robot.scan())
    assert estimate.weights.sum() == pytest.approx(1.0)
    assert estimate.particles.shape == (estimate.weights.size, 3)
    assert np.allclose(estimate.covariance, estimate.covariance.T)
    assert (np.linalg.eigvalsh(estimate.covariance) >= -1e-12).all()


def test_the_same_seed_gives_the_same_run():
    runs = []
    for _ in range(2):
        filter_ = Amcl(AmclConfig(), MAP, seed=5)
        filter_.initialize(START, NEAR)
        runs.append(errors(filter_, wandering_from_start(5), 40))
    assert np.array_equal(*runs)


def test_scans_that_say_nothing_do_no_harm():
    filter_ = Amcl(AmclConfig(), MAP)
    filter_.initialize(START, np.diag([1e-4, 1e-4, 1e-4]))
    for ranges in (np.full(10, np.nan), np.full(10, np.inf), np.zeros(0)):
        filter_.request_nomotion_update()
        estimate = filter_.update(np.zeros(3), LaserScanData(ranges, 0.0, 0.1, 0.1, 10.0))
        assert np.allclose(estimate.pose, START, atol=0.05)


def test_another_map_is_taken_over_and_a_bad_one_is_not():
    filter_ = Amcl(AmclConfig(), MAP)
    filter_.set_map(MAP)
    with pytest.raises(LocalizationError):
        filter_.set_map(type(MAP)(np.zeros((3, 3), dtype=np.int8), 0.1, (0.0, 0.0, 0.0)))
    filter_.initialize(START, NEAR)
    assert filter_.update(np.zeros(3), wandering_from_start().robot.scan()).updated


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"min_particles": 10, "max_particles": 5}, "min_particles"),
        ({"max_beams": 1}, "max_beams"),
        ({"pf_z": 0.0}, "pf_z"),
        ({"recovery_alpha_slow": 0.2, "recovery_alpha_fast": 0.1}, "recovery_alpha_slow"),
        ({"alpha3": -0.1}, "alpha3"),
        ({"sigma_hit": 0.0}, "sigma_hit"),
    ],
)
def test_parameters_that_make_no_sense_are_refused(values, words):
    with pytest.raises(ParameterError, match=words):
        AmclConfig(**values)


def test_unknown_models_are_named_with_the_known():
    with pytest.raises(ParameterError, match=r"'laser_model_type' must be one of likelihood_field, .*, got 'laser'"):
        AmclConfig(laser_model_type="laser")
    with pytest.raises(ParameterError, match="'robot_model_type' must be one of"):
        AmclConfig(robot_model_type="ackermann")


def test_an_initial_pose_must_be_finite():
    with pytest.raises(LocalizationError, match="finite"):
        Amcl(AmclConfig(), MAP).initialize(np.array([np.nan, 0.0, 0.0]), NEAR)


def test_a_standing_robot_is_found_from_a_guess_aside():
    filter_ = Amcl(AmclConfig(), MAP, seed=3)
    scan = wandering_from_start(3).robot.scan()
    filter_.initialize(START + np.array([0.5, -0.4, 0.3]), np.diag([0.25, 0.25, 0.07]))
    for _ in range(10):
        pose = filter_.update(np.zeros(3), scan).pose
    assert math.hypot(*(pose - START)[:2]) < 0.05
    assert abs(float(wrap(pose[2] - START[2]))) < 0.05


@pytest.mark.parametrize("covariance", [np.diag([-1.0, 0.1, 0.1]), np.array([[0.1, 5, 0], [5, 0.1, 0], [0, 0, 0.1]])])
def test_a_covariance_that_is_none_is_replaced_by_the_nearest(covariance):
    filter_ = Amcl(AmclConfig(), MAP, seed=3)
    filter_.initialize(START, covariance)
    estimate = filter_.update(np.zeros(3), wandering_from_start(3).robot.scan())
    assert np.isfinite(estimate.particles).all()


def test_parameters_change_while_it_runs():
    filter_ = Amcl(AmclConfig(), MAP, seed=4)
    filter_.initialize(START, NEAR)
    wanderer = wandering_from_start(4)
    errors(filter_, wanderer, 20)
    filter_.reconfigure(AmclConfig(recovery_alpha_slow=0.0, max_particles=700, refine_pose=False))
    assert errors(filter_, wanderer, 60)[20:, 0].max() < 0.3
    assert filter_.update(*wanderer.step()[:2]).weights.size <= 700


def test_a_map_of_another_resolution_continues():
    filter_ = Amcl(AmclConfig(), MAP, seed=5)
    filter_.initialize(START, NEAR)
    wanderer = wandering_from_start(5)
    errors(filter_, wanderer, 20)
    coarse = MAP.data[: MAP.data.shape[0] // 2 * 2, : MAP.data.shape[1] // 2 * 2]
    coarse = np.maximum.reduce([coarse[i::2, j::2] for i in (0, 1) for j in (0, 1)])
    filter_.set_map(type(MAP)(coarse, 2 * MAP.resolution, MAP.origin))
    assert errors(filter_, wanderer, 60)[20:, 0].max() < 0.3


def test_the_seed_is_a_parameter():
    drawn = [Amcl(AmclConfig(random_seed=seed), MAP)._particles for seed in (1, 1, 2)]
    assert np.array_equal(drawn[0], drawn[1])
    assert not np.array_equal(drawn[0], drawn[2])


@pytest.mark.parametrize("robot_moved", [True, False])
def test_a_jump_of_odometry_is_followed_if_the_scan_says_so(robot_moved):
    filter_ = Amcl(AmclConfig(), MAP, seed=6)
    filter_.initialize(START, NEAR)
    wanderer = wandering_from_start(6)
    errors(filter_, wanderer, 30)
    before = wanderer.step()[0]
    if robot_moved:
        there = np.array([6.5, 3.8, 2.0])
        jumped = compose(before, compose(inverse(wanderer.robot.pose), there))
        wanderer.carry(there)
    else:
        jumped = np.zeros(3)
    filter_.update(jumped, wanderer.robot.scan(), odometry_jumped=True)
    for _ in range(10):
        filter_.request_nomotion_update()
        pose = filter_.update(jumped, wanderer.robot.scan()).pose
    assert math.hypot(*(pose - wanderer.robot.pose)[:2]) < 0.1


def test_selective_resampling_keeps_the_weights_until_few_particles_carry_them():
    weights = []
    for selective in (False, True):
        filter_ = Amcl(AmclConfig(selective_resampling=selective), MAP, seed=7)
        filter_.initialize(START, np.diag([1e-6, 1e-6, 1e-6]))
        weights.append(filter_.update(np.zeros(3), wandering_from_start(7).robot.scan()).weights)
    assert np.ptp(weights[0]) == 0.0
    assert np.ptp(weights[1]) > 0.0
