"""Force control on a path with errors: the bands of the force, and what happens when something breaks."""

import dataclasses
import math

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError, replace
from daidalos.industry.grinding.cell import Cell, Fault, FaultKind
from daidalos.industry.grinding.force_control import Command, Measurement
from daidalos.industry.grinding.grinding import Grinding, Phase
from daidalos.industry.grinding.passes import Line, footprint, tools_along
from daidalos.industry.grinding.records import force_figures, record_of, recorded
from daidalos.industry.grinding.settings import PERIOD, CellParameters
from daidalos.industry.grinding.tasks import force_test, make_controller
from daidalos.industry.grinding.workpieces import plate

COARSE = 1e-3
PARAMETERS = CellParameters()
CONTROLLERS = ("pi", "integral", "impedance", "admittance")


@pytest.mark.slow
@pytest.mark.parametrize("name", CONTROLLERS)
@pytest.mark.parametrize("seed", [0, 1])
def test_force_is_within_its_bands(name, seed):
    record, run = force_test(PARAMETERS, make_controller(name, {}, PARAMETERS), seed, resolution=COARSE)
    found = force_figures(record)
    assert run.phase is Phase.DONE
    assert found.steady_error <= 1.0
    assert found.moving_rms <= 3.0
    assert found.overshoot <= 0.1


@pytest.mark.slow
def test_position_control_leaves_the_force_to_the_errors_of_the_path():
    position = make_controller("position", {}, PARAMETERS)
    record, _ = force_test(PARAMETERS, position, 0, resolution=COARSE, is_supervised=False)
    found = force_figures(record)
    # 1 mm at 1e5 N/m is 100 N.
    assert found.greatest > 80.0
    assert found.least == 0.0
    assert found.moving_rms > 25.0


@pytest.mark.slow
def test_same_seed_is_the_same_run():
    one, two = (
        force_test(PARAMETERS, make_controller("pi", {}, PARAMETERS), 3, resolution=COARSE)[0] for _ in range(2)
    )
    np.testing.assert_array_equal(one.force, two.force)


FAULTS = {
    FaultKind.SENSOR_STOPS: "no force for 0.051 s",
    FaultKind.SENSOR_NAN: "the force sensor sends nan",
    FaultKind.VALVE_STOPS: "the force does not follow",
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", FAULTS)
@pytest.mark.parametrize("name", ["pi", "integral"])
def test_the_tool_is_lifted_off_when_something_breaks(kind, name):
    fault = Fault(kind, 3.0)
    record, run = force_test(PARAMETERS, make_controller(name, {}, PARAMETERS), 0, faults=[fault], resolution=COARSE)
    assert run.phase is Phase.STOPPED
    assert FAULTS[kind] in run.problem
    assert "line 1" in run.problem
    after = record.time > 3.0
    assert record.force[after].max() < PARAMETERS.safety.max_force
    assert record.force[-1] == 0.0
    if kind is not FaultKind.VALVE_STOPS:
        # Held for no longer than the timeout, then in the air within 0.3 s, whatever the valve does.
        assert not record.force[record.time > 3.0 + PARAMETERS.sensor.timeout + 0.3].any()


@pytest.mark.parametrize("kind", [FaultKind.SENSOR_NAN, FaultKind.SENSOR_STOPS])
def test_a_sensor_that_is_broken_from_the_beginning_does_not_touch_down(kind):
    run = short_run(faults=[Fault(kind, 0.0)])
    record = recorded(run)
    assert run.phase is Phase.STOPPED
    assert not record.force.any()


def short_run(name="pi", faults=(), changes=None, gap=0.0, wear=0.0, force=30.0, length=0.02, supervised=True):
    parameters = replace(PARAMETERS, changes or {})
    piece = plate(0.16, 0.0, 0.0, resolution=COARSE)
    offset = footprint(parameters, COARSE, force, parameters.disc.preston).offset
    controller = make_controller(name, {}, parameters)
    cell = Cell(parameters, piece, offset, controller.mode, 0, wear)
    cell.faults = tuple(faults)
    points = np.array([[0.03, 0.0], [0.03 + 0.5 * length, 0.0], [0.03 + length, 0.0]])
    line = Line(points, np.full(3, 0.02), np.full(3, force))
    return Grinding(
        cell, controller, [line], [tools_along(line, piece, piece.surface + gap, parameters, offset)],
        is_supervised=supervised,
    )  # fmt: skip


def test_a_workpiece_that_is_not_there_is_no_contact():
    run = short_run(gap=0.05)
    record = recorded(run)
    assert "there is no contact where the workpiece should be" in run.problem
    assert not record.force.any()
    assert run.cell.removed == 0.0


def test_a_disc_that_is_worn_out_is_lifted_off():
    run = short_run(wear=0.99999, changes={"disc.layer": 1e-6})
    recorded(run)
    assert "the disc is worn out" in run.problem
    assert run.cell.force == 0.0


def test_a_spindle_that_is_overloaded_is_lifted_off():
    run = short_run(force=60.0, changes={"spindle.max_torque": 0.5})
    recorded(run)
    assert "the spindle's torque is" in run.problem


def test_a_path_that_is_too_near_is_seen_at_the_end_of_the_stroke():
    run = short_run(
        length=0.05, changes={"actuator.stroke": 0.01, "arm.position_error": 0.006, "arm.error_length": 0.06}
    )
    recorded(run)
    assert "the cylinder is at the end of its stroke" in run.problem


def test_the_tool_touches_down_gently():
    record = recorded(short_run(force=10.0))
    assert record.force.max() < 25.0
    assert record.is_grinding.any()


@pytest.mark.slow
def test_force_control_works_on_a_wall_and_overhead():
    for angle in (90.0, 180.0):
        run = short_run(length=0.03)
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        run.cell.workpiece.pose[:3, :3] = [[1, 0, 0], [0, c, -s], [0, s, c]]
        record = recorded(run)
        settled = record.is_grinding & (record.time > record.time[record.is_grinding][0] + 1.2)
        assert not run.problem
        assert record.smooth_force[settled].mean() == pytest.approx(30.0, abs=1.5)


def test_stop_lifts_off():
    run = short_run()
    while run.phase is not Phase.GRIND:
        run.step()
    for _ in range(300):
        run.step()
    run.stop("the operator has stopped it")
    record = recorded(run)
    assert run.phase is Phase.STOPPED
    assert run.problem.startswith("the operator has stopped it (at ")
    assert record.force[-1] == 0.0


@pytest.mark.parametrize("name", ["pi", "integral", "impedance", "admittance"])
def test_controllers_take_over_without_a_jump(name):
    controller = make_controller(name, {}, PARAMETERS)
    measured = Measurement(0.0, 5.0, 0.04, 0.0, -39.24)
    before = Command(-34.24 / PARAMETERS.actuator.area, 0.001)
    controller.begin(measured, before)
    after = controller.step(5.0, measured)
    assert after.pressure == pytest.approx(before.pressure, rel=1e-3)
    assert after.offset in (0.0, pytest.approx(0.001, abs=1e-6))


@pytest.mark.parametrize("name", ["pi", "integral"])
def test_sums_wait_while_the_valve_is_at_its_limit(name):
    controller = make_controller(name, {}, PARAMETERS)
    controller.begin(Measurement(0.0, 0.0, 0.02, 0.0, 0.0), Command(0.0))
    for _ in range(200_000):
        command = controller.step(5000.0, Measurement(0.0, 0.0, 0.02, 0.0, 0.0))
    assert command.pressure == PARAMETERS.actuator.max_pressure
    for _ in range(400):
        command = controller.step(0.0, Measurement(0.0, 600.0, 0.02, 0.0, 0.0))
    assert command.pressure < 0.5 * PARAMETERS.actuator.max_pressure


def test_figures_of_a_step_response():
    run = short_run()
    sample = run.step()
    samples = []
    for number in range(4000):
        time = PERIOD * number
        wanted = 10.0 if time < 2.0 else 30.0
        passed = time - 2.0
        force = 10.2 if passed < 0.0 else 30.0 + (1.6 if 0.1 < passed < 0.2 else 0.0)
        values = {"time": time, "phase": Phase.GRIND, "wanted": wanted, "force": force}
        samples.append(dataclasses.replace(sample, **values))
    found = force_figures(record_of(samples))
    assert found.overshoot == pytest.approx(0.08, abs=1e-6)
    assert found.steady_error == pytest.approx(0.2, abs=0.01)
    assert found.greatest == pytest.approx(30.0, abs=1e-6)


def test_controller_parameters_are_checked():
    with pytest.raises(ParameterError, match="'integral' must be above 0"):
        make_controller("pi", {"integral": 0.0}, PARAMETERS)
    with pytest.raises(ParameterError, match="'integrl'"):
        make_controller("pi", {"integrl": 1.0}, PARAMETERS)
