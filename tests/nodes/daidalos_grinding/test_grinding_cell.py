"""The node `grinding_cell` under a stepped clock: what it publishes, stopping, faults and settings."""

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState, PointCloud2
from sensor_msgs_py import point_cloud2
from std_msgs.msg import String
from std_srvs.srv import Trigger

from daidalos.common.errors import UserError
from daidalos.nodes.daidalos_grinding.grinding_cell import GrindingCell
from daidalos.nodes.qos import LATCHED


class Cell:
    """The node, and what it has published."""

    def __init__(self, set_stage, **changes):
        self.stage = stage = set_stage({"/grinding_cell": {"resolution": 1e-3} | changes})
        self.wrenches = stage.collect(WrenchStamped, "grinding_cell/force", 1000)
        self.cylinders = stage.collect(JointState, "grinding_cell/cylinder", 1000)
        self.arms = stage.collect(JointState, "joint_states", 1000)
        self.fields = stage.collect(PointCloud2, "grinding_cell/height_field", LATCHED)
        self.told = stage.collect(String, "grinding_cell/state", LATCHED)
        self.node = stage.add(GrindingCell())

    @property
    def forces(self):
        return [one.wrench.force.z for one in self.wrenches]

    @property
    def states(self):
        return [one.data for one in self.told]

    def call(self, name):
        return self.stage.call(Trigger, f"grinding_cell/{name}")


@pytest.mark.slow
def test_force_cylinder_and_height_field_are_published(stage):
    cell = Cell(stage)
    cell.stage.step_for(5.0)
    assert np.mean(cell.forces[-20:]) == pytest.approx(30.0, abs=2.0)
    assert 0.015 < cell.cylinders[-1].position[0] < 0.035
    angles = np.array([one.position for one in cell.arms])
    assert angles.shape[1] == 6
    assert np.abs(np.diff(angles, axis=0)).max() < 0.05
    first, last = (point_cloud2.read_points_numpy(one, ["z"]) for one in (cell.fields[0], cell.fields[-1]))
    assert (first - last).max() > 1e-4
    colors = point_cloud2.read_points(cell.fields[-1], ["rgb"])
    assert len(np.unique(colors)) > 10
    assert cell.fields[-1].header.frame_id == "workpiece"
    assert cell.states[-1] == "pass 1, line 1 of 2: grind"


@pytest.mark.slow
def test_it_is_stopped_and_started_again(stage):
    cell = Cell(stage)
    cell.stage.step_for(2.5)
    assert cell.forces[-1] > 5.0
    assert cell.call("stop").success
    cell.stage.step_for(2.0)
    assert cell.states[-1].startswith("stopped: pass 1: it was asked to stop (at ")
    silent = len(cell.forces)
    cell.stage.step_for(1.0)
    assert len(cell.forces) == silent
    answer = cell.call("stop")
    assert (answer.success, answer.message) == (False, "nothing is being ground")
    assert cell.call("start").success
    cell.stage.step_for(1.0)
    assert cell.states[-1].startswith("pass 1, line 1 of 2: ")
    assert not cell.call("start").success


@pytest.mark.slow
def test_a_fault_of_the_sensor_lifts_the_tool_off(stage):
    cell = Cell(stage, faults=["sensor_nan@2.5"])
    cell.stage.step_for(5.0)
    assert cell.states[-1].startswith("stopped: pass 1: the force sensor sends nan (at 2.5")
    # What the sensor says is published as it is.
    assert np.isnan(cell.forces).any()
    assert cell.node._job.passes[0].record.force[-1] == 0.0


@pytest.mark.slow
def test_a_clock_that_jumps_does_not_jump_the_tool(stage):
    cell = Cell(stage)
    cell.stage.step_for(2.5)
    before = cell.node._run.cell.time
    cell.stage.step(500.0)
    assert cell.node._run.cell.time - before < 0.3


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("controller", "p", "there is no force controller 'p'"),
        ("task", "clmp", r"'task' .* must be one of clamp, plate"),
        ("robot", "irb870", "there is no arm 'irb870'; did you mean 'irb8700'"),
        ("force", 1000.0, "the force is 1000 N, but must be 5 to 120 N"),
        ("faults", ["sensor_nun@1"], "there is no fault 'sensor_nun'"),
        ("cell.disc.radius", -1.0, "must be above 0"),
    ],
)
def test_settings_that_are_wrong_are_refused(stage, name, value, message):
    with pytest.raises(UserError, match=message):
        Cell(stage, **{name: value})
