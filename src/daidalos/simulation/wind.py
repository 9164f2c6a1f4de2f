"""Wind on links: gz's WindEffects system and Gazebo classic's wind plugin."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.description.markup import Element
from daidalos.description.world import Model, World
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import Component, ComponentContext
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.last_step import velocities
from daidalos.simulation.libraries import library_of
from daidalos.simulation.noise import SILENT, Noise
from daidalos.simulation.sensors.noisy import nested_noise

LIBRARIES = ("gz-sim-wind-effects-system", "WindPlugin")


@dataclass(frozen=True)
class Gust:
    """Variation of a wind component: rise, oscillation and noise.

    Parameters
    ----------
    rise : float
        Time constant [s]; 0 is at once.
    share, swing : float
        Amplitude of the swing, as a share of the value and by itself.
    period : float
        [s].
    noise : Noise
    """

    rise: float = 0.0
    share: float = 0.0
    swing: float = 0.0
    period: float = 1.0
    noise: Noise = SILENT

    def at(self, value: float, time: float, random: np.random.Generator) -> float:
        """Return the component at a time [s] since the start of the wind."""
        mean = value * (1 - math.exp(-time / self.rise)) if self.rise > 0 else value
        wave = math.sin(2 * math.pi * time / self.period)
        return float(self.noise.apply(np.array([mean + (self.share * mean + self.swing) * wave]), random)[0])


class Wind(Component):
    """Wind forces on links: mass times relative wind velocity times the plugin's factor.

    Parameters
    ----------
    context : ComponentContext
        Its world has a plugin for wind, and its model links that are open to it.
    """

    def __init__(self, context: ComponentContext) -> None:
        super().__init__(context)
        element = _plugin(context.world) or Element("plugin")
        level, upright = element.first("horizontal") or Element("horizontal"), element.first("vertical")
        self.factor = element.number_of("force_approximation_scaling_factor", default=1.0)
        self.speed, self.direction = _gust(level, "magnitude"), _gust(level, "direction")
        self.climb = Gust() if upright is None else _gust(upright)
        self._links = windy_links(context.model, context.world)

    def prepare(self, build: ModelBuild) -> None:
        """Disable sleeping of models that the wind may move."""
        build.keep_awake()

    def bind(self, instance: Instance) -> None:
        """Find the links and their masses."""
        self._physics = instance.physics
        self._keys = [f"{instance.name}::{link}/wind" for link in self._links]
        self._bodies = [instance.link(link).body for link in self._links]
        self._masses = instance.physics.model.body_mass[self._bodies]

    def wind_velocity(self, time: float) -> Array:
        """Return the wind's velocity (3,) [m/s] at a simulated time [s]."""
        x, y, z = self.context.world.wind
        speed = self.speed.at(math.hypot(x, y), time, self.random)
        angle = self.direction.at(math.atan2(y, x), time, self.random)
        return np.array((speed * math.cos(angle), speed * math.sin(angle), self.climb.at(z, time, self.random)))

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply the wind forces for the next step."""
        linear, _ = velocities(self._physics, self._bodies)
        forces = self.factor * self._masses[:, None] * (self.wind_velocity(now_ns * 1e-9) - linear)
        for key, body, force in zip(self._keys, self._bodies, forces, strict=True):
            self._physics.forces.hold(key, body, force, np.zeros(3))
        return ()


def windy_links(model: Model, world: World) -> list[str]:
    """Return the links of a model that a world's wind acts on; none without a wind plugin."""
    if model.static or model.scripted or _plugin(world) is None:
        return []
    return [link.name for link in model.links.values() if link.wind or model.wind]


def _plugin(world: World) -> Element | None:
    return next((plugin.element for plugin in world.plugins if library_of(plugin) in LIBRARIES), None)


def _gust(element: Element, tag: str = "") -> Gust:
    """Read the variation of one component; the oscillation of the direction is in degrees."""
    own = element.first(tag) if tag else element
    if own is None:
        return Gust()
    sine = own.first("sin") or Element("sin")
    swing = sine.number_of("amplitude", default=0.0)
    period = sine.number_of("period", default=1.0)
    if period <= 0:
        raise sine.error(f"expected a period above zero, got {period:g}")
    return Gust(
        rise=own.number_of("time_for_rise", default=0.0),
        share=sine.number_of("amplitude_percent", default=0.0),
        swing=math.radians(swing) if tag == "direction" else swing,
        period=period,
        noise=nested_noise(own),
    )
