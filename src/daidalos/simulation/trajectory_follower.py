"""Joints that follow a trajectory without forces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from daidalos.samples.commands import PositionTrajectoryCommand
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import Component, ComponentContext
from daidalos.simulation.instance import Instance


@dataclass
class ActiveTrajectory:
    """Trajectory with its start time."""

    command: PositionTrajectoryCommand
    start_ns: int


class TrajectoryFollower(Component):
    """Component that sets the joints of a model to the positions of a trajectory in every step until its end.

    Parameters
    ----------
    context : ComponentContext
    """

    state: ActiveTrajectory | None

    def __init__(self, context: ComponentContext) -> None:
        super().__init__(context)
        self.period = 0.0

    def bind(self, instance: Instance) -> None:
        """Record the model whose joints move."""
        self._instance = instance

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Set the joints to their positions at the current time."""
        if self.state is not None and place_joints(self._instance, self.state, now_ns):
            self.state = None
        return ()


def place_joints(
    instance: Instance, course: ActiveTrajectory, now_ns: int, joint_of: Callable[[str], str] = lambda name: name
) -> bool:
    """Set joints to the interpolated positions of a trajectory.

    Parameters
    ----------
    instance : Instance
    course : Course
    now_ns : int
    joint_of : callable
        Turns the course's names into the model's.

    Returns
    -------
    bool
        Whether the course is at its end.
    """
    elapsed = (now_ns - course.start_ns) * 1e-9
    times, positions = course.command.times, course.command.positions
    data = instance.physics.data
    for column, name in enumerate(course.command.joints):
        joint = instance.joint(joint_of(name))
        data.qpos[joint.qpos] = np.interp(elapsed, times, positions[:, column])
        data.qvel[joint.dof] = 0.0
    instance.physics.changed()
    return bool(elapsed >= times[-1])
