"""Sonar: distance to the nearest object in a cone."""

from __future__ import annotations

import math
from collections.abc import Iterable

import mujoco
import numpy as np

from daidalos.common.pose3 import rotation_matrix
from daidalos.description.markup import Element
from daidalos.samples.sensors import RangeSample, Sample
from daidalos.simulation.contracts import Sensor
from daidalos.simulation.conversion.geometry import RAY_GROUPS
from daidalos.simulation.noise import read_noise

_RINGS = 6


class Sonar(Sensor):
    """Sonar with evenly distributed rays in a cone along x."""

    names = ("sonar",)
    default_topic = "sonar"
    sample = RangeSample

    def read(self, element: Element) -> None:
        """Read the cone: its length and the radius of its base."""
        settings = element.first("sonar") or Element("sonar")
        self.range_min, self.range_max = settings.number_of("min", default=0.0), settings.number_of("max", default=1.0)
        radius = settings.number_of("radius", default=0.5)
        if not (0 <= self.range_min < self.range_max and radius > 0):
            raise settings.error("expected 0 <= min < max and a positive radius")
        self.angle = 2 * math.atan2(radius, self.range_max)
        self.noise = read_noise(settings.first("noise"))
        self._rays = _cone(self.angle / 2)

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the length of the shortest ray."""
        mount = self.link.pose @ self.pose
        physics = self.instance.physics
        rays = np.ascontiguousarray(self._rays @ rotation_matrix(mount.orientation).T)
        count = len(rays)
        ranges, geoms = np.empty(count), np.empty(count, dtype=np.int32)
        mujoco.mj_multiRay(
            physics.model,
            physics.data,
            np.array(mount.position),
            rays.ravel(),
            RAY_GROUPS,
            True,
            self.link.body,
            geoms,
            ranges,
            None,
            count,
            self.range_max,
        )
        hits = ranges[(geoms >= 0) & (ranges <= self.range_max)]
        nearest = math.inf
        if len(hits):
            nearest = float(self.noise.apply(hits.min(keepdims=True), self.random)[0])
            nearest = -math.inf if nearest < self.range_min else min(nearest, self.range_max)
        yield RangeSample(
            now_ns, self.topic, self.frame_id, self.angle, self.range_min, self.range_max, nearest, ultrasound=True
        )


def _cone(half_angle: float) -> np.ndarray:
    """Return unit vectors (n, 3) in rings about x: one in the centre, six in the first ring, twelve, ..."""
    rays = [(1.0, 0.0, 0.0)]
    for ring in range(1, _RINGS + 1):
        away = half_angle * ring / _RINGS
        turns = np.arange(6 * ring) * (2 * math.pi / (6 * ring))
        rays += [(math.cos(away), math.sin(away) * math.cos(turn), math.sin(away) * math.sin(turn)) for turn in turns]
    return np.array(rays)
