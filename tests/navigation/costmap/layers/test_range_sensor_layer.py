"""The layer of sonars: a Bayes filter over the cells of their cones."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.costmap.costmap import NO_INFORMATION
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.range_sensor_layer import RangeSensorLayer, RangeSensorLayerParameters
from daidalos.navigation.costmap.observation import RangeData

ROBOT = np.zeros(3)
FIELD_OF_VIEW = 0.5
AT_FRONT = np.array([0.1, 0.0, 0.0])


def measured(*distances: float, least: float = 0.02, most: float = 4.0, **parameters: Any) -> LayeredCostmap:
    """Return a costmap whose layer has taken some measurements of a sonar at the robot's front."""
    layer = RangeSensorLayer(RangeSensorLayerParameters(topics=("sonar",), **parameters))
    layered = LayeredCostmap(
        CostmapParameters(rolling_window=True, width=6.0, height=6.0, track_unknown_space=True), [layer]
    )
    layered.update(ROBOT, 0.0)
    for distance in distances:
        layer.add_range("sonar", RangeData(distance, least, most, FIELD_OF_VIEW, AT_FRONT), ROBOT, 0.0)
        layered.update(ROBOT, 0.0)
    return layered


def test_what_is_measured_again_and_again_is_an_obstacle_with_free_space_before_it() -> None:
    costs = measured(*[0.8] * 8).costmap
    assert costs.cost_at(0.9, 0.0) == 254
    assert costs.cost_at(0.4, 0.0) == 0
    assert costs.cost_at(1.2, 0.0) == NO_INFORMATION
    assert costs.cost_at(0.1 + 0.8 * math.cos(0.4), 0.8 * math.sin(0.4)) == NO_INFORMATION


def test_one_measurement_is_enough_for_an_obstacle() -> None:
    assert measured(0.8).costmap.cost_at(0.9, 0.0) == 254


def test_an_obstacle_that_is_gone_is_cleared() -> None:
    assert measured(*[0.8] * 8, *[1.6] * 12).costmap.cost_at(0.9, 0.0) == 0


def test_one_measurement_follows_bayes_rule() -> None:
    """On the axis of the cone, well before the distance, the sensor model is (1 - delta) / 2."""
    layered = measured(2.0, phi=1.2)
    (layer,) = layered.layers
    belief = layer._belief
    column, row = belief.world_to_map(0.725, 0.025)
    x, y = belief.origin + (np.array([column, row]) + 0.5) * belief.resolution - AT_FRONT[:2]
    away = math.hypot(x, y)
    axial = 1.0 - (math.atan2(y, x) / (FIELD_OF_VIEW / 2)) ** 2
    delta = axial * (1.0 - 0.5 * (1.0 + math.tanh(2.0 * (away - 1.2))))
    model, prior = 0.5 * (1.0 - delta), 127 / 254
    expected = model * prior / (model * prior + (1.0 - model) * (1.0 - prior))
    assert belief.costs[row, column] == pytest.approx(254 * expected, abs=1.0)


def test_the_largest_range_clears_only_where_it_is_asked_for() -> None:
    assert measured(*[4.0] * 20).costmap.cost_at(0.6, 0.0) == 0  # nothing before it
    kept, cleared = (measured(*[0.8] * 8, *[4.0] * 20, clear_on_max_reading=clear) for clear in (False, True))
    assert cleared.costmap.cost_at(2.5, 0.0) == 0
    assert kept.costmap.cost_at(2.5, 0.0) != 0


def test_sensors_of_a_fixed_distance_say_whether_there_is_something() -> None:
    detected = measured(-math.inf, least=0.5, most=0.5).costmap
    assert detected.cost_at(0.6, 0.0) == 254
    free = measured(*[math.inf] * 12, least=0.5, most=0.5, clear_on_max_reading=True).costmap
    assert free.cost_at(0.5, 0.0) == 0
    ignored = measured(*[math.inf] * 12, least=0.5, most=0.5).costmap
    assert ignored.cost_at(0.5, 0.0) == NO_INFORMATION


def test_silence_is_named() -> None:
    layer = RangeSensorLayer(RangeSensorLayerParameters(topics=("sonar",), no_readings_timeout=0.5))
    assert layer.missing_input(0.0) == "there is no measurement on 'sonar'"
    layer.add_range("sonar", RangeData(1.0, 0.0, 4.0, FIELD_OF_VIEW, AT_FRONT), ROBOT, 1.0)
    assert layer.missing_input(1.4) == ""
    assert layer.age_of_input(1.25) == pytest.approx(0.5)
    assert layer.missing_input(1.6) == "the latest measurement on 'sonar' is 0.6 s old, longer than 0.5 s"
    assert RangeSensorLayer(RangeSensorLayerParameters(topics=("sonar",))).missing_input(9.0) == ""


def test_clearing_forgets() -> None:
    layered = measured(*[0.8] * 8)
    layered.clear_entirely()
    layered.update(ROBOT, 0.0)
    assert layered.costmap.cost_at(0.9, 0.0) == NO_INFORMATION


@given(
    distance=st.floats(allow_nan=True, allow_infinity=True),
    least=st.floats(0.0, 1.0),
    most=st.floats(0.0, 1e6),
    view=st.floats(0.0, 2.0 * math.pi),
)
def test_any_measurement_is_taken_or_left_out(distance: float, least: float, most: float, view: float) -> None:
    layer = RangeSensorLayer(RangeSensorLayerParameters(topics=("sonar",)))
    layered = LayeredCostmap(CostmapParameters(rolling_window=True, width=2.0, height=2.0), [layer])
    layer.add_range("sonar", RangeData(distance, least, most, view, AT_FRONT), ROBOT, 0.0)
    layered.update(ROBOT, 0.0)
    layered.update(ROBOT, 0.1)
    assert 1 <= layer._belief.costs.min() <= layer._belief.costs.max() <= 253
