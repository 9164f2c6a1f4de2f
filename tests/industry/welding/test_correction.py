"""Correction of paths: against the closed form, and with whatever may be wrong with a path."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.industry.elasticity.deflection import Options, load, transmission_torques, windings
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.welding.bsplines import angles_between
from daidalos.industry.welding.correction import correct
from daidalos.industry.welding.joint_paths import choose_branch, joint_speeds
from daidalos.industry.welding.planning import Request, plan
from daidalos.industry.welding.seam import Seam, tool_axes, tool_poses

from .cells import ARM, ELASTICITY, SPEED, WRENCH, arc, cell, line, tool


def wrenches(count):
    return np.tile(WRENCH, (count, 1))


@pytest.mark.parametrize("options", [Options(), Options(gravity=True, friction=True), Options(backlash=(False,) * 6)])
@pytest.mark.parametrize("seam", [line(60), arc(200)], ids=["line", "arc"])
def test_the_programmed_path_is_that_of_the_closed_form(seam, options):
    """With the wanted pose as that of the link side, the motors' angles follow without iteration."""
    desired, count = tool_poses(seam), len(seam.positions)
    done = correct(cell(options), desired, wrenches(count), SPEED)
    joints, _ = choose_branch(ARM, desired @ np.linalg.inv(tool()), "")
    speeds = joint_speeds(joints, seam.distances, SPEED)
    turned = np.concatenate([desired[:, :3, :3] @ WRENCH[:3], desired[:, :3, :3] @ WRENCH[3:]], axis=1)
    torques = transmission_torques(ARM, ELASTICITY, joints, desired[:, :3, 3], turned, speeds, options)
    wound, _ = windings(ELASTICITY, torques, options)
    programmed = forward(ARM, joints + wound) @ tool()
    assert np.abs(done.programmed[:, :3, 3] - programmed[:, :3, 3]).max() < 1e-5
    assert angles_between(done.programmed[:, :3, :3], programmed[:, :3, :3]).max() < 4e-5


def test_it_converges_below_a_micrometre_in_few_iterations():
    done = correct(cell(Options(gravity=True, friction=True)), tool_poses(arc(1000)), wrenches(1000), SPEED)
    distances = [distance for distance, _ in done.convergence]
    assert distances[0] > 5e-3
    assert distances[-1] < 1e-6
    assert len(distances) <= 6
    assert distances == sorted(distances, reverse=True)


@pytest.mark.parametrize("direction", [-1.0, 1.0])
def test_it_converges_where_torques_are_nearly_zero(direction):
    """Check seams towards the robot's middle plane under a force through the wrist, on which flanks are undecided."""
    steps = np.arange(60)[:, None] * [0.01, direction * 0.005, 0.0]
    seam = Seam(np.array([1.8, -direction * 0.3, 0.6]) + steps, np.tile([0.0, 0.0, 1.0], (60, 1)))
    wrench = np.tile([0.0, 0.0, 8000.0, 0.0, 0.0, 0.0], (60, 1))
    done = correct(cell(), tool_poses(seam), wrench, SPEED)
    assert done.convergence[-1][0] < 1e-6
    assert np.linalg.norm(done.after.poses[:, :3, 3] - done.desired[:, :3, 3], axis=1).max() < 1e-5
    assert (np.diff(done.after.sides[:, 3:], axis=0) == 0.0).all()


def test_the_loaded_tool_runs_on_the_desired_path():
    desired = tool_poses(arc())
    done = correct(cell(), desired, wrenches(400), SPEED)
    loaded = load(ARM, ELASTICITY, done.motors, tool(), wrenches(400), np.zeros((400, 6)), Options())
    assert np.linalg.norm(loaded.poses[:, :3, 3] - desired[:, :3, 3], axis=1).max() < 1e-5
    assert np.linalg.norm(done.before.poses[:, :3, 3] - desired[:, :3, 3], axis=1).min() > 3e-3


def test_the_splines_are_parted_where_axis_1_changes_its_flank():
    done = correct(cell(), tool_poses(arc()), wrenches(400), SPEED)
    changes = np.flatnonzero(np.diff(done.after.sides[:, 0]) != 0)
    assert len(changes) >= 1
    assert {piece.first for piece in done.spline.pieces} >= {int(one) + 1 for one in changes}
    steps = np.diff(done.motors[:, 0])
    jumps = np.abs(steps[changes] - 0.5 * (steps[changes - 1] + steps[changes + 1]))
    np.testing.assert_allclose(jumps, ELASTICITY.backlash[0], rtol=0.02)


def test_the_tool_is_tilted_with_its_tip_ahead():
    poses = tool_poses(line())
    assert np.degrees(np.arccos(-poses[:, 2, 2])) == pytest.approx(2.5)
    assert (poses[:, :3, 2] @ [0, -1, 0] > 0).all()
    axes = tool_axes(line(), poses)
    np.testing.assert_allclose(axes, poses[:, :3, :3], atol=1e-12)


def test_a_plan_turns_the_wrench_with_the_tool():
    """A spindle in line with axis 6 may be turned about itself: path and deviations stay the same."""
    straight = plan(cell(), line(), Request(SPEED, WRENCH))
    turned = plan(cell(), line(), Request(SPEED, WRENCH, rotation=1.0))
    np.testing.assert_allclose(turned.before, straight.before, atol=1e-8)
    assert np.abs(turned.correction.motors - straight.correction.motors).max() > 0.9


def test_the_stiffest_place_and_rotation_are_no_worse():
    found = plan(cell(), line(30), Request(SPEED, WRENCH, rotation=None, places=True))
    here = next(one for one in found.places if np.allclose(one.value, (0.0, 0.0)))
    assert found.places[0].deflection < 0.9 * here.deflection
    assert [one.deflection for one in found.places] == sorted(one.deflection for one in found.places)
    assert found.rotation == found.rotations[0].value[0]


def test_zones_have_their_own_figures():
    seam = replace(line(60), zones=("one",) * 30 + ("two",) * 30)
    zones = plan(cell(), seam, Request(SPEED, WRENCH)).as_json()["zones"]
    assert [zone["zone"] for zone in zones] == ["one", "two"]
    assert all(abs(zone["after_across_mm"]) < 0.01 < abs(zone["before_across_mm"]) for zone in zones)


@pytest.mark.parametrize(
    ("shift", "speed", "message"),
    [
        ((3.0, 0, 0), SPEED, "point 1 is out of reach"),
        ((-2.3, 0.0, 1.6), SPEED, "axis|singularity|out of reach"),
        ((0, 0, 0), 500.0, "axis 6 needs|axis . needs .* weld slower"),
    ],
)
def test_what_the_arm_cannot_do_is_named(shift, speed, message):
    seam = replace(line(), positions=line().positions + np.array(shift))
    with pytest.raises(UserError, match=message):
        correct(cell(), tool_poses(seam), wrenches(100), speed, "here")


def test_a_path_along_its_normal_is_refused():
    seam = Seam(np.array([[2.0, 0, 0.5], [2.0, 0, 0.9]]), np.tile([0.0, 0.0, 1.0], (2, 1)))
    with pytest.raises(UserError, match="point 1: the path runs along the normal"):
        tool_poses(seam)


def test_a_singular_path_is_refused():
    """The wrist stretched: axes 4 and 6 in line."""
    positions = np.column_stack([np.linspace(2.6, 2.7, 50), np.zeros(50), np.full(50, 2.29)])
    rotation = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    seam = Seam(positions, None, np.tile(rotation, (50, 1, 1)))
    with pytest.raises(UserError, match="wrist singularity"):
        correct(cell(), tool_poses(seam), wrenches(50), SPEED)
