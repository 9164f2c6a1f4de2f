"""Actors: figures that follow a script and push obstacles."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.description.actors import actor_pose
from daidalos.description.world import Actor
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import Component, ComponentContext
from daidalos.simulation.instance import Instance


class ActorMotion(Component):
    """Component that moves an actor along its script.

    Parameters
    ----------
    actor : Actor
    context : ComponentContext
    """

    period = 0.02

    def __init__(self, actor: Actor, context: ComponentContext) -> None:
        super().__init__(context)
        self._actor = actor

    def bind(self, instance: Instance) -> None:
        """Find the actor's body."""
        self._data = instance.physics.data
        self._mocap = int(instance.physics.model.body(instance.name).mocapid[0])

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Move the actor to its pose at the current time."""
        pose = actor_pose(self._actor, now_ns * 1e-9)
        x, y, z, w = pose.orientation
        self._data.mocap_pos[self._mocap] = pose.position
        self._data.mocap_quat[self._mocap] = (w, x, y, z)
        return ()
