"""Footprint of a robot, and the maximum cost under it."""

import ast
import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import transform_points
from daidalos.navigation.costmap.costmap import (
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    NO_INFORMATION,
    Costmap,
    CostmapError,
    Costs,
)

CIRCLE_CORNERS = 16


@dataclass(frozen=True)
class Footprint:
    """Footprint of a robot in its base frame.

    Attributes
    ----------
    polygon : ndarray, shape (n, 2)
        Corners [m] in order; a circle is given by 16 of them.
    inscribed_radius : float
        Largest circle [m] around the base's origin inside of the outline; 0 where the origin is outside.
    circumscribed_radius : float
        Smallest circle [m] around the base's origin that holds the outline.
    circular : bool
        Whether the outline is a circle, so that the cost at the centre decides about contact.
    """

    polygon: Array
    inscribed_radius: float
    circumscribed_radius: float
    circular: bool

    @classmethod
    def circle(cls, radius: float) -> "Footprint":
        """Return the footprint of a round robot.

        Raises
        ------
        CostmapError
            The radius is not positive.
        """
        if not (math.isfinite(radius) and radius > 0.0):
            raise CostmapError(f"robot_radius must be a positive length in metres, not {radius}")
        angles = np.arange(CIRCLE_CORNERS) * (2.0 * np.pi / CIRCLE_CORNERS)
        polygon = radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        return cls(polygon, radius, radius, circular=True)

    @classmethod
    def of_corners(cls, corners: Array, padding: float = 0.0) -> "Footprint":
        """Return the footprint of corners (n, 2), each moved outward by a padding [m] along both axes.

        Raises
        ------
        CostmapError
            There are fewer than three corners, or one is not finite.
        """
        polygon = np.array(corners, dtype=np.float64)
        if polygon.ndim != 2 or polygon.shape[1] != 2 or polygon.shape[0] < 3 or not np.isfinite(polygon).all():
            raise CostmapError(f"footprint must be at least three corners [x, y] in metres, not {corners!r}")
        polygon = polygon + padding * np.sign(polygon)
        return cls(
            polygon,
            _distance_to_outline(polygon) if _holds_origin(polygon) else 0.0,
            float(np.hypot(polygon[:, 0], polygon[:, 1]).max()),
            circular=False,
        )

    @classmethod
    def from_parameters(
        cls, footprint: str = "[]", robot_radius: float = 0.1, footprint_padding: float = 0.01
    ) -> "Footprint":
        """Return the footprint of a Nav2 costmap's parameters; a polygon takes precedence over the radius.

        Raises
        ------
        CostmapError
            The text is not a list of corners such as `"[[0.2, 0.15], [0.2, -0.15], [-0.2, 0.0]]"`.
        """
        try:
            corners = ast.literal_eval(footprint) if footprint.strip() else []
            points = np.array(corners, dtype=np.float64)
        except (ValueError, SyntaxError, TypeError):
            raise CostmapError(
                f"footprint must be corners such as [[0.2, 0.15], [0.2, -0.15], [-0.2, 0.0]], not {footprint!r}"
            ) from None
        if points.size == 0:
            return cls.circle(robot_radius)
        return cls.of_corners(points, footprint_padding)

    def at(self, pose: Array) -> Array:
        """Return the corners (n, 2) at a pose (x, y, yaw)."""
        return transform_points(pose, self.polygon)


class FootprintCollisionChecker:
    """Collision checker of a footprint.

    Parameters
    ----------
    costmap : Costmap
        An inflated costmap, so that 253 marks cells in which the robot's centre means contact.
    footprint : Footprint
        Outline of the robot.
    """

    def __init__(self, costmap: Costmap, footprint: Footprint) -> None:
        self.costmap = costmap
        self.footprint = footprint

    def footprint_cost_at(self, pose: Array) -> int:
        """Return the maximum cost under the robot at a pose (x, y, yaw): 254 on contact, 255 if unknown.

        A round robot is judged by the cost at its centre, as inflation has already grown the obstacles by its
        radius; any other by the cells along its outline.
        """
        if not self.footprint.circular:
            return outline_cost(
                self.costmap.costs,
                self.costmap.resolution,
                self.costmap.origin,
                self.footprint.polygon,
                float(pose[0]),
                float(pose[1]),
                float(pose[2]),
            )
        cost = self.costmap.cost_at(float(pose[0]), float(pose[1]))
        return LETHAL_OBSTACLE if cost == INSCRIBED_INFLATED_OBSTACLE else cost

    def in_collision(self, pose: Array) -> bool:
        """Return whether the robot at a pose touches a known obstacle."""
        return self.footprint_cost_at(pose) == LETHAL_OBSTACLE


@compiled
def outline_cost(costs: Costs, resolution: float, origin: Array, polygon: Array, x: float, y: float, yaw: float) -> int:
    """Return the maximum cost along a polygon (n, 2) at a pose; unknown counts only if nothing is lethal."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    corners = polygon.shape[0]
    highest = 0
    unknown = False
    px = x + cosine * polygon[corners - 1, 0] - sine * polygon[corners - 1, 1]
    py = y + sine * polygon[corners - 1, 0] + cosine * polygon[corners - 1, 1]
    for i in range(corners):
        qx = x + cosine * polygon[i, 0] - sine * polygon[i, 1]
        qy = y + sine * polygon[i, 0] + cosine * polygon[i, 1]
        steps = max(math.ceil(2.0 * math.hypot(qx - px, qy - py) / resolution), 1)
        for k in range(steps):
            share = k / steps
            column = math.floor((px + share * (qx - px) - origin[0]) / resolution)
            row = math.floor((py + share * (qy - py) - origin[1]) / resolution)
            if row < 0 or column < 0 or row >= costs.shape[0] or column >= costs.shape[1]:
                unknown = True
                continue
            cost = int(costs[row, column])
            if cost == NO_INFORMATION:
                unknown = True
            elif cost > highest:
                highest = cost
        if highest == LETHAL_OBSTACLE:
            return highest
        px, py = qx, qy
    return NO_INFORMATION if unknown else highest


def fill_polygon(costmap: Costmap, polygon: Array, value: int) -> None:
    """Set every cell whose centre is inside of a polygon (n, 2) in the costmap's frame to a value."""
    _fill_polygon(costmap.costs, costmap.resolution, costmap.origin, polygon, value)


@compiled
def _fill_polygon(costs: Costs, resolution: float, origin: Array, polygon: Array, value: int) -> None:
    corners = polygon.shape[0]
    left = max(math.floor((polygon[:, 0].min() - origin[0]) / resolution), 0)
    right = min(math.floor((polygon[:, 0].max() - origin[0]) / resolution) + 1, costs.shape[1])
    bottom = max(math.floor((polygon[:, 1].min() - origin[1]) / resolution), 0)
    top = min(math.floor((polygon[:, 1].max() - origin[1]) / resolution) + 1, costs.shape[0])
    for row in range(bottom, top):
        y = origin[1] + (row + 0.5) * resolution
        for column in range(left, right):
            x = origin[0] + (column + 0.5) * resolution
            inside = False
            j = corners - 1
            for i in range(corners):
                if (polygon[i, 1] > y) != (polygon[j, 1] > y):
                    slope = (polygon[j, 0] - polygon[i, 0]) / (polygon[j, 1] - polygon[i, 1])
                    if x < polygon[i, 0] + slope * (y - polygon[i, 1]):
                        inside = not inside
                j = i
            if inside:
                costs[row, column] = value


def _holds_origin(polygon: Array) -> bool:
    inside = False
    for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, 1, axis=0), strict=True):
        if (ay > 0.0) != (by > 0.0) and ax + (bx - ax) * (0.0 - ay) / (by - ay) > 0.0:
            inside = not inside
    return inside


def _distance_to_outline(polygon: Array) -> float:
    """Return the distance [m] from the origin to the nearest edge."""
    ends = np.roll(polygon, -1, axis=0)
    edges = ends - polygon
    along = np.clip(-(polygon * edges).sum(axis=1) / np.maximum((edges * edges).sum(axis=1), 1e-12), 0.0, 1.0)
    nearest = polygon + along[:, None] * edges
    return float(np.hypot(nearest[:, 0], nearest[:, 1]).min())
