"""Jacobians and dynamics against closed forms, against finite differences, and against Pinocchio where it is."""

import numpy as np
import pytest

from daidalos.description import urdf
from daidalos.description.kinematics import KinematicTree
from daidalos.simulation.dynamics import Dynamics
from daidalos.simulation.errors import SimulationError, UnknownNameError

PENDULUM = """<robot name="p"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.2" iyy="0.2" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>"""


def random_arm(seed, joints=6):
    random = np.random.default_rng(seed)
    parts = ["<link name='l0'/>"]
    for i in range(joints):
        root = random.normal(size=(3, 3)) * 0.1
        spread = root @ root.T + np.eye(3) * 0.02
        inertia = np.trace(spread) * np.eye(3) - spread  # of a body that can be
        xyz, rpy, com = (" ".join(map(str, random.uniform(-0.4, 0.4, 3))) for _ in range(3))
        axis = random.normal(size=3)
        axis = " ".join(map(str, axis / np.linalg.norm(axis)))
        kind = "prismatic" if random.random() < 0.25 else "revolute"
        values = dict(zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), inertia[np.triu_indices(3)], strict=True))
        words = " ".join(f'{key}="{value}"' for key, value in values.items())
        parts.append(
            f'<link name="l{i + 1}"><inertial><origin xyz="{com}"/><mass value="{random.uniform(0.5, 3)}"/>'
            f"<inertia {words}/></inertial></link>"
            f'<joint name="j{i}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
            '<limit lower="-3" upper="3" effort="9" velocity="9"/><dynamics damping="1.0" friction="0.5"/></joint>'
        )
    return f"<robot name='arm'>{''.join(parts)}</robot>"


def test_a_pendulum_is_one():
    dynamics = Dynamics(urdf.parse(PENDULUM), (0, 0, -9.81))
    for angle in (0.0, 0.4, 1.2):
        q = np.array([angle])
        assert dynamics.mass_matrix(q) == pytest.approx(np.array([[0.2 + 2 * 0.25]]))
        assert dynamics.bias(q, np.zeros(1)) == pytest.approx(2 * 9.81 * 0.5 * np.sin(angle))
        assert dynamics.inverse(q, np.zeros(1), np.array([3.0])) == pytest.approx(
            0.7 * 3 + 2 * 9.81 * 0.5 * np.sin(angle)
        )


def test_forward_undoes_inverse():
    dynamics = Dynamics(urdf.parse(random_arm(3)))
    random = np.random.default_rng(0)
    q, v, a = random.normal(size=(3, 6))
    assert dynamics.forward(q, v, dynamics.inverse(q, v, a)) == pytest.approx(a)


@pytest.mark.parametrize("seed", range(3))
def test_jacobians_are_derivatives_of_poses(seed):
    robot = urdf.parse(random_arm(seed))
    dynamics, tree = Dynamics(robot), KinematicTree(robot)
    q = np.random.default_rng(seed).normal(size=6)
    point = np.array((0.1, -0.2, 0.3, 1.0))

    def matrix(q):
        values = dict(zip(dynamics.joint_names, q, strict=True))
        return tree.link_matrices(tree.positions(values))[tree.link_names.index("l6")]

    jacobian = dynamics.jacobian(q, "l6", point[:3])
    for column, step in enumerate(np.eye(6) * 1e-6):
        ahead, behind = matrix(q + step), matrix(q - step)
        assert jacobian[:3, column] == pytest.approx((ahead - behind)[:3] @ point / 2e-6, abs=1e-6)
        spin = (ahead[:3, :3] - behind[:3, :3]) @ matrix(q)[:3, :3].T / 2e-6
        assert jacobian[3:, column] == pytest.approx((spin[2, 1], spin[0, 2], spin[1, 0]), abs=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_pinocchio_says_the_same(seed):
    pinocchio = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    text = random_arm(seed)
    model = pinocchio.buildModelFromXML(text)
    model.gravity.linear = np.array((0, 0, -9.81))
    data = model.createData()
    dynamics = Dynamics(urdf.parse(text), (0, 0, -9.81))
    assert dynamics.joint_names == tuple(model.names[1:])
    q, v, a = np.random.default_rng(seed).normal(size=(3, 6))
    upper = np.triu(pinocchio.crba(model, data, q))
    assert dynamics.mass_matrix(q) == pytest.approx(upper + np.triu(upper, 1).T, rel=1e-6, abs=1e-8)
    assert dynamics.inverse(q, v, a) == pytest.approx(pinocchio.rnea(model, data, q, v, a), rel=1e-6, abs=1e-7)
    frame = model.getFrameId("l6")
    theirs = pinocchio.computeFrameJacobian(model, data, q, frame, pinocchio.LOCAL_WORLD_ALIGNED)
    assert dynamics.jacobian(q, "l6") == pytest.approx(theirs, abs=1e-9)


def test_what_is_missing_is_named():
    dynamics = Dynamics(urdf.parse(PENDULUM))
    with pytest.raises(UnknownNameError, match="no link 'hand'; known are base, rod"):
        dynamics.jacobian(np.zeros(1), "hand")
    with pytest.raises(UnknownNameError, match="no movable joint 'k'"):
        dynamics.positions({"k": 1.0})
    planar = PENDULUM.replace('type="continuous"', 'type="planar"')
    with pytest.raises(SimulationError, match="'j' is planar"):
        Dynamics(urdf.parse(planar))
