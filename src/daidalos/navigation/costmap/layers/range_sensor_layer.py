"""Range sensor layer: what sonars and infrared sensors see within their cones, as probabilities."""

import math
from collections import deque
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import compose, wrap
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import FREE_SPACE, LETHAL_OBSTACLE, NO_INFORMATION, Bounds, Costmap, Window
from daidalos.navigation.costmap.observation import RangeData

_EVEN = 127
"""Value of a cell that is as likely free as occupied; 0 is surely free, 254 surely occupied."""

_EXPECTED = 233
"""Value that the cell at the end of the axis has before a measurement is applied: one is enough for an obstacle."""

_MAX_READINGS = 1_000
"""Number of measurements that wait for an update at most; the oldest are dropped."""

_LEAST, _MOST = 1.0, 253.0
"""Limits of the values, so that no measurement makes a cell certain for ever."""


@dataclass(frozen=True)
class RangeSensorLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the layer is used.")
    topics: tuple[str, ...] = parameter((), "Topics of the sensors.", unique=True, read_only=True)
    input_sensor_type: str = parameter(
        "ALL",
        "What the sensors measure: VARIABLE distances, or FIXED ones, infinite for nothing and minus infinite for "
        "something; ALL decides by whether a sensor's least range is its largest.",
        choices=("ALL", "VARIABLE", "FIXED"),
        read_only=True,
    )
    phi: float = parameter(1.2, "Distance at which the certainty of a measurement is half.", unit="m", above=0.0)
    inflate_cone: float = parameter(
        1.0, "Share of the cone's width by which a measurement that clears acts beyond it.", minimum=0.0, maximum=1.0
    )
    no_readings_timeout: float = parameter(
        0.0, "Time without measurements after which the costmap is out of date; 0 for ever.", unit="s", minimum=0.0
    )
    clear_threshold: float = parameter(0.2, "Probability below which a cell is free.", minimum=0.0, maximum=1.0)
    mark_threshold: float = parameter(0.8, "Probability above which a cell is an obstacle.", minimum=0.0, maximum=1.0)
    clear_on_max_reading: bool = parameter(False, "Whether a measurement of the largest range clears the whole cone.")


class RangeSensorLayer(Layer):
    """Layer of the probability that cells are occupied, by the Bayes filter of a sonar's cone.

    A measurement lowers the probability of the cells before it and raises that of those at its distance, the more so
    the nearer it is and the nearer they are to the cone's axis (Moravec and Elfes 1985; the weights are those of
    Nav2's layer, which the parameters are of, too).
    """

    names = ("nav2_costmap_2d::RangeSensorLayer",)
    clearable = True
    Parameters = RangeSensorLayerParameters
    parameters: RangeSensorLayerParameters

    def __init__(
        self, parameters: RangeSensorLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._belief: Costmap | None = None
        self._readings: deque[tuple[RangeData, Array]] = deque(maxlen=_MAX_READINGS)
        self._latest: dict[str, float] = {}

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        return tuple(Input(topic, RangeData, partial(self.add_range, topic)) for topic in self.parameters.topics)

    def add_range(self, topic: str, reading: RangeData, base_pose: Array, stamp: float) -> None:
        """Take a measurement of a sensor, to be used at the next update."""
        self._readings.append((reading, compose(base_pose, reading.sensor_pose)))
        self._latest[topic] = stamp

    def missing_input(self, now: float) -> str:
        """Return which sensor has measured nothing for ``no_readings_timeout``."""
        limit = self.parameters.no_readings_timeout
        if limit <= 0.0:
            return ""
        for topic in self.parameters.topics:
            if topic not in self._latest:
                return f"there is no measurement on '{topic}'"
            age = now - self._latest[topic]
            if not -limit <= age <= limit:
                return f"the latest measurement on '{topic}' is {age:.3g} s old, longer than {limit:g} s"
        return ""

    def age_of_input(self, now: float) -> float:
        """Implement `Layer.age_of_input` by ``no_readings_timeout``."""
        limit = self.parameters.no_readings_timeout
        if limit <= 0.0:
            return 0.0
        return max(((now - self._latest.get(topic, -np.inf)) / limit for topic in self.parameters.topics), default=0.0)

    def match_size(self, costmap: Costmap) -> None:
        """Keep what is known of cells that are still inside of the costmap."""
        if self._belief is None or self._belief.resolution != costmap.resolution:
            self._belief = Costmap.filled(costmap.width, costmap.height, costmap.resolution, costmap.origin, _EVEN)
        else:
            self._belief.cover(costmap.width, costmap.height, costmap.origin, _EVEN)

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Apply the new measurements, and return their bounds."""
        if self._belief is None:
            return bounds
        while self._readings:
            reading, pose = self._readings.popleft()
            found = self._interpreted(reading)
            if found is not None:
                bounds = bounds.including(self._integrate(self._belief, pose, *found, reading.field_of_view))
        return bounds

    def _interpreted(self, reading: RangeData) -> tuple[float, bool] | None:
        """Return the distance [m] up to which a measurement says something, and whether there is something at it."""
        p = self.parameters
        kind = p.input_sensor_type
        if kind == "ALL":
            kind = "FIXED" if reading.min_range == reading.max_range else "VARIABLE"
        if kind == "FIXED":
            if not math.isinf(reading.range) or (reading.range > 0.0 and not p.clear_on_max_reading):
                return None
            return reading.max_range, reading.range < 0.0
        if not reading.min_range <= reading.range <= reading.max_range:
            return None
        is_free = reading.range == reading.max_range and p.clear_on_max_reading
        return reading.range, not is_free

    def _integrate(self, belief: Costmap, pose: Array, distance: float, hit: bool, field_of_view: float) -> Bounds:
        """Update the cells of a cone, and return its bounds."""
        half = 0.5 * field_of_view
        wide = half if hit else half * (1.0 + self.parameters.inflate_cone)
        reach = distance * (1.0 + belief.resolution) + belief.resolution
        edges = pose[2] + np.linspace(-wide, wide, 9)
        corners = pose[:2] + reach * np.stack([np.cos(edges), np.sin(edges)], axis=-1)
        bounds = Bounds().including_points(np.vstack([pose[:2], corners])).expanded(belief.resolution)
        part = belief.window_of(bounds)
        if part.empty:
            return bounds
        rows, columns = np.mgrid[part.slices]
        x = belief.origin[0] + (columns + 0.5) * belief.resolution - pose[0]
        y = belief.origin[1] + (rows + 0.5) * belief.resolution - pose[1]
        away, aside = np.hypot(x, y), np.abs(wrap(np.arctan2(y, x) - pose[2]))
        occupied = self._occupied(distance, away, aside, half, belief.resolution) if hit else np.zeros_like(away)
        if hit:
            self._expect(belief, pose[:2] + distance * np.array([math.cos(pose[2]), math.sin(pose[2])]))
        prior = belief.costs[part.slices] / LETHAL_OBSTACLE
        both = occupied * prior
        after = both / np.maximum(both + (1.0 - occupied) * (1.0 - prior), 1e-12)
        values = np.clip(np.rint(LETHAL_OBSTACLE * after), _LEAST, _MOST).astype(np.uint8)
        inside = (aside <= wide) & (away <= reach)
        belief.costs[part.slices][inside] = values[inside]
        return bounds

    def _expect(self, belief: Costmap, place: Array) -> None:
        """Take the cell at the end of a cone's axis to be occupied, for the measurement that is applied then."""
        column, row = belief.world_to_map(*place)
        if 0 <= column < belief.width and 0 <= row < belief.height:
            belief.costs[row, column] = _EXPECTED

    def _occupied(self, distance: float, away: Array, aside: Array, half: float, resolution: float) -> Array:
        """Return the probability that a measurement alone gives cells at a distance and an angle off the axis."""
        axial = 1.0 - (np.minimum(aside, half) / half) ** 2 if half > 0.0 else np.ones_like(aside)
        certainty = axial * (1.0 - 0.5 * (1.0 + np.tanh(2.0 * (away - self.parameters.phi))))
        width = max(resolution * distance, 1e-9)
        ramp = 0.5 * certainty * ((away - (distance - 2.0 * width)) / width) ** 2 + 0.5 * (1.0 - certainty)
        peak = certainty * (0.5 - 0.5 * ((distance - away) / width) ** 2) + 0.5
        zones = [away < distance - 2.0 * width, away < distance - width, away < distance + width]
        return np.select(zones, [0.5 * (1.0 - certainty), ramp, peak], 0.5)

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Mark what is probably occupied, and unknown cells that are probably free."""
        if self._belief is None:
            return
        probability = self._belief.costs[window.slices] / LETHAL_OBSTACLE
        costs: NDArray[np.uint8] = costmap.costs[window.slices]
        costs[(costs == NO_INFORMATION) & (probability < self.parameters.clear_threshold)] = FREE_SPACE
        costs[probability > self.parameters.mark_threshold] = LETHAL_OBSTACLE

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Forget what was measured inside of a window of cells, or outside."""
        if self._belief is None:
            return
        kept = np.zeros(self._belief.costs.shape, np.bool_)
        kept[keep.slices] = True
        self._belief.costs[kept == inside] = _EVEN
