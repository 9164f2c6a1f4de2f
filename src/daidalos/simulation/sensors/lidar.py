"""Lidar: rays against the world's collision shapes, in one plane or in several rings."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import rotation_matrix
from daidalos.description.link import Sensor as Description
from daidalos.description.markup import Element
from daidalos.samples.sensors import (
    LaserScanSample,
    PointCloudSample,
    RangeSample,
    Sample,
)
from daidalos.simulation.contracts import ComponentContext, Sensor
from daidalos.simulation.conversion.geometry import RAY_GROUPS
from daidalos.simulation.instance import Instance
from daidalos.simulation.noise import read_noise
from daidalos.simulation.sensors.ray_fan import RayFan

MAX_RAYS = 1_000_000
_TURN = 4 * math.pi


@dataclass(frozen=True)
class Fan:
    """Angles of rays in one direction [rad], evenly spaced from the first to the last, which may be the lower."""

    first: float
    last: float
    count: int

    @property
    def step(self) -> float:
        """Angle between adjacent rays [rad]."""
        return (self.last - self.first) / (self.count - 1) if self.count > 1 else 0.0

    @property
    def angles(self) -> Array:
        """Angles of all rays (count,)."""
        return self.first + self.step * np.arange(self.count, dtype=np.float64)


class Lidar(Sensor):
    """Lidar that measures all its rays at one instant.

    A ray that starts inside the robot's own shapes within the least range passes them; anything else
    nearer than that is reported as minus infinity, and nothing within reach as infinity (REP 117).

    Attributes
    ----------
    as_points : bool
        Speak in points rather than ranges; so from the start when there is more than one ring.
    as_range : bool
        Speak of the nearest of all rays alone.
    ultrasound : bool
        What it then claims to be, rather than infrared.
    as_both : bool
        Speak as gz's lidar does: the middle ring's ranges, and points on ``<topic>/points``.
    """

    names = ("ray", "lidar", "gpu_ray", "gpu_lidar")
    default_topic = "scan"

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.as_both = description.type in ("lidar", "gpu_lidar")

    def read(self, element: Element) -> None:
        """Read angles, ranges and noise from ``<ray>`` or ``<lidar>``."""
        settings = element.first("ray", "lidar") or Element("ray", source=element.source, line=element.line)
        scan = settings.first("scan") or Element("scan", source=element.source, line=element.line)
        self.horizontal = _fan(scan.first("horizontal"), 640, scan)
        self.vertical = _fan(scan.first("vertical"), 1, scan)
        limits = settings.first("range") or Element("range", source=element.source, line=element.line)
        self.range_min = limits.number_of("min", default=0.08)
        self.range_max = limits.number_of("max", default=10.0)
        if not 0 <= self.range_min < self.range_max:
            raise limits.error(f"expected 0 <= min < max, got {self.range_min:g} and {self.range_max:g}")
        self.resolution = limits.number_of("resolution", default=0.0)
        self.noise = read_noise(settings.first("noise"))
        self.as_points = self.vertical.count > 1
        self.as_range = self.ultrasound = False
        self._fan = RayFan(self.horizontal.angles, self.vertical.angles)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of the scan, or gz's two topics."""
        if self.as_range:
            return {self.topic: RangeSample}
        if self.as_both:
            return {self.topic: LaserScanSample, self._points_topic: PointCloudSample}
        return {self.topic: PointCloudSample if self.as_points else LaserScanSample}

    def bind(self, instance: Instance) -> None:
        """Find the link and the reflectance of each geom."""
        super().bind(instance)
        physics = instance.physics
        self._fan.bind(physics.model)
        self._reflection = np.zeros(physics.model.ngeom + 1, dtype=np.float32)
        self._own = np.zeros(physics.model.ngeom + 1, dtype=bool)
        for geom, (model, info) in physics.geoms.items():
            self._reflection[geom] = info.laser_retro
            self._own[geom] = model == instance.name

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return measurements if a topic has subscribers."""
        return self.measure(now_ns) if any(map(self.instance.has_subscribers, self.publications)) else ()

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Cast all rays."""
        ranges, geoms = self._cast()
        far = np.isposinf(ranges)
        seen = np.isfinite(ranges)
        ranges[seen] = self.noise.apply(ranges[seen], self.random)
        if self.resolution > 0:
            ranges[seen] = np.round(ranges[seen] / self.resolution) * self.resolution
        ranges[seen] = np.clip(ranges[seen], self.range_min, self.range_max)
        intensities = np.where(far, np.float32(0.0), self._reflection[geoms])
        if self.as_range:
            yield self._nearest(now_ns, ranges)
        elif self.as_both:
            if self.instance.has_subscribers(self.topic):
                middle = slice(self.vertical.count // 2 * self.horizontal.count, None)
                yield self._scan(now_ns, ranges[middle], intensities[middle])
            if self.instance.has_subscribers(self._points_topic):
                yield self._points(now_ns, ranges, intensities, self._points_topic)
        elif self.as_points:
            yield self._points(now_ns, ranges, intensities, self.topic)
        else:
            yield self._scan(now_ns, ranges, intensities)

    @property
    def _points_topic(self) -> str:
        return f"{self.topic}/points"

    def _cast(self) -> tuple[Array, NDArray[np.int32]]:
        """Return the true range of each ray and the geom that it hit (-1: none)."""
        mount = self.link.pose @ self.pose
        origin, rotation = np.array(mount.position), rotation_matrix(mount.orientation)
        ranges, geoms = self._fan.cast(self.instance.physics, origin, rotation, self.link.body, self.range_max)
        ranges[geoms < 0] = np.inf
        for row in np.flatnonzero(ranges < self.range_min):
            if self._own[geoms[row]]:
                ranges[row], geoms[row] = self._cast_past(origin, rotation @ self._fan.directions[row])
            else:
                ranges[row] = -np.inf
        ranges[ranges > self.range_max] = np.inf
        return ranges, geoms

    def _cast_past(self, origin: Array, ray: Array) -> tuple[float, int]:
        """Cast one ray that starts at the minimum range."""
        physics = self.instance.physics
        geom = np.empty(1, dtype=np.int32)
        start = origin + self.range_min * ray
        distance = mujoco.mj_ray(physics.model, physics.data, start, ray, RAY_GROUPS, True, self.link.body, geom)
        return (math.inf, -1) if distance < 0 else (distance + self.range_min, int(geom[0]))

    def _nearest(self, now_ns: int, ranges: Array) -> RangeSample:
        angle = max(abs(fan.last - fan.first) for fan in (self.horizontal, self.vertical))
        limits = self.range_min, self.range_max
        nearest = float(ranges.min())
        return RangeSample(now_ns, self.topic, self.frame_id, angle, *limits, nearest, self.ultrasound)

    def _scan(self, now_ns: int, ranges: Array, intensities: NDArray[np.float32]) -> LaserScanSample:
        return LaserScanSample(
            stamp_ns=now_ns,
            topic=self.topic,
            frame_id=self.frame_id,
            angle_min=self.horizontal.first,
            angle_max=self.horizontal.last,
            angle_increment=self.horizontal.step,
            time_increment=0.0,
            scan_time=self.period,
            range_min=self.range_min,
            range_max=self.range_max,
            ranges=ranges[: self.horizontal.count].astype(np.float32),
            intensities=intensities[: self.horizontal.count],
        )

    def _points(self, now_ns: int, ranges: Array, intensities: NDArray[np.float32], topic: str) -> PointCloudSample:
        shape = (self.vertical.count, self.horizontal.count)
        finite = np.where(np.isfinite(ranges), ranges, np.nan)
        points = (self._fan.directions * finite[:, None]).astype(np.float32)
        points[np.isnan(points)] = np.inf
        return PointCloudSample(
            stamp_ns=now_ns,
            topic=topic,
            frame_id=self.frame_id,
            points=points.reshape(*shape, 3),
            intensities=intensities.reshape(shape),
        )


def _fan(element: Element | None, samples: int, scan: Element) -> Fan:
    """Read the angles of one direction; ``resolution`` scales the number of samples (SDF), at least to 1."""
    if element is None:
        return Fan(0.0, 0.0, 1)
    samples_count = element.integer_of("samples", default=samples)
    wanted = samples_count * element.number_of("resolution", default=1.0)
    count = 1 if 0 < wanted < 1 else round(wanted)
    if not 1 <= count <= MAX_RAYS:
        raise element.error(f"expected 1 to {MAX_RAYS} rays, got {count}")
    first = element.number_of("min_angle", default=0.0)
    last = element.number_of("max_angle", default=0.0)
    if not -_TURN <= first <= _TURN or not -_TURN <= last <= _TURN:
        raise element.error(f"expected angles within two turns, got {first:g} and {last:g}")
    return Fan(first, last, count)
