"""Deflection of loaded arms: against Pinocchio, closed forms and the figures of the workshop."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daidalos.description import urdf
from daidalos.description.xacro import load_xacro
from daidalos.industry.elasticity.deflection import (
    Options,
    angle_rates,
    deflections,
    flanks,
    load,
    transmission_torques,
    windings,
)
from daidalos.industry.elasticity.elasticity_file import read_elasticity
from daidalos.industry.elasticity.jacobians import holding_torques, jacobians, link_frames
from daidalos.industry.motion.kinematics import forward, inverse
from daidalos.industry.robots import ARMS
from description.robots import SHARE, share_of

ARM = ARMS["kr500_2mt"]
ELASTICITY = read_elasticity(SHARE / "kr500_2mt_description/config/elasticity.yaml", "kr500_2mt")
SPINDLE = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.8], [0, 0, 0, 1]])
WRENCH = np.array([420.0, -175.0, 8000.0, 0.0, 0.0, 7.0])
JOINTS = np.random.default_rng(3).uniform(*ARM.limits.T, (40, 6))


def pinocchio_model():
    pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    text = load_xacro(SHARE / "kr500_2mt_description/urdf/kr500_2mt.urdf.xacro", {}, share_of)
    return pin, pin.buildModelFromXML(text)


def test_the_description_has_the_masses_of_the_elasticity():
    robot = urdf.load(SHARE / "kr500_2mt_description/urdf/kr500_2mt.urdf.xacro", {}, share_of)
    for number in range(1, 7):
        inertial = robot.links[f"link_{number}"].inertial
        assert inertial.mass == pytest.approx(ELASTICITY.mass[number - 1])
        np.testing.assert_allclose(inertial.pose.position, ELASTICITY.centre_of_mass[number - 1], atol=1e-12)


def test_jacobians_and_holding_torques_agree_with_pinocchio():
    pin, model = pinocchio_model()
    data, tool0 = model.createData(), model.getFrameId("tool0")
    points = forward(ARM, JOINTS)[:, :3, 3]
    ours = jacobians(ARM, JOINTS, points)
    held = holding_torques(ARM, JOINTS, ELASTICITY.mass, ELASTICITY.centre_of_mass, (0.0, 0.0, -9.81))
    for number, angles in enumerate(JOINTS):
        theirs = pin.computeFrameJacobian(model, data, angles, tool0, pin.LOCAL_WORLD_ALIGNED)
        np.testing.assert_allclose(ours[number], theirs, atol=1e-12)
        np.testing.assert_allclose(held[number], pin.computeGeneralizedGravity(model, data, angles), atol=1e-8)


def test_the_torques_are_those_of_the_inverse_dynamics_with_the_wrench_applied():
    pin, model = pinocchio_model()
    data = model.createData()
    light = replace(ELASTICITY, balancing=np.zeros(6))
    poses = forward(ARM, JOINTS) @ SPINDLE
    wrenches = np.random.default_rng(1).normal(size=(40, 6)) * 1000.0
    ours = transmission_torques(ARM, light, JOINTS, poses[:, :3, 3], wrenches, np.zeros((40, 6)), Options(gravity=True))
    model.gravity.linear = np.array([0.0, 0.0, -9.80665])
    for number, angles in enumerate(JOINTS):
        pin.forwardKinematics(model, data, angles)
        forces = [pin.Force.Zero() for _ in range(model.njoints)]
        at_tool = pin.SE3(np.eye(3), poses[number, :3, 3])
        forces[-1] = data.oMi[model.njoints - 1].actInv(at_tool.act(pin.Force(-wrenches[number])))
        theirs = pin.rnea(model, data, angles, np.zeros(6), np.zeros(6), pin.StdVec_Force(forces))
        np.testing.assert_allclose(ours[number], theirs, rtol=1e-9, atol=1e-6)


def test_a_tool_adds_to_the_last_link():
    held = ELASTICITY.with_tool(120.0, (0.1, 0.0, 0.3)).gravity(ARM, JOINTS) - ELASTICITY.gravity(ARM, JOINTS)
    at = np.einsum("nij,j->ni", forward(ARM, JOINTS), [0.1, 0.0, 0.3, 1.0])[:, :3]
    weight = np.array([0.0, 0.0, 120.0 * 9.80665, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(held, np.einsum("nij,i->nj", jacobians(ARM, JOINTS, at), weight), atol=1e-6)


def test_the_line_of_the_workshop_deflects_as_its_printed_figures():
    """2.53 mm across and 5.88 mm along the tool were printed; without gravity and backlash 2.58 and 5.92 mm follow."""
    pose = np.array([[0.0, -1, 0, 2.3], [-1, 0, 0, 0], [0, 0, -1, 0.9], [0, 0, 0, 1]])
    solutions = inverse(ARM, pose @ np.linalg.inv(SPINDLE))
    joints = solutions.joints[solutions.within_limits][:1]
    wrench = np.concatenate([pose[:3, :3] @ WRENCH[:3], pose[:3, :3] @ WRENCH[3:]])[None]
    torques = transmission_torques(ARM, ELASTICITY, joints, pose[None, :3, 3], wrench, np.zeros((1, 6)), Options())
    wound, _ = windings(ELASTICITY, torques, Options(backlash=(False,) * 6))
    moved = pose[:3, :3].T @ deflections(ARM, joints, pose[None, :3, 3], wound)[0, :3]
    np.testing.assert_allclose(1e3 * moved[1:], [2.58, 5.92], atol=0.005)


def test_the_equilibrium_fulfils_its_equation():
    motors = np.linspace(np.radians([-20, 30, -40, -5, 60, 10]), np.radians([20, 40, -30, 5, 80, 30]), 30)
    wrenches = np.tile(WRENCH, (30, 1))
    options = Options(gravity=True)
    loaded = load(ARM, ELASTICITY, motors, SPINDLE, wrenches, np.zeros((30, 6)), options)
    wound = motors - loaded.joints
    spring = ELASTICITY.stiffness * (wound - 0.5 * ELASTICITY.backlash * loaded.sides)
    np.testing.assert_allclose(spring, loaded.torques, atol=2e-3)
    np.testing.assert_allclose(loaded.poses, forward(ARM, loaded.joints) @ SPINDLE, atol=1e-9)


def test_an_arm_that_is_too_soft_is_named():
    soft = replace(ELASTICITY, stiffness=np.full(6, 2000.0))
    with pytest.raises(ValueError, match="point 0: the load winds axis 2"):
        load(ARM, soft, np.radians([[0, 37, -34, 0, 88, 180]]), SPINDLE, WRENCH[None], np.zeros((1, 6)), Options())


def test_backlash_has_hysteresis_at_the_change_of_sign():
    torques = np.array([[5.0], [50.0], [5.0], [-5.0], [-50.0], [-5.0], [5.0], [11.0]]) * np.ones(6)
    sides = flanks(torques, np.full(6, 10.0))
    np.testing.assert_array_equal(sides[:, 0], [1, 1, 1, 1, -1, -1, -1, 1])
    np.testing.assert_array_equal(flanks(-torques[:1], np.full(6, 10.0)), -np.ones((1, 6)))


@given(st.lists(st.floats(-100, 100), min_size=1, max_size=30), st.floats(0, 50))
@settings(deadline=None)
def test_flanks_are_those_of_a_play_operator_step_by_step(torques, hold):
    column = np.array(torques)[:, None] * np.ones(6)
    beyond = [value for value in torques if abs(value) > hold]
    side = np.sign(beyond[0]) if beyond else -1.0 if column.sum(axis=0)[0] < 0.0 else 1.0
    expected = []
    for value in torques:
        if abs(value) > hold:
            side = np.sign(value)
        expected.append(side)
    np.testing.assert_array_equal(flanks(column, np.full(6, hold))[:, 0], expected)


def test_the_rates_of_a_b_c_are_their_differences():
    from scipy.spatial.transform import Rotation

    rotations = Rotation.random(20, random_state=2)
    omega = np.array([0.3, -0.2, 0.5])
    step = 1e-6
    after = Rotation.from_rotvec(step * omega) * rotations
    difference = (after.as_euler("ZYX") - rotations.as_euler("ZYX")) / step
    np.testing.assert_allclose(angle_rates(rotations.as_matrix()) @ omega, difference, rtol=1e-3, atol=1e-4)


def test_friction_is_stribecks_curve():
    slow, fast = 1e-6 * np.ones((1, 6)), 10.0 * ELASTICITY.stribeck_speed[None]
    np.testing.assert_allclose(ELASTICITY.friction(slow)[0], ELASTICITY.breakaway_friction, rtol=1e-3)
    viscous = ELASTICITY.coulomb_friction + ELASTICITY.viscous_friction * fast[0]
    np.testing.assert_allclose(ELASTICITY.friction(-fast)[0], -viscous, rtol=1e-9)
    assert not ELASTICITY.friction(np.zeros((1, 6))).any()


def test_link_frames_end_at_the_flange():
    rotations, origins = link_frames(ARM, JOINTS)
    poses = forward(ARM, JOINTS)
    np.testing.assert_allclose(origins[:, 5], poses[:, :3, 3], atol=1e-12)
    np.testing.assert_allclose(rotations[:, 5, :, 0], poses[:, :3, 2], atol=1e-12)
