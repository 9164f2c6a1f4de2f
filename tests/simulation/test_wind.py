"""Wind on the links that are open to it."""

import math

import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.simulation import Simulation
from simulation.models import box, world

SECOND = 1_000_000_000
CALM = "<gravity>0 0 0</gravity><wind><linear_velocity>3 4 -2</linear_velocity></wind>"


def plugin(settings="", file="gz-sim-wind-effects-system"):
    return f"<plugin name='wind' filename='{file}'>{settings}</plugin>"


def windy(name, y=0.0, scope="link"):
    first = "<inertial>" if scope == "link" else "<link"
    return box(name, f"0 {y} 50 0 0 0", mass=2.0).replace(first, f"<enable_wind>true</enable_wind>{first}", 1)


@pytest.mark.parametrize("file", ["gz-sim-wind-effects-system", "libWindPlugin.so"])
@pytest.mark.parametrize("scope", ["link", "model"])
def test_a_box_is_carried_along_as_its_drag_says(file, scope):
    """A force of factor, mass and slip brings it to the wind's speed with that factor as rate."""
    settings = "<force_approximation_scaling_factor>0.5</force_approximation_scaling_factor>"
    simulation = Simulation(world(CALM, plugin(settings, file), windy("b", scope=scope), box("c", "0 9 50 0 0 0")))
    assert not simulation.warnings
    simulation.advance(2 * SECOND)
    expected = np.array((3, 4, -2)) * (1 - math.exp(-1))
    assert simulation.velocity("b")[0] == pytest.approx(expected, rel=2e-3)
    assert not simulation.velocity("c")[0].any()


def test_no_plugin_no_wind():
    simulation = Simulation(world(CALM, windy("b")))
    simulation.advance(SECOND)
    assert not simulation.velocity("b")[0].any()


def wind_velocity(settings):
    simulation = Simulation(world(CALM.replace("3 4 -2", "0 10 1"), plugin(settings), windy("b")))
    return next(c for c in simulation.instance("b").components if type(c).__name__ == "Wind").wind_velocity


def test_it_rises_swings_and_turns():
    sine = "<sin><amplitude_percent>0.1</amplitude_percent><period>4</period></sin>"
    turn = "<time_for_rise>2</time_for_rise><sin><amplitude>5</amplitude><period>4</period></sin>"
    wind = wind_velocity(
        f"<horizontal><magnitude><time_for_rise>1</time_for_rise>{sine}</magnitude>"
        f"<direction>{turn}</direction></horizontal>"
    )
    assert wind(0) == pytest.approx([0, 0, 1])
    x, y, z = wind(1)
    angle = math.pi / 2 * (1 - math.exp(-0.5)) + math.radians(5)
    assert (math.hypot(x, y), math.atan2(y, x), z) == pytest.approx((11 * (1 - math.exp(-1)), angle, 1))


def test_it_trembles():
    wind = wind_velocity("<vertical><noise type='gaussian'><mean>0</mean><stddev>0.5</stddev></noise></vertical>")
    climbs = np.array([wind(5) for _ in range(2000)])
    assert climbs[:, 2].mean() == pytest.approx(1, abs=0.05)
    assert climbs[:, 2].std() == pytest.approx(0.5, rel=0.06)
    assert climbs[:, :2].std(axis=0) == pytest.approx([0, 0])


def test_a_wrong_period_is_an_error_with_its_place():
    with pytest.raises(DescriptionError, match=r"<sin>: expected a period above zero, got 0"):
        wind_velocity("<vertical><sin><period>0</period></sin></vertical>")
