"""A flat world of walls and posts for closed-loop tests: exact rays, exact contact, a robot that drives and turns.

Independent of the grids under test: everything here is plane geometry.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numba import njit  # without its cache, which would bind the kernels to one module name

from daidalos.mapping.scan import LaserScanData


@dataclass(frozen=True)
class FlatWorld:
    """Walls as segments (n, 4) of (x0, y0, x1, y1) and posts as circles (m, 3) of (x, y, radius)."""

    segments: np.ndarray
    circles: np.ndarray

    def cast(self, origin, angles, max_range):
        """Distance to the first hit along each ray; infinite beyond max_range."""
        return _cast(self.segments, self.circles, float(origin[0]), float(origin[1]), angles, max_range)

    def clearance(self, point):
        """Distance from a point to the nearest wall or post."""
        return _clearance(self.segments, self.circles, float(point[0]), float(point[1]))

    def polygon_clear(self, corners):
        """Whether a convex polygon (n, 2) touches nothing."""
        return _polygon_clear(self.segments, self.circles, corners)

    def rasterised(self, resolution, origin, shape):
        """Occupancy (0 or 100) of a grid whose cells a wall or post touches."""
        height, width = shape
        occupancy = np.zeros(shape, dtype=np.int8)
        for row in range(height):
            for column in range(width):
                x = origin[0] + (column + 0.5) * resolution
                y = origin[1] + (row + 0.5) * resolution
                if self.clearance((x, y)) <= 0.5 * resolution:
                    occupancy[row, column] = 100
        return occupancy


def box(x, y, width, height):
    """Four segments of a rectangle given by its lower left corner."""
    return np.array(
        [
            (x, y, x + width, y),
            (x + width, y, x + width, y + height),
            (x + width, y + height, x, y + height),
            (x, y + height, x, y),
        ]
    )


def arena():
    """8 x 6 m: four rooms with doors of 0.8 m, furniture and posts."""
    walls = [
        box(0.0, 0.0, 8.0, 6.0),
        box(2.95, 0.0, 0.1, 1.2),
        box(2.95, 2.0, 0.1, 2.2),
        box(2.95, 5.0, 0.1, 1.0),
        box(3.05, 2.95, 1.35, 0.1),
        box(5.2, 2.95, 2.8, 0.1),
        box(0.0, 2.55, 1.0, 0.1),
        box(1.8, 2.55, 1.15, 0.1),
        box(5.6, 0.9, 0.6, 0.4),
        box(6.9, 4.4, 0.5, 0.5),
        box(0.9, 4.2, 0.4, 0.7),
    ]
    posts = np.array(
        [(1.3, 1.0, 0.1), (4.4, 1.6, 0.12), (4.6, 4.6, 0.1), (5.7, 5.0, 0.15), (7.2, 2.2, 0.1), (2.2, 3.6, 0.08)]
    )
    return FlatWorld(np.concatenate(walls), posts)


def barn_world(data, index):
    """World of the BARN benchmark: posts of one radius."""
    first, last = data["offsets"][index], data["offsets"][index + 1]
    xy = data["cylinder_xy"][first:last].astype(np.float64)
    radius = np.full((xy.shape[0], 1), float(data["radius"]))
    return FlatWorld(np.zeros((0, 4)), np.concatenate([xy, radius], axis=1))


@dataclass
class FlatRobot:
    """A robot with a planar lidar that follows velocity commands within limits of acceleration."""

    world: FlatWorld
    pose: np.ndarray
    radius: float = 0.22
    outline: np.ndarray | None = None
    max_speed: float = 0.5
    max_turn: float = 1.8
    max_accel: float = 2.5
    max_turn_accel: float = 8.0
    beams: int = 820
    field_of_view: float = 2.0 * math.pi
    max_range: float = 25.0
    sensor_pose: tuple[float, float, float] = (-0.064, 0.0, 0.0)
    range_noise: float = 0.01
    seed: int = 0
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    contact: bool = False
    min_clearance: float = math.inf
    travelled: float = 0.0

    def __post_init__(self):
        self.generator = np.random.default_rng(self.seed)
        self.increment = self.field_of_view / self.beams
        self.angle_min = -0.5 * self.field_of_view
        self.angles = self.angle_min + self.increment * np.arange(self.beams)

    def drive(self, command, duration, step=0.01):
        """Follow a command (x, y, yaw) for a while, in steps of 10 ms."""
        wanted = (
            min(max(float(command[0]), -self.max_speed), self.max_speed),
            min(max(float(command[2]), -self.max_turn), self.max_turn),
        )
        for _ in range(round(duration / step)):
            v, w = float(self.velocity[0]), float(self.velocity[2])
            v += min(max(wanted[0] - v, -self.max_accel * step), self.max_accel * step)
            w += min(max(wanted[1] - w, -self.max_turn_accel * step), self.max_turn_accel * step)
            heading = self.pose[2] + 0.5 * w * step
            self.pose = self.pose + step * np.array([v * math.cos(heading), v * math.sin(heading), w])
            self.pose[2] = (self.pose[2] + math.pi) % (2.0 * math.pi) - math.pi
            self.velocity = np.array([v, 0.0, w])
            self.travelled += abs(v) * step
            self._feel()

    def _feel(self):
        free = self.world.clearance(self.pose) - self.radius
        self.min_clearance = min(self.min_clearance, free)
        if self.outline is None:
            self.contact |= free <= 0.0
        elif free <= 0.5:
            c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
            corners = self.outline @ np.array([[c, s], [-s, c]]) + self.pose[:2]
            self.contact |= not self.world.polygon_clear(corners)

    def scan(self):
        """Ranges as a lidar gives them: infinite where nothing was hit, with noise."""
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        x, y, yaw = self.sensor_pose
        origin = (self.pose[0] + c * x - s * y, self.pose[1] + s * x + c * y)
        ranges = self.world.cast(origin, self.angles + self.pose[2] + yaw, self.max_range)
        ranges = ranges + self.range_noise * self.generator.standard_normal(self.beams)
        return LaserScanData(ranges, self.angle_min, self.increment, 0.05, self.max_range, 0.0, self.sensor_pose)


@njit
def _cast(segments, circles, ox, oy, angles, max_range):
    ranges = np.full(angles.shape[0], np.inf)
    for k in range(angles.shape[0]):
        dx, dy = math.cos(angles[k]), math.sin(angles[k])
        best = max_range
        hit = False
        for i in range(segments.shape[0]):
            ax, ay = segments[i, 0] - ox, segments[i, 1] - oy
            ex, ey = segments[i, 2] - segments[i, 0], segments[i, 3] - segments[i, 1]
            cross = dx * ey - dy * ex
            if abs(cross) < 1e-12:
                continue
            distance = (ax * ey - ay * ex) / cross
            share = (ax * dy - ay * dx) / cross
            if 0.0 <= distance < best and 0.0 <= share <= 1.0:
                best = distance
                hit = True
        for i in range(circles.shape[0]):
            ax, ay = circles[i, 0] - ox, circles[i, 1] - oy
            along = ax * dx + ay * dy
            across = circles[i, 2] ** 2 - (ax * ax + ay * ay - along * along)
            if along > 0.0 and across >= 0.0:
                distance = along - math.sqrt(across)
                if 0.0 <= distance < best:
                    best = distance
                    hit = True
        if hit:
            ranges[k] = best
    return ranges


@njit
def _segment_distance(x, y, ax, ay, bx, by):
    ex, ey = bx - ax, by - ay
    length = ex * ex + ey * ey
    share = 0.0
    if length > 0.0:
        share = min(max(((x - ax) * ex + (y - ay) * ey) / length, 0.0), 1.0)
    return math.hypot(x - ax - share * ex, y - ay - share * ey)


@njit
def _clearance(segments, circles, x, y):
    best = np.inf
    for i in range(segments.shape[0]):
        d = _segment_distance(x, y, segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3])
        best = min(best, d)
    for i in range(circles.shape[0]):
        best = min(best, math.hypot(x - circles[i, 0], y - circles[i, 1]) - circles[i, 2])
    return best


@njit
def _polygon_clear(segments, circles, corners):
    n = corners.shape[0]
    for j in range(n):
        ax, ay = corners[j, 0], corners[j, 1]
        bx, by = corners[(j + 1) % n, 0], corners[(j + 1) % n, 1]
        for i in range(circles.shape[0]):
            if _segment_distance(circles[i, 0], circles[i, 1], ax, ay, bx, by) <= circles[i, 2]:
                return False
        for i in range(segments.shape[0]):
            cx, cy, dx, dy = segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3]
            one = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            two = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
            three = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
            four = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
            if one * two <= 0.0 and three * four <= 0.0:
                return False
    return True
