import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.samples.commands import TwistCommand
from daidalos.simulation import Simulation
from simulation.models import arena, box, turtlebot, world

SECOND = 1_000_000_000


def test_a_resting_box_is_carried_by_the_ground():
    simulation = Simulation(world(box("b", mass=2.0)))
    simulation.advance(3 * SECOND)
    assert simulation.physics.data.ntree_awake == 0
    (contact,) = simulation.contacts()
    assert (contact.model1, contact.link1, contact.collision1) == ("ground_plane", "link", "collision")
    assert (contact.model2, contact.link2, contact.collision2) == ("b", "link", "shape")
    assert contact.forces.sum(axis=0) == pytest.approx([0, 0, 2 * 9.8], rel=1e-3)
    np.testing.assert_allclose(contact.normals, [[0, 0, 1]] * 4, atol=1e-6)
    assert np.abs(contact.positions[:, :2]) == pytest.approx(0.5 * np.ones((4, 2)), abs=1e-3)
    assert (contact.depths > 0).all()


@pytest.mark.slow
def test_a_monitor_sees_touches_between_looks():
    simulation = Simulation(arena())
    simulation.spawn(turtlebot(), "robot", Pose((3.0, 1.4, 0)))
    monitor = simulation.monitor_contacts("robot", ignore=("ground_plane",))
    simulation.advance(SECOND)
    assert monitor.touches == ()
    simulation.command("/cmd_vel", TwistCommand(np.array([0.3, 0, 0]), np.zeros(3)))
    simulation.advance(6 * SECOND)
    first = monitor.touches[0]
    assert (first.other_model, first.other_link) == ("walls", "link")
    assert 3 * SECOND < first.first_ns < first.last_ns
    simulation.command("/cmd_vel", TwistCommand(np.array([-0.3, 0, 0]), np.zeros(3)))
    simulation.advance(3 * SECOND)
    assert monitor.touches[0].last_ns < simulation.time_ns - SECOND


def test_links_of_one_robot_do_not_touch_each_other():
    simulation = Simulation(world())
    simulation.spawn(turtlebot(), "robot")
    simulation.advance(SECOND)
    touching = {contact.model1 for contact in simulation.contacts()}
    assert touching == {"ground_plane"}
