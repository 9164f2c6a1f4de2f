"""Contact, removal and dynamics of grinding against closed forms."""

import math

import numpy as np
import pytest

from daidalos.common.parameters import replace
from daidalos.industry.grinding import contact_kernels
from daidalos.industry.grinding.cell import Cell, Tool, disc_at, press
from daidalos.industry.grinding.force_control import Command, ValveMode
from daidalos.industry.grinding.height_field import Workpiece
from daidalos.industry.grinding.passes import footprint
from daidalos.industry.grinding.settings import GRAVITY, PERIOD, CellParameters

RESOLUTION = 0.5e-3
FLAT = replace(CellParameters(), {"disc.lean": 1e-6})


def piece_of(heights, resolution=RESOLUTION, pose=None):
    rows, columns = heights.shape
    origin = -0.5 * resolution * np.array([columns - 1, rows - 1])
    return Workpiece(
        heights, heights.copy(), np.ones(heights.shape, bool), origin, resolution, np.eye(4) if pose is None else pose
    )


def pressed(parameters, piece, disc):
    tables = np.zeros((3, contact_kernels.BINS + 1))
    top = press(parameters, piece, piece.surface, disc, tables)
    return top, tables


def test_flat_disc_on_a_flat_plate_is_two_springs_in_series():
    piece = piece_of(np.full((301, 301), 0.02))
    top, (depths, faces, forces) = pressed(FLAT, piece, disc_at(FLAT, 0.0, 0.0, 0.0, 0.0))
    disc, contact = FLAT.disc, FLAT.contact
    area = math.pi * (disc.radius**2 - disc.inner_radius**2)
    stiffness = 1.0 / (1.0 / contact.stiffness + 1.0 / (contact.face_stiffness * area))
    assert top == pytest.approx(0.02)
    assert forces[40] / depths[40] == pytest.approx(stiffness, rel=2e-3)
    assert forces[40] == pytest.approx(contact.face_stiffness * area * faces[40], rel=3e-3)


def test_a_millimetre_is_a_hundred_newtons():
    piece = piece_of(np.zeros((301, 301)))
    _, (depths, _, forces) = pressed(FLAT, piece, disc_at(FLAT, 0.0, 0.0, 0.0, 0.0))
    assert np.interp(1e-3, depths, forces) == pytest.approx(100.0, rel=0.01)


def test_hertz_has_the_exponent_of_its_law():
    soft = replace(FLAT, {"contact.law": "hertz", "contact.hertz_stiffness": 1e6, "contact.face_stiffness": 5e8})
    piece = piece_of(np.zeros((301, 301)))
    _, (depths, _, forces) = pressed(soft, piece, disc_at(soft, 0.0, 0.0, 0.0, 0.0))
    assert np.interp(2e-4, depths, forces) == pytest.approx(1e6 * 2e-4**1.5, rel=0.03)


def test_leaning_disc_presses_with_the_integral_over_its_segment():
    lean, face = 0.03, 1e-4
    parameters = replace(CellParameters(), {"disc.lean": lean, "contact.stiffness": 1e12})
    piece = piece_of(np.zeros((1001, 1001)), 0.15e-3)
    top, (_, faces, forces) = pressed(parameters, piece, disc_at(parameters, 0.0, 0.0, -lean, 0.0))
    radius = parameters.disc.radius
    # The face is a circle of its own plane, a little shorter along x in the plane of the plate.
    x = np.linspace(radius / math.sqrt(1.0 + lean**2) - face / lean, radius / math.sqrt(1.0 + lean**2), 4001)
    half = np.sqrt(np.maximum(radius**2 - x**2 * (1.0 + lean**2), 0.0))
    expected = parameters.contact.face_stiffness * np.trapezoid(2.0 * half * lean * (x - x[0]), x)
    # The outermost cell is a little inside of the rim.
    below_rim = lean * radius / math.sqrt(1.0 + lean**2) - top
    assert np.interp(face - below_rim, faces, forces) == pytest.approx(expected, rel=0.03)


def reference(piece, disc, face):
    """Return first touch and force at a depth of the face, cell by cell."""
    y, x = np.meshgrid(piece.y - disc[1], piece.x - disc[0], indexing="ij")
    sunk = disc[2] * x + disc[3] * y
    inside = (x**2 + y**2 + sunk**2 <= disc[4] ** 2) & (x**2 + y**2 + sunk**2 > disc[5] ** 2)
    above = np.where(inside, piece.surface - sunk, -np.inf)
    depth = np.clip(above - above.max() + face, 0.0, None)
    return above.max(), 2e9 * depth.sum() * piece.resolution**2


@pytest.mark.parametrize("seed", range(4))
def test_table_on_a_rough_slope_is_that_of_its_cells(seed):
    rng = np.random.default_rng(seed)
    piece = piece_of(rng.normal(0.0, 5e-5, (401, 353)) + 0.05 * rng.normal() * np.linspace(-0.1, 0.1, 353))
    disc = disc_at(FLAT, *rng.uniform(-0.06, 0.06, 2), *rng.normal(0.0, 0.05, 2))
    top, (_, faces, forces) = pressed(FLAT, piece, disc)
    for index in (8, 60, 128):
        expected_top, expected = reference(piece, disc, faces[index])
        assert top == pytest.approx(expected_top, abs=1e-12)
        assert forces[index] == pytest.approx(expected, rel=1e-9)


def test_disc_beside_the_workpiece_has_no_force():
    top, (_, _, forces) = pressed(FLAT, piece_of(np.zeros((41, 41))), disc_at(FLAT, 1.0, 0.0, 0.0, 0.0))
    assert top == contact_kernels.BESIDE
    assert not forces.any()


def test_removal_is_prestons():
    parameters = CellParameters()
    found = footprint(parameters, 0.25e-3, 30.0, parameters.disc.preston)
    speed = parameters.spindle.speed - parameters.spindle.droop * parameters.disc.friction * 30.0 * 0.0625
    # The pressure's resultant is near the rim: MRR = k F v.
    assert found.volume_rate == pytest.approx(parameters.disc.preston * 30.0 * speed * 0.0605, rel=0.02)
    assert found.rates.sum() * 0.25e-3**2 == pytest.approx(found.volume_rate, rel=1e-9)


def test_removal_takes_no_more_than_the_depth():
    piece = piece_of(np.zeros((301, 301)))
    removed = np.zeros(3)
    disc = disc_at(FLAT, 0.0, 0.0, 0.0, 0.0)
    contact_kernels.remove(piece.surface, piece.origin, RESOLUTION, disc, -1e-5, 1e9, removed)
    assert piece.surface.min() == pytest.approx(-1e-5)
    area = math.pi * (FLAT.disc.radius**2 - FLAT.disc.inner_radius**2)
    assert removed[0] == pytest.approx(1e-5 * area, rel=0.01)


# Valve, gravity and friction, with the disc in the air.


def free_cell(pose=None, **changes):
    quiet = {
        "arm.position_error": 0.0, "arm.angle_error": 0.0, "spindle.unbalance": 0.0, "sensor.force_noise": 0.0,
        "sensor.position_noise": 0.0, "actuator.coulomb_friction": 0.0, "actuator.static_friction": 0.0,
    }  # fmt: skip
    parameters = replace(CellParameters(), quiet | changes)
    return Cell(parameters, piece_of(np.zeros((101, 101)), 1e-3, pose), 0.06, ValveMode.OPEN)


AWAY = Tool(0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 0.0)


def test_valve_is_a_first_order_lag_behind_a_dead_time():
    cell = free_cell()
    cell.put(0.025, 0.0, AWAY)
    pressures = []
    for _ in range(60):
        cell.step(Command(1e5), AWAY)
        pressures.append(cell.pressure)
    actuator = cell.parameters.actuator
    delay = round(actuator.valve_delay / PERIOD)
    assert not any(pressures[:delay])
    times = PERIOD * (np.arange(60) + 1) - actuator.valve_delay
    expected = np.where(times > 0.0, 1e5 * (1.0 - np.exp(-times / actuator.valve_time)), 0.0)
    np.testing.assert_allclose(pressures, expected, atol=200.0)


@pytest.mark.parametrize("angle", [0.0, 60.0, 90.0, 180.0])
def test_weight_follows_the_angle_of_the_tool_and_holds_the_piston(angle):
    pose = np.eye(4)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    pose[:3, :3] = [[1, 0, 0], [0, c, -s], [0, s, c]]
    cell = free_cell(pose)
    weight = cell.weight_at(AWAY)
    assert weight == pytest.approx(-cell.parameters.actuator.mass * GRAVITY * math.cos(math.radians(angle)))
    pressure = weight / cell.parameters.actuator.area
    cell.put(0.025, pressure, AWAY)
    measured = [cell.step(Command(pressure), AWAY) for _ in range(300)][-1]
    assert measured.position == pytest.approx(0.025, abs=1e-9)
    assert measured.force == pytest.approx(0.0, abs=1e-6)


def test_viscous_friction_limits_the_speed():
    cell = free_cell()
    weight = cell.weight_at(AWAY)
    cell.put(0.0, weight / 1e-3, AWAY)
    command = Command((weight + 6.0) / cell.parameters.actuator.area)
    speeds = [cell.step(command, AWAY).speed for _ in range(350)]
    assert speeds[-1] == pytest.approx(6.0 / cell.parameters.actuator.viscous_friction, rel=0.02)


def test_static_friction_holds_until_it_is_overcome():
    def moved(force):
        cell = free_cell(**{"actuator.static_friction": 6.0, "actuator.coulomb_friction": 4.0})
        weight = cell.weight_at(AWAY)
        cell.put(0.02, weight / 1e-3, AWAY)
        for _ in range(300):
            measured = cell.step(Command((weight + force) / 1e-3), AWAY)
        return measured.position - 0.02

    assert moved(5.0) < 1e-4
    assert moved(8.0) > 1e-3


def test_ends_of_the_stroke_hold():
    cell = free_cell()
    cell.put(0.049, 0.0, AWAY)
    for _ in range(1500):
        measured = cell.step(Command(1e5), AWAY)
    assert measured.position == pytest.approx(cell.parameters.actuator.stroke, abs=2e-3)
