"""Vacuum gripper: holds the nearest link while it is on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.link import Plugin as Description
from daidalos.samples.sensors import FlagSample, Sample
from daidalos.simulation.contracts import ComponentContext, Plugin, Switch
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance, LinkView
from daidalos.simulation.plugins.holding import Weld


@dataclass
class Hold:
    """Whether the pump runs, the held link (model, link), and its pose in the gripper's frame."""

    on: bool = False
    held: tuple[str, str] | None = None
    place: Pose | None = None
    due_ns: int = 0


class VacuumGripper(Plugin):
    """``libgazebo_ros_vacuum_gripper.so`` of ROS 1 and 2.

    What is held is welded to where it was when it was gripped.
    """

    names = ("gazebo_ros_vacuum_gripper",)
    sample = FlagSample
    state: Hold

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, parameters = description.element, self.parameters
        self.link = parameters.require_link("bodyName", "link_name", "body_name")
        self.reach = element.number_of("maxDistance", "max_distance", default=0.05)
        self.fixed = frozenset(child.text.strip() for child in element.all("fixed"))
        self.is_ros1 = element.first("topicName") is not None or element.first("bodyName") is not None
        topic = element.text_of("topicName", default="grasping")
        self.topic = parameters.topic(f"{topic}/grasping" if self.is_ros1 else topic)
        names = (f"{topic}/on", f"{topic}/off") if self.is_ros1 else ("switch",)
        self._name = description.name
        self._services = tuple(parameters.topic(name) for name in names)

    @property
    def switches(self) -> Mapping[str, Switch]:
        """One service with an on or off argument, or ROS 1's two."""
        if self.is_ros1:
            on, off = self._services
            return {on: Switch(self.switch, True), off: Switch(self.switch, False)}
        return {self._services[0]: Switch(self.switch)}

    def switch(self, on: bool) -> None:
        """Switch the pump on or off."""
        self.state.on = on

    def prepare(self, build: ModelBuild) -> None:
        """Add the weld that holds."""
        self._weld = Weld(build, self.link, self._name)

    def bind(self, instance: Instance) -> None:
        """Find the gripper."""
        self._weld.bind(instance)
        self._instance = instance
        self._physics = instance.physics
        self._gripper = instance.link(self.link)

    def start(self) -> Hold:
        """Return the state with the pump off."""
        return Hold()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Grip, hold or release."""
        hold = self.state
        if hold.on and hold.held is None:
            self._take()
        elif not hold.on and hold.held is not None:
            hold.held = hold.place = None
        target = self._target()
        if target is not None and hold.place is not None:
            self._weld.hold(target.body, hold.place)
        else:
            self._weld.release()
        if now_ns >= hold.due_ns:
            hold.due_ns = now_ns + 100_000_000
            yield FlagSample(now_ns, self.topic, "", target is not None)

    def _target(self) -> LinkView | None:
        """Return the held link; None if it no longer exists."""
        if self.state.held is None:
            return None
        body = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_BODY, "::".join(self.state.held))
        return LinkView(self._physics, body) if body >= 0 else None

    def _take(self) -> None:
        """Grip the nearest movable link within reach."""
        physics = self._physics
        physics.refresh_positions()
        here = np.array(self._gripper.pose.position)
        best = self.reach
        for geom, (model, info) in physics.geoms.items():
            body = int(physics.model.geom_bodyid[geom])
            if model == self._instance.name or model in self.fixed or physics.model.body_weldid[body] == 0:
                continue
            away = self._distance(geom, here)
            if away < best:
                best = away
                self.state.held = model, info.link
                self.state.place = self._gripper.pose.inverse @ LinkView(physics, body).pose

    def _distance(self, geom: int, point: Array) -> float:
        """Return the distance of a point from the bounding box of a geom."""
        model, data = self._physics.model, self._physics.data
        local = data.geom_xmat[geom].reshape(3, 3).T @ (point - data.geom_xpos[geom])
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        return float(np.linalg.norm(np.maximum(np.abs(local - centre) - half, 0.0)))
