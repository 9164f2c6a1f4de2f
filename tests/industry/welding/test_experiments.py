"""The simulated cell: its springs and play against closed forms, and the workshop's experiments in it."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.industry.elasticity.deflection import Options, load
from daidalos.industry.welding.comparison import curve_rows, line_rows, within_tolerance, zone_means
from daidalos.industry.welding.experiments import run_experiment
from daidalos.industry.welding.nine_zones import nine_zone_curve, straight_line
from daidalos.industry.welding.report import experiment_report
from daidalos.industry.welding.simulated_cell import TIMESTEP, SimulatedCell, drawn

from .cells import ARM, ELASTICITY, WRENCH, cell, tool

MOTORS = np.radians([5.0, 37.5, -35.4, -2.5, 88.3, 96.0])


def settle(simulated, wrench, motors=MOTORS, seconds=3.0):
    count = int(seconds / TIMESTEP)
    return simulated.run(np.tile(motors, (count, 1)), np.tile(wrench, (count, 1)), 0.1)


@pytest.mark.parametrize("gravity", [False, True])
def test_the_simulated_joints_settle_where_the_formula_says(gravity):
    simulated = SimulatedCell(ARM, ELASTICITY, tool(), gravity, friction=False)
    run = settle(simulated, WRENCH)
    options = Options(gravity=gravity)
    loaded = load(ARM, ELASTICITY, MOTORS[None], tool(), WRENCH[None], np.zeros((1, 6)), options)
    np.testing.assert_allclose(run.positions[-1], loaded.poses[0, :3, 3], atol=1e-6)
    np.testing.assert_allclose(run.joints[-1], loaded.joints[0], atol=1e-6)


def test_within_its_play_a_joint_is_free_and_friction_holds_it():
    wide = replace(ELASTICITY, backlash=np.array([0.02, 0, 0, 0, 0, 0.0]), coulomb_friction=np.full(6, 60.0))
    simulated = SimulatedCell(ARM, wide, tool(), friction=True)
    light = settle(simulated, np.array([10.0, 10.0, 0, 0, 0, 0]))
    assert abs(light.joints[-1, 0] - MOTORS[0]) < 1e-4
    pushed = settle(simulated, WRENCH, seconds=4.0)
    torque = load(ARM, wide, MOTORS[None], tool(), WRENCH[None], np.zeros((1, 6)), Options()).torques[0, 0]
    past = abs(pushed.joints[-1, 0] - MOTORS[0]) - 0.01
    assert past == pytest.approx(abs(torque) / wide.stiffness[0], abs=61.0 / wide.stiffness[0])


def test_a_drawn_robot_is_within_its_uncertainty():
    truth = drawn(ELASTICITY, 3)
    assert (np.abs(truth.stiffness - ELASTICITY.stiffness) <= 2.0 * ELASTICITY.uncertainty["stiffness"]).all()
    assert not np.allclose(truth.stiffness, ELASTICITY.stiffness)
    np.testing.assert_array_equal(drawn(ELASTICITY, 3).backlash, truth.backlash)


@pytest.mark.slow
def test_the_line_is_as_straight_as_in_the_workshop():
    done = run_experiment(cell(Options(friction=True)), drawn(ELASTICITY, 0), straight_line(), 0)
    uncorrected, corrected = 1e3 * done.welds["uncorrected"].rms, 1e3 * done.welds["corrected"].rms
    assert 2.3 <= uncorrected[1] <= 2.5
    assert uncorrected[2] == pytest.approx(5.9, abs=0.3)
    assert corrected[1] <= 0.27
    assert corrected[2] <= 0.27
    rows = line_rows(done)
    assert len(rows) == 10
    page = experiment_report(done, rows, "line")
    assert page.count("<svg") == 4
    assert all(row.printed in page for row in rows)


@pytest.mark.slow
def test_the_correction_of_backlash_keeps_the_curve_within_the_tolerance():
    done = run_experiment(cell(Options(friction=True)), drawn(ELASTICITY, 0), nine_zone_curve(), 0)
    low, high = done.welds["without_backlash"].lateral_range
    assert low < -1.2e-3
    assert high > 1.2e-3
    assert within_tolerance(done.welds["without_backlash"]) < 0.5
    assert within_tolerance(done.welds["corrected"]) > 0.98
    means = zone_means(done.welds["corrected"])
    assert list(means) == list("123456789")
    assert max(abs(mean) for mean in means.values()) < 0.5e-3
    assert len(curve_rows(done)) == 11


def test_without_uncertainty_and_noise_of_the_robot_only_the_forces_are_left():
    """The same robot in plan and cell: what remains is ripple, noise and the tracker."""
    exact = replace(ELASTICITY, backlash=np.zeros(6))
    known = replace(cell(Options(friction=True)), elasticity=exact)
    seam = straight_line()
    short = replace(seam, positions=seam.positions[:10], normals=seam.normals[:10])
    done = run_experiment(known, exact, short, 0)
    assert (1e3 * done.welds["corrected"].rms < 0.2).all()
