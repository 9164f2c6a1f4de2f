"""Forces from outside, and the world's properties while it runs."""

import pytest

from daidalos.simulation import Simulation
from daidalos.simulation.errors import UnknownNameError
from simulation.models import box, world

SECOND = 1_000_000_000


def drifting(*parts):
    simulation = Simulation(world(*parts))
    simulation.gravity = (0.0, 0.0, 0.0)
    return simulation


def test_a_push_gives_momentum_for_as_long_as_it_lasts():
    simulation = drifting(box("b", "0 0 5 0 0 0", mass=2.0))
    simulation.push("b", force=(4.0, 0, 0), delay_ns=SECOND // 10, duration_ns=SECOND // 2)
    simulation.advance(SECOND // 10)
    assert simulation.velocity("b")[0] == pytest.approx([0, 0, 0])
    simulation.advance(2 * SECOND)
    assert simulation.velocity("b")[0] == pytest.approx([4 * 0.5 / 2, 0, 0], rel=1e-6)


def test_a_push_off_centre_turns():
    """A cube of 1 m and 6 kg has a moment of inertia of 1 kg m^2."""
    simulation = drifting(box("b", "0 0 5 0 0 0", mass=6.0))
    simulation.push("b", "link", force=(0, 1.0, 0), point=(0.5, 0, 0), duration_ns=SECOND // 10)
    simulation.advance(SECOND // 5)
    assert simulation.velocity("b")[1] == pytest.approx([0, 0, 0.05], rel=1e-3)


def test_a_push_without_end_is_stopped():
    simulation = drifting(box("b", "0 0 5 0 0 0"))
    simulation.push("b", "link", force=(1.0, 0, 0))
    simulation.advance(SECOND)
    simulation.stop_pushing("b", "link")
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0][0] == pytest.approx(1.0, rel=1e-6)


def test_pushes_come_back_with_a_saved_state():
    simulation = drifting(box("b", "0 0 5 0 0 0"))
    simulation.push("b", force=(1.0, 0, 0), duration_ns=SECOND)
    simulation.advance(SECOND // 2)
    state = simulation.save()
    simulation.advance(SECOND)
    after = simulation.pose("b")
    simulation.restore(state)
    simulation.advance(SECOND)
    assert simulation.pose("b") == after


def test_a_reset_ends_pushes():
    simulation = drifting(box("b", "0 0 5 0 0 0"))
    simulation.push("b", force=(1.0, 0, 0))
    simulation.reset()
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0] == pytest.approx([0, 0, 0])


def test_pushes_outlive_other_models():
    simulation = drifting(box("b", "0 0 5 0 0 0"), box("c", "5 0 5 0 0 0"))
    simulation.push("b", force=(1.0, 0, 0))
    simulation.delete("c")
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0][0] == pytest.approx(1.0, rel=1e-6)
    simulation.delete("b")
    simulation.advance(SECOND // 10)


def test_nobody_of_that_name_can_be_pushed():
    with pytest.raises(UnknownNameError, match="no link 'hand'"):
        drifting(box("b")).push("b", "hand")


def test_gravity_changes_for_those_who_sleep_too():
    simulation = Simulation(world(box("b")))
    simulation.advance(5 * SECOND)
    simulation.gravity = (0.0, 0.0, 2.0)
    simulation.advance(SECOND)
    assert simulation.pose("b").position[2] == pytest.approx(0.5 + 1.0, rel=0.01)
    assert simulation.gravity == (0.0, 0.0, 2.0)


def test_friction_changes_while_it_runs():
    simulation = Simulation(world(box("b", surface="<surface><friction><ode><mu>1</mu></ode></friction></surface>")))
    simulation.advance(SECOND // 10)
    simulation.set_friction("b", 0.1)
    simulation.push("b", force=(3.0, 0, 0), point=(0, 0, -0.5))
    simulation.advance(SECOND)
    # m a = F - mu m g, with 1 kg.
    assert simulation.velocity("b")[0][0] == pytest.approx(3.0 - 0.1 * 9.8, rel=0.02)


def test_a_model_grows_where_it_stands():
    simulation = Simulation(world(box("b", "1 2 0.5 0 0 0")))
    simulation.scale("b", 2.0)
    simulation.advance(SECOND)
    low, high = simulation.bounds("b")
    assert high - low == pytest.approx([2, 2, 2], abs=1e-3)
    assert low[2] == pytest.approx(0, abs=1e-3)


def test_a_step_can_be_longer():
    simulation = drifting(box("b", "0 0 5 0 0 0"))
    simulation.set_step(0.005)
    simulation.set_velocity("b", (1, 0, 0), (0, 0, 0))
    simulation.step(10)
    assert simulation.time_ns == 50_000_000
    assert simulation.pose("b").position[0] == pytest.approx(0.05)
    with pytest.raises(ValueError, match="longer than 0"):
        simulation.set_step(0.0)
