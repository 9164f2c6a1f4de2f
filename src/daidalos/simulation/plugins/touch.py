"""Touch plugin: reports once that a model has touched another for a time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.description.link import Plugin as Description
from daidalos.samples.sensors import FlagSample, Sample
from daidalos.simulation.contracts import ComponentContext, Plugin, Switch
from daidalos.simulation.instance import Instance
from daidalos.simulation.topics import absolute_topic


@dataclass
class Watch:
    """Whether the plugin is enabled, and since when there is contact [ns]."""

    on: bool
    since_ns: int | None = None


class Touch(Plugin):
    """gz's TouchPlugin: ``/<namespace>/touched``, and ``/<namespace>/enable`` to enable it again.

    Without a namespace the model's name is one.
    """

    names = ("gz-sim-touchplugin-system", "gz-sim-touch-plugin-system")
    sample = FlagSample
    state: Watch

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.target = element.text_of("target")
        if not self.target:
            raise element.error("<target> is needed: a part of the name of what is to be touched")
        namespace = element.text_of("namespace", default=context.model_name)
        self.time_ns = round(element.number_of("time", default=0.0) * 1e9)
        self.on = element.flag_of("enabled", default=False)
        self.topic = absolute_topic(f"{namespace}/touched", context.namespace)
        self.service = absolute_topic(f"{namespace}/enable", context.namespace)

    @property
    def switches(self) -> Mapping[str, Switch]:
        """Service that enables or disables the plugin."""
        return {self.service: Switch(self._switch)}

    def bind(self, instance: Instance) -> None:
        """Find the geoms of both models."""
        self._data = instance.physics.data
        self._physics = instance.physics
        count = instance.physics.model.ngeom
        self._mine, self._other = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        for geom, (model, info) in instance.physics.geoms.items():
            self._mine[geom] = model == instance.name
            scoped = f"{model}::{info.link}::{info.collision}"
            self._other[geom] = model != instance.name and self.target in scoped

    def start(self) -> Watch:
        """Return whether the plugin is initially enabled."""
        return Watch(self.on)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Check for contact."""
        watch = self.state
        if not watch.on:
            return
        self._physics.refresh_positions()
        pairs = self._data.contact.geom
        touches = (self._mine[pairs] & self._other[pairs[:, ::-1]]).any()
        if not touches:
            watch.since_ns = None
            return
        watch.since_ns = now_ns if watch.since_ns is None else watch.since_ns
        if now_ns - watch.since_ns >= self.time_ns:
            self._switch(on=False)
            yield FlagSample(now_ns, self.topic, "", value=True)

    def _switch(self, on: bool) -> None:
        self.state.on, self.state.since_ns = on, None
