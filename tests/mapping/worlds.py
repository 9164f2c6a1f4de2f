"""Synthetic worlds with known truth: walls as segments, an exact ray caster, a robot that drives around."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData

Array = NDArray[np.float64]


def box(x: float, y: float, width: float, height: float, yaw: float = 0.0) -> Array:
    """The four walls of a rectangle around (x, y) as segments (4, 4): x0, y0, x1, y1."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (width / 2, height / 2)
    rotation = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    corners = corners @ rotation.T + (x, y)
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)


def arena() -> Array:
    """A walled floor of 8 m x 6 m with four obstacles."""
    return np.concatenate(
        [
            box(0.0, 0.0, 8.0, 6.0),
            box(-1.5, 1.0, 0.8, 0.5, 0.3),
            box(1.8, -1.2, 0.6, 1.0),
            box(1.5, 1.6, 0.5, 0.5, 0.8),
            box(-2.2, -1.4, 1.0, 0.3, -0.4),
        ]
    )


def corridors() -> Array:
    """A square ring of corridors 2 m wide and 18 m long, with niches that tell its sides apart."""
    niches = [
        box(-4.0, 9.2, 1.0, 0.4),
        box(3.0, -9.1, 0.6, 0.6),
        box(9.2, 4.5, 0.4, 1.5),
        box(-9.1, -2.0, 0.5, 0.8),
    ]
    pillars = [
        box(5.5, 6.9, 0.7, 0.4),
        box(-6.9, 3.0, 0.4, 0.5),
        box(-2.0, -6.9, 1.2, 0.4),
        box(6.9, -5.0, 0.4, 0.9),
    ]
    return np.concatenate([box(0.0, 0.0, 19.0, 19.0), box(0.0, 0.0, 14.0, 14.0), *niches, *pillars])


def cast(segments: Array, origin: Array, angles: Array, longest: float = 25.0) -> Array:
    """Distance from an origin to the first wall in each direction; infinity where none is within reach."""
    direction = np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None, :]
    start = segments[None, :, :2] - origin[:2]
    along = segments[None, :, 2:] - segments[None, :, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        determinant = direction[..., 0] * along[..., 1] - direction[..., 1] * along[..., 0]
        distance = (start[..., 0] * along[..., 1] - start[..., 1] * along[..., 0]) / determinant
        share = (start[..., 0] * direction[..., 1] - start[..., 1] * direction[..., 0]) / determinant
    hit = (distance > 0.0) & (share >= 0.0) & (share <= 1.0)
    nearest = np.where(hit, distance, np.inf).min(axis=1)
    return np.where(nearest <= longest, nearest, np.inf)


def drive(corners: Array, *, speed: float = 0.5, turn_rate: float = 1.5, rate: float = 15.0) -> Array:
    """Poses (n, 3) of a robot that goes from corner to corner, turning on the spot at each."""
    yaw = float(np.arctan2(*(corners[1] - corners[0])[::-1]))
    legs = [np.array([[*corners[0], yaw]])]
    for start, end in pairwise(corners):
        heading = float(np.arctan2(*(end - start)[::-1]))
        turn = (heading - yaw + np.pi) % (2.0 * np.pi) - np.pi
        yaws = yaw + np.linspace(0.0, turn, int(np.ceil(abs(turn) / turn_rate * rate)) + 1)[1:]
        legs.append(np.column_stack([np.tile(start, (len(yaws), 1)), yaws]))
        way = np.linspace(start, end, max(1, int(np.ceil(np.linalg.norm(end - start) / speed * rate))) + 1)[1:]
        legs.append(np.column_stack([way, np.full(len(way), heading)]))
        yaw = heading
    return np.concatenate(legs)


def wheel_odometry(truth: Array, rng: np.random.Generator, *, scale: float = 0.01, noise: float = 0.02) -> Array:
    """Truth as wheels would tell it: a wrong radius and base, and slip in proportion to the motion."""
    odometry = [truth[0].copy()]
    for before, after in pairwise(truth):
        dx, dy = after[:2] - before[:2]
        turn = (after[2] - before[2] + np.pi) % (2.0 * np.pi) - np.pi
        forward = np.cos(before[2]) * dx + np.sin(before[2]) * dy
        forward *= 1.0 + scale + noise * rng.standard_normal()
        turn = turn * (1.0 - scale + noise * rng.standard_normal()) + 0.002 * abs(forward) * rng.standard_normal()
        x, y, yaw = odometry[-1]
        odometry.append(np.array([x + forward * np.cos(yaw), y + forward * np.sin(yaw), yaw + turn]))
    return np.array(odometry)


@dataclass(frozen=True)
class Lidar:
    """A planar lidar on a robot."""

    beams: int = 820
    field: float = np.deg2rad(270.0)
    noise: float = 0.01
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def increment(self) -> float:
        return self.field / (self.beams - 1)

    def scan(self, segments: Array, robot: Array, rng: np.random.Generator) -> LaserScanData:
        """What the lidar of a robot that stands at a pose measures."""
        x, y, yaw = self.pose
        cosine, sine = np.cos(robot[2]), np.sin(robot[2])
        origin = np.array([robot[0] + cosine * x - sine * y, robot[1] + sine * x + cosine * y])
        angles = robot[2] + yaw - self.field / 2 + self.increment * np.arange(self.beams)
        ranges = cast(segments, origin, angles) + self.noise * rng.standard_normal(self.beams)
        return LaserScanData(ranges, -self.field / 2, self.increment, 0.05, 25.0, 0.0, self.pose)


def raster(segments: Array, resolution: float) -> OccupancyGrid:
    """The walls as occupied cells of a grid that covers them, found by walking along each in small steps."""
    step = 0.1 * resolution
    points = np.concatenate(
        [np.linspace(s[:2], s[2:], max(2, int(np.ceil(np.hypot(*(s[2:] - s[:2])) / step)))) for s in segments]
    )
    corner = np.floor(points.min(axis=0) / resolution) * resolution
    cells = np.floor((points - corner) / resolution).astype(int)
    data = np.zeros(cells.max(axis=0)[::-1] + 1, np.int8)
    data[cells[:, 1], cells[:, 0]] = 100
    return OccupancyGrid(data, resolution, (float(corner[0]), float(corner[1]), 0.0))


def room_scan(pose: Array, *, beams: int = 360, noise: float = 0.0, seed: int = 0) -> LaserScanData:
    """A full-circle scan of the arena from a pose."""
    lidar = Lidar(beams=beams, field=2.0 * np.pi * (beams - 1) / beams, noise=noise)
    return lidar.scan(arena(), np.asarray(pose, dtype=np.float64), np.random.default_rng(seed))
