"""Identification of stiffness, backlash and friction, from exact data and from the simulated cell."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.common.documents import DocumentError
from daidalos.industry.elasticity.deflection import Options, load
from daidalos.industry.elasticity.identification import identify, identify_friction, read_friction_runs
from daidalos.industry.elasticity.load_tests import LoadTest, as_csv, design, information, read_load_test
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.welding.simulated_cell import drawn
from daidalos.industry.welding.simulated_load_test import friction_runs, measure

from .cells import ARM, ELASTICITY

BESIDE = np.eye(4)
BESIDE[:3, 3] = [0.3, 0.0, 0.5]
ARCMIN = np.pi / 10800.0
PLAN = design(ARM, ELASTICITY, BESIDE, 10, 3000.0, 0)


def exact(truth, test=PLAN, noise=0.0):
    """Return what the formula says, each load on its own."""
    places = []
    for joints, wrench in zip(test.joints, test.wrenches, strict=True):
        turn = (forward(ARM, joints) @ BESIDE)[:3, :3]
        for _ in range(3):
            in_tool = np.concatenate([wrench[:3] @ turn, wrench[3:] @ turn])[None]
            state = load(ARM, truth, joints[None], BESIDE, in_tool, np.zeros((1, 6)), Options(gravity=True))
            turn = state.poses[0, :3, :3]
        places.append(state.poses[0, :3, 3])
    measured = np.array(places) + np.random.default_rng(0).normal(size=(len(places), 3)) * noise
    return replace(test, places=measured)


def test_exact_measurements_give_the_parameters_back():
    truth = drawn(ELASTICITY, 5)
    truth = replace(truth, balancing=ELASTICITY.balancing, backlash=np.array([5.0, 1.0, 2.0, 1.0, 3.0, 4.0]) * ARCMIN)
    found = identify(ARM, ELASTICITY, exact(truth), BESIDE)
    np.testing.assert_allclose(found.stiffness, truth.stiffness, rtol=2e-3)
    np.testing.assert_allclose(found.backlash, truth.backlash, atol=0.005 * ARCMIN)
    assert found.condition < 30


def test_the_confidence_is_that_of_the_noise():
    """The estimates miss the truth as often as their deviations say."""
    clean = exact(ELASTICITY)
    rng = np.random.default_rng(1)
    misses = []
    for _ in range(12):
        noisy = replace(clean, places=clean.places + rng.normal(size=clean.places.shape) * 2e-5)
        found = identify(ARM, ELASTICITY, noisy, BESIDE)
        misses.append((found.stiffness - ELASTICITY.stiffness) / found.stiffness_deviation)
        assert found.noise == pytest.approx(2e-5, rel=0.25)
    assert np.sqrt(np.mean(np.square(misses))) == pytest.approx(1.0, abs=0.3)


def test_the_simulated_robot_is_identified():
    truth = drawn(ELASTICITY.with_tool(0.0), 0)
    found = identify(ARM, ELASTICITY, measure(ARM, truth, PLAN, BESIDE, 0), BESIDE)
    errors = np.abs(found.stiffness / truth.stiffness - 1.0)
    assert (errors[[0, 4]] < 0.02).all()
    assert (errors < 0.1).all()
    assert (np.abs(found.backlash - truth.backlash) < 0.35 * ARCMIN).all()
    assert abs(found.backlash[0] - truth.backlash[0]) < 0.1 * ARCMIN
    assert found.noise < 1e-4


def test_a_wrong_measurement_is_left_out():
    test = exact(ELASTICITY, noise=1e-5)
    places = test.places.copy()
    places[7] += 0.02
    found = identify(ARM, ELASTICITY, replace(test, places=places), BESIDE)
    np.testing.assert_allclose(found.stiffness, ELASTICITY.stiffness, rtol=0.08)


def test_the_design_is_better_than_random_poses():
    chosen = np.linalg.slogdet(information(ARM, ELASTICITY, PLAN, BESIDE))[1]
    rng = np.random.default_rng(0)
    for _ in range(5):
        joints = np.repeat(rng.uniform(*(0.95 * ARM.limits.T), (10, 6)), 12, axis=0)
        other = LoadTest(PLAN.poses, joints, PLAN.wrenches)
        assert np.linalg.slogdet(information(ARM, ELASTICITY, other, BESIDE))[1] < chosen


def test_loads_that_tell_nothing_of_an_axis_are_refused():
    straight = np.eye(4)
    straight[2, 3] = 0.5
    with pytest.raises(ValueError, match=r"no poses load all axes"):
        design(ARM, ELASTICITY, straight, 10, 3000.0, 0)
    with pytest.raises(ValueError, match=r"too few|do not tell"):
        identify(
            ARM,
            ELASTICITY,
            LoadTest(*(part[:14] for part in (PLAN.poses, PLAN.joints, PLAN.wrenches)), np.zeros((14, 3))),
            BESIDE,
        )
    test = exact(ELASTICITY)
    mirrored = replace(test, wrenches=-test.wrenches)
    with pytest.raises(ValueError, match=r"gives? way against its torque"):
        identify(ARM, replace(ELASTICITY, mass=np.zeros(6), balancing=np.zeros(6)), mirrored, BESIDE)


def test_load_tests_are_written_and_read(tmp_path):
    test = replace(PLAN, places=np.random.default_rng(0).normal(size=(len(PLAN.poses), 3)))
    (tmp_path / "a.csv").write_text(as_csv(test))
    again = read_load_test(tmp_path / "a.csv", measured=True)
    np.testing.assert_allclose(again.places, test.places, atol=1e-8)
    np.testing.assert_allclose(again.joints, test.joints, atol=1e-7)
    (tmp_path / "b.csv").write_text(as_csv(PLAN))
    with pytest.raises(DocumentError, match=r"has no column 'x_mm'"):
        read_load_test(tmp_path / "b.csv", measured=True)
    lines = as_csv(test).splitlines()
    lines[2] = "1,9.5" + lines[2][lines[2].index(",", 2) :]
    (tmp_path / "c.csv").write_text("\n".join(lines))
    with pytest.raises(DocumentError, match=r"c.csv:3: pose 1 has rows with other angles"):
        read_load_test(tmp_path / "c.csv", measured=True)


def test_friction_is_told_from_runs_at_constant_speed(tmp_path):
    truth = drawn(ELASTICITY, 2)
    (tmp_path / "runs.csv").write_text(friction_runs(truth, 2))
    runs = read_friction_runs(tmp_path / "runs.csv")
    assert list(runs) == [1, 2, 3, 4, 5, 6]
    for axis in runs:
        found = identify_friction(runs[axis])
        expected = [truth.coulomb_friction, truth.breakaway_friction, truth.stribeck_speed, truth.viscous_friction]
        np.testing.assert_allclose(found.values[:2], [value[axis - 1] for value in expected[:2]], rtol=0.12)
        np.testing.assert_allclose(found.values[3], expected[3][axis - 1], rtol=0.25)
    with pytest.raises(ValueError, match=r"both directions"):
        identify_friction(runs[1][runs[1][:, 0] > 0])
    (tmp_path / "bad.csv").write_text("axis,speed_deg_s,torque_nm\n7,1,1\n")
    with pytest.raises(DocumentError, match=r"bad.csv:2: 'axis' must be 1 to 6"):
        read_friction_runs(tmp_path / "bad.csv")
