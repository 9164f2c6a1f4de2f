"""Chains of joints, against MuJoCo and differences."""

import mujoco
import numpy as np
import pytest

from daidalos.control.chain import Chain
from daidalos.control.errors import ControlError, UnknownError
from daidalos.description import urdf

INERTIA = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
TEXT = f"""<robot name="r"><link name="world"/>
  {"".join(f'<link name="{name}">{INERTIA}</link>' for name in ("a", "b", "c", "d", "side"))}
  <joint name="j1" type="revolute"><parent link="world"/><child link="a"/><origin xyz="0.1 0.2 0.3" rpy="0.3 0.1 -0.4"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="0 0 0.5" rpy="0 0.5 0"/>
    <axis xyz="0.6 0 0.8"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="j3" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0.4 0 0"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="flange" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0.2 -0.1 0.05" rpy="1 0 0"/></joint>
  <joint name="aside" type="continuous"><parent link="a"/><child link="side"/></joint></robot>"""
ROBOT = urdf.parse(TEXT)
JOINTS = ("j3", "j1", "aside", "j2")
POSITIONS = np.array([0.8, -0.7, 0.3, 0.25])


def test_pose_and_jacobian_are_mujocos() -> None:
    chain = Chain(ROBOT, "world", "d", JOINTS)
    spec = mujoco.MjSpec.from_string(TEXT)
    spec.compiler.fusestatic = False
    model = spec.compile()
    data = mujoco.MjData(model)
    columns = []
    for name, position in zip(JOINTS, POSITIONS, strict=True):
        data.qpos[model.joint(name).qposadr[0]] = position
        columns.append(model.joint(name).dofadr[0])
    mujoco.mj_forward(model, data)
    body = model.body("d").id
    position, rotation = chain.pose(POSITIONS)
    assert position == pytest.approx(data.xpos[body], abs=1e-9)
    assert rotation == pytest.approx(data.xmat[body].reshape(3, 3), abs=1e-9)
    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacBody(model, data, linear, angular, body)
    expected = np.vstack((linear, angular))[:, np.ravel(columns)]
    assert chain.jacobian(POSITIONS) == pytest.approx(expected, abs=1e-9)


def test_the_base_may_be_in_the_middle() -> None:
    chain = Chain(ROBOT, "a", "d", ("j2", "j3"))
    positions, step = np.array([0.2, 0.4]), 1e-6
    for column in range(2):
        moved = positions.copy()
        moved[column] += step
        difference = (chain.pose(moved)[0] - chain.pose(positions)[0]) / step
        assert chain.jacobian(positions)[:3, column] == pytest.approx(difference, abs=1e-5)


def test_a_model_may_hang_on_the_world() -> None:
    from daidalos.description.gazebo import model_from_robot

    model = model_from_robot(ROBOT)
    assert "world" not in model.links
    found, expected = (Chain(one, "world", "d", JOINTS) for one in (model, ROBOT))
    assert found.pose(POSITIONS)[0] == pytest.approx(expected.pose(POSITIONS)[0])
    assert found.jacobian(POSITIONS) == pytest.approx(expected.jacobian(POSITIONS))
    assert found.pose(POSITIONS, "world")[1] == pytest.approx(np.eye(3))


def test_what_does_not_fit_is_named() -> None:
    with pytest.raises(UnknownError, match="no link 'e'"):
        Chain(ROBOT, "world", "e", JOINTS)
    with pytest.raises(ControlError, match="'side' does not hang on 'b'"):
        Chain(ROBOT, "b", "side", ())
    with pytest.raises(UnknownError, match="no joint 'j4'; there are: aside, flange, j1, j2"):
        Chain(ROBOT, "world", "d", ("j4",))
    with pytest.raises(ControlError, match="'flange' cannot be moved"):
        Chain(ROBOT, "world", "d", ("flange",))
