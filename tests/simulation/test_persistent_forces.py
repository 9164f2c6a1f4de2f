"""What gz's ApplyLinkWrench pushes from the start."""

import pytest

from daidalos.description.errors import DescriptionError
from daidalos.simulation import Simulation
from simulation.models import box, world

SECOND = 1_000_000_000


def pushing(*wrenches):
    told = "".join(f"<persistent>{wrench}</persistent>" for wrench in wrenches)
    return f"<gravity>0 0 0</gravity><plugin name='p' filename='gz-sim-apply-link-wrench-system'>{told}</plugin>"


@pytest.mark.parametrize("name", ["b", "b::link"])
def test_a_box_is_pushed_until_told_otherwise_and_again_after_a_reset(name):
    wrench = f"<entity_name>{name}</entity_name><entity_type>model</entity_type><force>2 0 0</force>"
    simulation = Simulation(world(pushing(wrench), box("b", "0 0 5 0 0 0"), box("c", "0 9 5 0 0 0")))
    mass = simulation.instance("b").model.links["link"].inertial.mass
    for _ in range(2):
        simulation.advance(SECOND)
        assert simulation.velocity("b")[0][0] == pytest.approx(2 / mass, rel=1e-6)
        assert simulation.velocity("c")[0][0] == 0
        simulation.stop_pushing("b", "link")
        simulation.advance(SECOND)
        assert simulation.velocity("b")[0][0] == pytest.approx(2 / mass, rel=1e-6)
        simulation.reset()
    assert not simulation.warnings


def test_a_torque_turns():
    wrench = "<entity_name>b</entity_name><torque>0 0 0.1</torque>"
    simulation = Simulation(world(pushing(wrench), box("b", "0 0 5 0 0 0")))
    simulation.advance(SECOND)
    assert simulation.velocity("b")[1][2] > 0


def test_what_is_not_there_is_named():
    simulation = Simulation(world(pushing("<entity_name>ghost</entity_name><force>1 0 0</force>"), box("b")))
    assert [line.partition(": ")[2] for line in simulation.warnings] == ["there is no 'ghost' to push, left out"]


def test_a_wrong_force_is_an_error_with_its_place():
    with pytest.raises(DescriptionError, match=r"<force>: .* 3 numbers"):
        Simulation(world(pushing("<entity_name>b</entity_name><force>1 0</force>"), box("b")))
