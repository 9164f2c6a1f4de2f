"""Detachable joint: holds a link of another model until told to release it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import mujoco

from daidalos.common.pose3 import Pose
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import SignalCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import Sample, TextSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance, LinkView
from daidalos.simulation.plugins.holding import Weld
from daidalos.simulation.topics import absolute_topic


@dataclass
class Attachment:
    """Whether the other link is to be held, the pose at which it was taken, and the last published state."""

    wanted: bool = True
    place: Pose | None = None
    said: str = ""


class DetachableJoint(Plugin):
    """gz's DetachableJoint system: attached from the start, as soon as the other model exists."""

    names = ("gz-sim-detachable-joint-system",)
    unused = ("suppress_child_warning",)
    state: Attachment

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.parent = self.parameters.require_link("parent_link")
        self.child = element.text_of("child_model"), element.text_of("child_link")
        if not all(self.child):
            raise element.error("<child_model> and <child_link> are needed")
        base = f"/model/{context.model_name}/detachable_joint"
        self.attach, self.detach, self.output = (
            absolute_topic(element.text_of(*tags, default=f"{base}/{word}"), context.namespace)
            for tags, word in (
                (("attach_topic",), "attach"),
                (("detach_topic", "topic"), "detach"),
                (("output_topic",), "state"),
            )
        )
        self._name = description.name

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of ``attached`` or ``detached``, published on changes."""
        return {self.output: TextSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topics to attach and detach."""
        return {
            self.attach: Subscription(SignalCommand, lambda command: self._switch(on=True)),
            self.detach: Subscription(SignalCommand, lambda command: self._switch(on=False)),
        }

    def prepare(self, build: ModelBuild) -> None:
        """Add the weld that holds."""
        self._weld = Weld(build, self.parent, f"{self._name}::{'::'.join(self.child)}")

    def bind(self, instance: Instance) -> None:
        """Find the holding link."""
        self._weld.bind(instance)
        self._physics = instance.physics
        self._holder = instance.link(self.parent)
        self._same = self.child[0] in (instance.name, "__model__")

    def start(self) -> Attachment:
        """Return the attached state."""
        return Attachment()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Hold or release the other link."""
        state = self.state
        target = self._target() if state.wanted else None
        if target is None:
            state.place = None
            self._weld.release()
        else:
            state.place = state.place or self._holder.pose.inverse @ target.pose
            self._weld.hold(target.body, state.place)
        word = "detached" if target is None else "attached"
        if word != state.said:
            state.said = word
            yield TextSample(now_ns, self.output, "", word)

    def _switch(self, on: bool) -> None:
        self.state.wanted = on

    def _target(self) -> LinkView | None:
        """Return the other link, None if it does not exist."""
        model, link = self.child
        name = f"{self.context.model_name if self._same else model}::{link}"
        body = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_BODY, name)
        return LinkView(self._physics, body) if body >= 0 else None
