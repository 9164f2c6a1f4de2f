import numpy as np
import pytest

from daidalos.simulation import Simulation
from daidalos.simulation.last_step import cross, velocities
from simulation.models import box, world


def test_cross_products_of_rows():
    first, second = np.random.default_rng(1).normal(size=(2, 5, 3))
    assert cross(first, second) == pytest.approx(np.cross(first, second))
    assert cross(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0, 3)


def test_velocities_are_those_of_one_step_before():
    simulation = Simulation(world(box("a", "0 0 5 0 0 0"), box("b", "3 0 5 0 0 0")))
    simulation.set_velocity("b", (1.0, 0.0, 0.0), (0.0, 0.0, 2.0))
    simulation.step(1)
    before = [simulation.velocity(name) for name in ("a", "b")]
    bodies = [simulation.instance(name).link("link").body for name in ("a", "b")]
    simulation.step(1)
    linear, angular = velocities(simulation.physics, bodies)
    assert linear == pytest.approx(np.array([one for one, _ in before]), abs=1e-9)
    assert angular == pytest.approx(np.array([one for _, one in before]), abs=1e-9)
