"""Zones around a robot in which obstacles stop it, slow it down, or limit its velocity."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter, per_name
from daidalos.common.pose2 import inverse, move_along_arc, transform_points

_POINTS = "Corners in the base frame, such as [[0.3, 0.2], [0.3, -0.2], [0.0, 0.0]]"

_ROUNDING = 1e-6
"""Distance [m] by which rounding may bring a point nearer."""

_CIRCLE_CORNERS = 32


@dataclass(frozen=True)
class VelocityZoneParameters(Parameters):
    """Shape of a zone for a range of velocities."""

    points: str = parameter("", f"{_POINTS}.", unit="m")
    linear_min: float = parameter(0.0, "Least forward velocity, or speed where holonomic.", unit="m/s")
    linear_max: float = parameter(0.0, "Greatest forward velocity, or speed where holonomic.", unit="m/s")
    theta_min: float = parameter(0.0, "Least yaw rate.", unit="rad/s")
    theta_max: float = parameter(0.0, "Greatest yaw rate.", unit="rad/s")
    direction_start_angle: float = parameter(-np.pi, "Start of the directions of motion, where holonomic.", unit="rad")
    direction_end_angle: float = parameter(np.pi, "End of the directions of motion, where holonomic.", unit="rad")

    def check(self) -> None:
        """Refuse corners that are not a polygon."""
        corners_of(self.points)


@dataclass(frozen=True)
class ZoneParameters(Parameters):
    """Parameters of a zone, by their Nav2 names."""

    type: str = parameter(
        "polygon", "Shape of the zone.", choices=("polygon", "circle", "velocity_polygon"), read_only=True
    )
    action_type: str = parameter(
        "stop", "What obstacles inside do.", choices=("stop", "slowdown", "limit", "approach", "none"), read_only=True
    )
    enabled: bool = parameter(True, "Whether the zone acts.")
    points: str = parameter("", f"{_POINTS}; empty where a topic gives them.", unit="m", read_only=True)
    radius: float = parameter(0.5, "Radius of a circle.", unit="m", above=0.0, read_only=True)
    min_points: int = parameter(4, "From how many points on there is an obstacle.", minimum=1)
    max_points: int = parameter(-1, "Older name: one less than min_points; -1 where not set.", minimum=-1)
    slowdown_ratio: float = parameter(0.5, "Factor of slowdown.", minimum=0.0, maximum=1.0)
    linear_limit: float = parameter(0.5, "Greatest speed of limit.", unit="m/s", minimum=0.0)
    angular_limit: float = parameter(0.5, "Greatest yaw rate of limit.", unit="rad/s", minimum=0.0)
    time_before_collision: float = parameter(2.0, "Time to a collision that approach keeps.", unit="s", above=0.0)
    simulation_time_step: float = parameter(0.1, "Step of the motion that approach predicts.", unit="s", above=0.0)
    holonomic: bool = parameter(False, "Whether velocity_polygon looks at the direction of motion.", read_only=True)
    velocity_polygons: tuple[str, ...] = parameter((), "Names of its polygons.", unique=True, read_only=True)
    shapes: Mapping[str, VelocityZoneParameters] = per_name(VelocityZoneParameters, by="velocity_polygons", at="")
    footprint_topic: str = parameter(
        "local_costmap/published_footprint", "Topic of the corners of approach, where points is empty.", read_only=True
    )
    polygon_sub_topic: str = parameter("", "Topic of the corners, where points is empty.", read_only=True)
    polygon_subscribe_transient_local: bool = parameter(
        False, "Whether the corners were published before.", read_only=True
    )
    visualize: bool = parameter(False, "Whether the zone is published.", read_only=True)
    polygon_pub_topic: str = parameter("", "Topic of that; the zone's name where empty.", read_only=True)
    sources_names: tuple[str, ...] = parameter(
        (), "Sources that the zone looks at; all where empty.", unique=True, read_only=True
    )

    def check(self) -> None:
        """Refuse zones without a shape."""
        if self.points:
            corners_of(self.points)
        if self.type == "velocity_polygon" and not self.velocity_polygons:
            raise ParameterError("velocity_polygons", "must not be empty for a velocity_polygon")
        if self.type == "polygon" and not self.points and not self.topic:
            raise ParameterError("points", "must not be empty where no topic gives the corners")

    @property
    def topic(self) -> str:
        """Topic of the corners, empty where they do not come from one."""
        if self.type != "polygon" or self.points:
            return ""
        return self.polygon_sub_topic or (self.footprint_topic if self.action_type == "approach" else "")

    @property
    def threshold(self) -> int:
        """Number of points from which on there is an obstacle."""
        return self.min_points if self.max_points < 0 else self.max_points + 1


def corners_of(text: str) -> Array:
    """Return the corners (n, 2) that a text such as ``[[1, 0], [0, 1], [0, 0]]`` gives.

    Raises
    ------
    ParameterError
        When they are not at least three pairs of finite numbers.
    """
    try:
        corners = np.array(ast.literal_eval(text.strip()), dtype=float)
    except (ValueError, SyntaxError, TypeError):
        corners = np.zeros(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
        raise ParameterError("points", f"must be three or more pairs of numbers in a string, got {text!r}")
    return corners


@dataclass(frozen=True)
class Verdict:
    """Outcome of a zone for a velocity.

    Attributes
    ----------
    ratio : float
        Factor of the velocity, from 0 to 1.
    reason : str
        Why the zone cannot be judged, empty where it can.
    """

    ratio: float = 1.0
    reason: str = ""


class Zone:
    """Zone around a robot.

    Parameters
    ----------
    parameters : ZoneParameters

    Attributes
    ----------
    corners : ndarray, shape (n, 2) or None
        Of a polygon; None while it is not known, and for circles.
    """

    def __init__(self, parameters: ZoneParameters) -> None:
        self.parameters = parameters
        self.corners = corners_of(parameters.points) if parameters.points else None

    @property
    def outline(self) -> Array | None:
        """Its corners (n, 2), those of a circle as many points on it; None while they are not known."""
        if self.parameters.type != "circle":
            return self.corners
        angles = np.linspace(0.0, 2.0 * np.pi, _CIRCLE_CORNERS, endpoint=False)
        return self.parameters.radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)

    def judge(self, velocity: Array, points: Array) -> Verdict:
        """Return what becomes of a velocity (x, y, yaw) with obstacle points (n, 2) in the base frame."""
        p = self.parameters
        if p.type == "velocity_polygon":
            self._choose_shape(velocity)
        if p.type != "circle" and self.corners is None:
            return Verdict(0.0, "its shape is not known")
        if p.action_type == "approach":
            return Verdict(min(1.0, self._time_to_collision(velocity, points) / p.time_before_collision))
        if p.action_type == "none" or not self.holds_obstacle(points):
            return Verdict()
        if p.action_type == "stop":
            return Verdict(0.0)
        if p.action_type == "slowdown":
            return Verdict(p.slowdown_ratio)
        speed, turn = float(np.hypot(*velocity[:2])), abs(float(velocity[2]))
        return Verdict(min(_share(p.linear_limit, speed), _share(p.angular_limit, turn)))

    def holds_obstacle(self, points: Array) -> bool:
        """Return whether so many points (n, 2) are inside that they are an obstacle."""
        if self.parameters.type == "circle":
            count = int(np.count_nonzero(np.hypot(points[:, 0], points[:, 1]) < self.parameters.radius))
        else:
            assert self.corners is not None
            count = _count_inside(self.corners, points)
        return count >= self.parameters.threshold

    def _time_to_collision(self, velocity: Array, points: Array) -> float:
        """Return after what time [s] the robot touches an obstacle, infinity where not soon."""
        p = self.parameters
        reach = self._radius + float(np.hypot(velocity[0], velocity[1])) * p.time_before_collision + _ROUNDING
        points = points[np.square(points).sum(axis=1) <= reach * reach]
        if len(points) < p.threshold:
            return np.inf
        for time in np.arange(0.0, p.time_before_collision, p.simulation_time_step):
            x, y, yaw = (velocity * time).tolist()
            if self.holds_obstacle(transform_points(inverse(move_along_arc(np.zeros(3), x, yaw, y)), points)):
                return float(time)
        return np.inf

    @property
    def _radius(self) -> float:
        """Largest distance [m] of a point of the zone from the base's origin."""
        if self.corners is None or self.parameters.type == "circle":
            return self.parameters.radius
        return float(np.hypot(*self.corners.T).max())

    def _choose_shape(self, velocity: Array) -> None:
        """Take the first shape whose range has the velocity; keep the last one where none has."""
        x, y, turn = velocity.tolist()
        speed, direction = (np.hypot(x, y), np.arctan2(y, x)) if self.parameters.holonomic else (x, 0.0)
        for shape in self.parameters.shapes.values():
            start, end = shape.direction_start_angle, shape.direction_end_angle
            within = start <= direction <= end if start <= end else direction >= start or direction <= end
            is_right_way = not self.parameters.holonomic or within
            is_fast = shape.linear_min <= speed <= shape.linear_max and shape.theta_min <= turn <= shape.theta_max
            if is_right_way and is_fast:
                self.corners = corners_of(shape.points)
                return


def _share(limit: float, value: float) -> float:
    return 1.0 if value <= limit else limit / value


def _count_inside(corners: Array, points: Array) -> int:
    """Return how many points are inside of a polygon, by the number of its edges to the right of each."""
    x, y = points[:, 0, None], points[:, 1, None]
    start, end = corners, np.roll(corners, -1, axis=0)
    crosses = (start[:, 1] > y) != (end[:, 1] > y)
    height = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    at = start[:, 0] + (y - start[:, 1]) / height * (end[:, 0] - start[:, 0])
    return int(np.count_nonzero(np.count_nonzero(crosses & (x < at), axis=1) % 2))
