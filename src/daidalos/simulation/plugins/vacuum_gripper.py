"""Vacuum gripper: holds the nearest thing while it is on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.description.link import Plugin as Description
from daidalos.description.pose import Pose
from daidalos.simulation.component import Setting, Switch
from daidalos.simulation.instance import Instance, LinkView
from daidalos.simulation.plugins.base import Plugin
from daidalos.simulation.samples import FlagSample, Sample

Array = NDArray[np.float64]

_BANDWIDTH = 60.0
"""Of the spring that holds [rad/s]: stiff, and still well below the steps' rate."""


@dataclass
class Hold:
    """Whether the pump runs, what hangs on it (model, link), and where that is in the gripper's frame."""

    on: bool = False
    held: tuple[str, str] | None = None
    place: Pose | None = None
    due_ns: int = 0


class VacuumGripper(Plugin):
    """``libgazebo_ros_vacuum_gripper.so`` of ROS 1 and 2.

    What is held hangs on a stiff spring and damper to where it was when it was gripped, and pulls back at
    the gripper with the same force.
    """

    names = ("gazebo_ros_vacuum_gripper",)
    memory: Hold

    def __init__(self, description: Description, setting: Setting) -> None:
        super().__init__(description, setting)
        element, parameters, links = description.element, self.parameters, setting.model.links
        self.link = parameters.scoped(element.text_of("bodyName", "link_name", "body_name"))
        if self.link not in links:
            raise element.error(f"<link_name> is {self.link!r}, expected one of the links {', '.join(links)}")
        self.reach = element.number_of("maxDistance", "max_distance", default=0.05)
        self.fixed = frozenset(child.text.strip() for child in element.all("fixed"))
        self.is_ros1 = element.first("topicName") is not None or element.first("bodyName") is not None
        topic = element.text_of("topicName", default="grasping")
        self.topic = parameters.topic(f"{topic}/grasping" if self.is_ros1 else topic)
        names = (f"{topic}/on", f"{topic}/off") if self.is_ros1 else ("switch",)
        self._services = tuple(parameters.topic(name) for name in names)
        self._key = f"{setting.model_name}::{description.name}"

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Whether something is held."""
        return {self.topic: FlagSample}

    @property
    def switches(self) -> Mapping[str, Switch]:
        """One service that is told on or off, or ROS 1's two."""
        if self.is_ros1:
            on, off = self._services
            return {on: Switch(self.switch, True), off: Switch(self.switch, False)}
        return {self._services[0]: Switch(self.switch)}

    def switch(self, on: bool) -> None:
        """Turn the pump on or off."""
        self.memory.on = on

    def bind(self, instance: Instance) -> None:
        """Find the gripper."""
        self._instance = instance
        self._physics = instance.physics
        self._gripper = instance.link(self.link)

    def start(self) -> Hold:
        """Hold nothing."""
        return Hold()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Take, hold or let go."""
        hold = self.memory
        if hold.on and hold.held is None:
            self._take()
        elif not hold.on and hold.held is not None:
            hold.held = hold.place = None
        target = self._target()
        if target is not None and hold.place is not None:
            self._pull(target, hold.place)
        else:
            self._let_go()
        if now_ns >= hold.due_ns:
            hold.due_ns = now_ns + 100_000_000
            yield FlagSample(now_ns, self.topic, "", target is not None)

    def _target(self) -> LinkView | None:
        """Return the link that is held; None when it is gone."""
        if self.memory.held is None:
            return None
        body = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_BODY, "::".join(self.memory.held))
        return LinkView(self._physics, body) if body >= 0 else None

    def _take(self) -> None:
        """Hold the nearest link that can move, if one is in reach."""
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
                self.memory.held = model, info.link
                self.memory.place = self._gripper.pose.inverse @ LinkView(physics, body).pose

    def _distance(self, geom: int, point: Array) -> float:
        """Return how far a point is from the box around a geom."""
        model, data = self._physics.model, self._physics.data
        local = data.geom_xmat[geom].reshape(3, 3).T @ (point - data.geom_xpos[geom])
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        return float(np.linalg.norm(np.maximum(np.abs(local - centre) - half, 0.0)))

    def _pull(self, target: LinkView, place: Pose) -> None:
        model, data = self._physics.model, self._physics.data
        wanted = self._gripper.pose @ place
        error = (target.pose.inverse @ wanted).orientation
        turn = 2 * np.array(error[:3]) * np.sign(error[3] or 1.0)
        linear, angular = target.velocity()
        own_linear, own_angular = self._gripper.velocity()
        arm = np.array(wanted.position) - np.array(self._gripper.pose.position)
        mass = float(model.body_subtreemass[target.body])
        moment = float(model.body_inertia[target.body].mean())
        gap = np.array(wanted.position) - np.array(target.pose.position)
        slip = own_linear + np.cross(own_angular, arm) - linear
        force = mass * (_BANDWIDTH**2 * gap + 2 * _BANDWIDTH * slip - np.array(model.opt.gravity))
        torque = moment * (_BANDWIDTH**2 * (target.rotation @ turn) + 2 * _BANDWIDTH * (own_angular - angular))
        # The force acts at the link's origin; forces are held at centres of mass.
        at_target = np.array(target.pose.position) - data.xipos[target.body]
        at_gripper = np.array(target.pose.position) - data.xipos[self._gripper.body]
        forces = self._physics.forces
        forces.hold(f"{self._key}/held", target.body, force, torque + np.cross(at_target, force))
        forces.hold(f"{self._key}/own", self._gripper.body, -force, -torque - np.cross(at_gripper, force))

    def _let_go(self) -> None:
        for part in ("held", "own"):
            self._physics.forces.release(f"{self._key}/{part}")
