"""Simulated welding cell: an arm whose joints have springs, dampers, play and friction, on MuJoCo.

Each axis is a hinge that a fixed tendon pulls towards the angle of its motor: a spring beyond its play and none within
it, with a damper in both. The motors follow the programmed path exactly.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.elasticity import PER_AXIS, Elasticity
from daidalos.industry.elasticity.jacobians import AXES, joint_offsets
from daidalos.industry.robots.arm import Arm

TIMESTEP = 1e-3
MAX_DEVIATIONS = 2.0
"""Standard deviations at which drawn parameters are cut off."""
_LINK_WIDTH = 0.3
"""Width that the links' moments of inertia are computed for [m]."""


@dataclass(frozen=True)
class Run:
    """State of the cell at each sample.

    Attributes
    ----------
    times : array of shape (n,)
        [s]
    positions : array of shape (n, 3)
        The tool's centre point in the base [m].
    joints : array of shape (n, 6)
        Angles of the links [rad].
    """

    times: NDArray[np.float64]
    positions: NDArray[np.float64]
    joints: NDArray[np.float64]


def drawn(elasticity: Elasticity, seed: int) -> Elasticity:
    """Return an elasticity drawn from the uncertainty of another, as that of a robot that nobody knows exactly."""
    rng = np.random.default_rng(seed)
    values = {}
    for name in PER_AXIS:
        if name == "mass":
            continue  # the tool's is in it, and gravity is of no account where the robot was taught unloaded
        deviations = np.clip(rng.normal(size=6), -MAX_DEVIATIONS, MAX_DEVIATIONS) * elasticity.uncertainty[name]
        values[name] = np.maximum(getattr(elasticity, name) + deviations, 0.0)
    return replace(elasticity, **values)


class SimulatedCell:
    """An arm with compliant joints that holds a tool.

    Parameters
    ----------
    arm, elasticity : Arm, Elasticity
        The arm; the elasticity holds the mass of its tool.
    tool : array of shape (4, 4)
        The tool's centre point in tool0.
    gravity : bool
        Whether there is gravity; without, the arm is as one that was taught unloaded.
    friction : bool
        Whether the joints have Coulomb friction.
    """

    def __init__(
        self, arm: Arm, elasticity: Elasticity, tool: NDArray[np.float64], gravity: bool = False, friction: bool = True
    ) -> None:
        import mujoco

        self._mujoco = mujoco
        self._half_play = 0.5 * elasticity.backlash
        self._balancing = elasticity.balancing if gravity else np.zeros(6)
        text = _mjcf(arm, elasticity, tool, gravity, friction)
        self._model = mujoco.MjModel.from_xml_string(text)
        self._data = mujoco.MjData(self._model)
        self._tip = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_SITE, "tip")
        self._last = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_BODY, "link_6")

    def run(
        self,
        motors: NDArray[np.float64],
        wrenches: NDArray[np.float64],
        sample_period: float,
        axes: NDArray[np.float64] | None = None,
    ) -> Run:
        """Simulate.

        Parameters
        ----------
        motors : array of shape (m, 6)
            The motors' angles after the gears, every `TIMESTEP` [rad].
        wrenches : array of shape (m, 6)
            What the tool exerts on the workpiece, every `TIMESTEP` [N, Nm].
        sample_period : float
            Time between samples [s].
        axes : array of shape (3, 3) or None
            Axes of the wrenches in the base; None for those of the tool, which turn with it.
        """
        model, data, mujoco = self._model, self._data, self._mujoco
        data.qpos[:] = motors[0]
        data.qvel[:] = 0.0
        every = max(round(sample_period / TIMESTEP), 1)
        lower, upper = motors - self._half_play, motors + self._half_play
        positions, joints = [], []
        for step in range(len(motors)):
            model.tendon_lengthspring[:, 0] = lower[step]
            model.tendon_lengthspring[:, 1] = upper[step]
            mujoco.mj_step1(model, data)
            if step % every == 0:
                positions.append(data.site_xpos[self._tip].copy())
                joints.append(data.qpos.copy())
            self._apply(wrenches[step], axes)
            mujoco.mj_step2(model, data)
        times = np.arange(len(positions), dtype=np.float64) * (TIMESTEP * every)
        return Run(times, np.array(positions), np.array(joints))

    def _apply(self, wrench: NDArray[np.float64], axes: NDArray[np.float64] | None) -> None:
        """Apply the workpiece's reaction and the torques of the counterbalance."""
        data = self._data
        turn = axes if axes is not None else data.site_xmat[self._tip].reshape(3, 3)
        force, moment = -(turn @ wrench.reshape(2, 3).T).T
        data.qfrc_applied[:] = -self._balancing * np.sin(data.qpos)
        self._mujoco.mj_applyFT(
            self._model,
            data,
            force,
            moment,
            data.site_xpos[self._tip],
            self._last,
            data.qfrc_applied,
        )


def _mjcf(arm: Arm, elasticity: Elasticity, tool: NDArray[np.float64], gravity: bool, friction: bool) -> str:
    """Return the model as MJCF."""
    from daidalos.common.pose3 import Pose

    bodies, tendons = [], []
    offsets = joint_offsets(arm)
    reaches = [*np.linalg.norm(offsets[1:], axis=1), 0.5]
    for axis in range(6):
        mass = elasticity.mass[axis]
        inertia = mass * (reaches[axis] ** 2 + _LINK_WIDTH**2) / 12.0
        direction = " ".join("1" if coordinate == AXES[axis] else "0" for coordinate in range(3))
        loss = elasticity.coulomb_friction[axis] if friction else 0.0
        bodies.append(
            f'<body name="link_{axis + 1}" pos="{_text(offsets[axis])}">'
            f'<inertial pos="{_text(elasticity.centre_of_mass[axis])}" mass="{mass}" '
            f'diaginertia="{_text(np.full(3, inertia))}"/>'
            f'<joint name="joint_{axis + 1}" type="hinge" axis="{direction}" frictionloss="{loss}"/>'
        )
        tendons.append(
            f'<fixed stiffness="{elasticity.stiffness[axis]}" damping="{elasticity.damping[axis]}" springlength="0 0">'
            f'<joint joint="joint_{axis + 1}" coef="1"/></fixed>'
        )
    flange = np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    tip = Pose.from_matrix(flange @ tool)
    x, y, z, w = tip.orientation
    down = "0 0 -9.80665" if gravity else "0 0 0"
    return (
        f'<mujoco><option timestep="{TIMESTEP}" gravity="{down}" integrator="implicitfast"/>'
        f"<worldbody>{''.join(bodies)}"
        f'<site name="tip" pos="{_text(np.array(tip.position))}" quat="{w} {x} {y} {z}"/>'
        f"{'</body>' * 6}</worldbody><tendon>{''.join(tendons)}</tendon></mujoco>"
    )


def _text(values: NDArray[np.float64]) -> str:
    return " ".join(repr(float(value)) for value in values)
