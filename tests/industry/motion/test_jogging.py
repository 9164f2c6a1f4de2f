"""Jogging: axes turn alone, the tool moves along and about the axes of each frame, and what cannot be is refused."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.motion.jogging import axes_of, jog_axis, jog_tool
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots import arm_named

ARM = arm_named("irb120")
JOINTS = np.radians([10.0, 20.0, 10.0, 30.0, 40.0, 50.0])
TOOL = np.eye(4)
TOOL[:3, 3] = [0.01, 0.02, 0.1]
WOBJ = np.eye(4)
WOBJ[:3, :3] = Rotation.from_euler("z", 30.0, degrees=True).as_matrix()


def tip(joints: np.ndarray) -> np.ndarray:
    """Return the pose of the tool."""
    return np.asarray(forward(ARM, joints) @ TOOL)


def test_an_axis_turns_alone() -> None:
    moved = jog_axis(ARM, JOINTS, 3, 0.1)
    assert np.flatnonzero(moved != JOINTS).tolist() == [3]
    with pytest.raises(MotionFault, match="50027"):
        jog_axis(ARM, JOINTS, 3, 4.0)


@pytest.mark.parametrize("frame", ["base", "tool", "wobj"])
def test_the_tool_moves_and_turns_about_its_tip_in_a_frame(frame: str) -> None:
    axes = axes_of(frame, ARM, JOINTS, TOOL, WOBJ)  # type: ignore[arg-type]
    before = tip(JOINTS)
    moved = tip(jog_tool(ARM, JOINTS, TOOL, axes, np.array([0.01, -0.02, 0.005]), np.zeros(3)))
    assert moved[:3, 3] - before[:3, 3] == pytest.approx(axes @ [0.01, -0.02, 0.005], abs=1e-9)
    assert moved[:3, :3] == pytest.approx(before[:3, :3], abs=1e-9)
    turned = tip(jog_tool(ARM, JOINTS, TOOL, axes, np.zeros(3), np.array([0.0, 0.05, 0.0])))
    assert turned[:3, 3] == pytest.approx(before[:3, 3], abs=1e-9)
    turn = Rotation.from_matrix(turned[:3, :3] @ before[:3, :3].T).as_rotvec()
    assert turn == pytest.approx(axes @ [0.0, 0.05, 0.0], abs=1e-9)


def test_what_is_out_of_reach_or_changes_the_configuration_is_refused() -> None:
    with pytest.raises(MotionFault, match="50050"):
        jog_tool(ARM, JOINTS, TOOL, np.eye(3), np.array([2.0, 0.0, 0.0]), np.zeros(3))
    singular = np.radians([0.0, 0.0, 0.0, 0.0, 0.05, 0.0])
    with pytest.raises(MotionFault, match="50026"):
        jog_tool(ARM, singular, np.eye(4), np.eye(3), np.array([0.0, 0.02, 0.0]), np.zeros(3))
