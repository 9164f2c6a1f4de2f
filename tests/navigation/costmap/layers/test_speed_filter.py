"""Speed limits of a mask, at the places of the robot."""

import numpy as np
import pytest

from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import NavigationContext, SpeedLimit
from daidalos.navigation.costmap.costmap import Bounds
from daidalos.navigation.costmap.costmap_filter import FilterInfo, FilterMask
from daidalos.navigation.costmap.layers.speed_filter import SpeedFilter, SpeedFilterParameters


def made(kind, base, multiplier, values):
    lines = []
    limiter = SpeedFilter(SpeedFilterParameters(), NavigationContext(name="zones", warn=lines.append))
    assert limiter.set_info(FilterInfo(kind, "mask", base, multiplier)) is not None
    limiter.set_mask(FilterMask(OccupancyGrid(np.array([values], dtype=np.int8), 1.0, (0.0, 0.0, 0.0)), "map"))
    return limiter, lines


def limit_at(limiter, x):
    assert limiter.update_bounds(np.array([x, 0.5, 0.0]), 0.0, Bounds()).empty
    (output,) = limiter.outputs
    return output.give()


def test_percentages_are_of_the_maximum():
    limiter, lines = made(1, 100.0, -1.0, [0, 25, 75])
    assert [limit_at(limiter, x) for x in (0.5, 1.5, 1.6, 2.5, 0.5, 0.5)] == [
        None,
        SpeedLimit(75.0, percentage=True),
        None,
        SpeedLimit(25.0, percentage=True),
        SpeedLimit(0.0, percentage=True),
        None,
    ]
    assert lines == []


def test_speeds_are_in_metres_per_second():
    limiter, _ = made(2, 0.0, 0.01, [0, 25])
    assert limit_at(limiter, 1.5) == SpeedLimit(0.25, percentage=False)


def test_the_last_limit_stays_where_the_mask_is_unknown_or_ends():
    limiter, lines = made(1, 0.0, 1.0, [40, -1])
    assert limit_at(limiter, 0.5).value == 40.0
    assert [limit_at(limiter, x) for x in (1.5, 1.6, 7.0)] == [None] * 3
    assert lines == ["zones: the mask is unknown where the robot is; the last speed limit stays"]


@pytest.mark.parametrize(("kind", "base", "text"), [(1, 90.0, "130%"), (1, -90.0, "-50%"), (2, -90.0, "-50 m/s")])
def test_impossible_limits_mean_none(kind, base, text):
    limiter, lines = made(kind, base, 1.0, [40])
    assert limit_at(limiter, 0.5) is None
    assert lines == [f"zones: a speed limit of {text} for 40 in the mask is not possible; it means no limit"]


def test_a_new_mask_and_its_meaning_act_at_once():
    limiter, _ = made(1, 0.0, 1.0, [40])
    assert limit_at(limiter, 0.5).value == 40.0
    limiter.set_info(FilterInfo(2, "mask", 0.0, 0.01))
    assert limit_at(limiter, 0.5) == SpeedLimit(0.4, percentage=False)
    limiter.set_mask(FilterMask(OccupancyGrid(np.array([[0]], dtype=np.int8), 1.0, (0.0, 0.0, 0.0)), "map"))
    assert limit_at(limiter, 0.5) == SpeedLimit(0.0, percentage=False)
