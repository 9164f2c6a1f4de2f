"""Keepout zones: costs of a mask, its place, and the way out of a zone."""

import math

import numpy as np
import pytest

from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap, CostmapError
from daidalos.navigation.costmap.costmap_filter import FilterInfo, FilterMask
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.keepout_filter import KeepoutFilter, KeepoutFilterParameters

ORIGIN = np.zeros(3)


class Bench:
    """A costmap of 4 m by 3 m with one filter, whose warnings and transforms the test gives."""

    def __init__(self, **parameters):
        self.lines = []
        self.frames = {}
        context = NavigationContext(name="zones", warn=self.lines.append, locate=self.frames.get)
        self.filter = KeepoutFilter(KeepoutFilterParameters(**parameters), context)
        self.layered = LayeredCostmap(CostmapParameters(width=4.0, height=3.0, resolution=1.0), [self.filter])

    def show(self, data, origin=(0.0, 0.0, 0.0), frame="map", resolution=1.0):
        grid = OccupancyGrid(np.array(data, dtype=np.int8), resolution, origin)
        self.filter.set_mask(FilterMask(grid, frame))

    def update(self, pose=ORIGIN, now=0.0):
        self.layered.update(np.asarray(pose, dtype=float), now)
        return self.layered.costmap.costs.tolist()


def test_costs_are_raised_to_those_of_the_mask():
    bench = Bench()
    bench.show([[0, 50, 99, 100]])
    assert bench.update()[0] == [0, 127, 251, 254]
    costmap = Costmap.filled(4, 1, 1.0, (0.0, 0.0), 200)
    bench.filter.update_costs(costmap, costmap.window)
    assert costmap.costs.tolist() == [[200, 200, 251, 254]]
    costmap = Costmap.filled(4, 1, 1.0, (0.0, 0.0), 255)
    bench.show([[-1, 0, 99, 100]])
    bench.filter.update_costs(costmap, costmap.window)
    assert costmap.costs.tolist() == [[255, 0, 251, 254]]


def test_a_new_mask_replaces_the_last_one():
    bench = Bench()
    bench.show([[100, 0]])
    assert bench.update()[0] == [254, 0, 0, 0]
    bench.show([[0, 100]])
    assert bench.update()[0] == [0, 254, 0, 0]
    assert bench.layered.update(ORIGIN, 0.0).empty


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
def test_masks_lie_where_their_origin_and_frame_are(turn):
    bench = Bench()
    bench.show([[0, 100]], origin=(1.0, 0.5, 0.0), frame="floor", resolution=0.5)
    yaw = turn * math.pi / 2
    bench.frames["floor"] = (np.array([2.0, 1.0, yaw]), 0.0)
    column, row = (int(value) for value in np.array([2.0, 1.0]) + rotated((1.75, 0.75), yaw))
    costs = np.array(bench.update(), dtype=int)
    expected = np.zeros((3, 4), dtype=int)
    # The middle of a costmap's cell, 1 m wide, has to lie in the mask's cell, 0.5 m wide.
    middle = rotated((column + 0.5 - 2.0, row + 0.5 - 1.0), -yaw)
    if 0 <= column < 4 and 0 <= row < 3 and 1.5 <= middle[0] < 2.0 and 0.5 <= middle[1] < 1.0:
        expected[row, column] = 254
    assert costs.tolist() == expected.tolist()


def rotated(point, yaw):
    cos, sin = math.cos(yaw), math.sin(yaw)
    return np.array([cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]])


def test_the_last_transform_is_used_while_it_is_late():
    bench = Bench(transform_tolerance=0.5)
    bench.show([[100]], frame="floor")
    assert not np.any(bench.update())
    assert "no transform from the mask's frame 'floor'" in bench.lines[0]
    bench.frames["floor"] = (np.array([1.0, 0.0, 0.0]), 0.6)
    assert bench.update()[0] == [0, 254, 0, 0]
    assert "older than transform_tolerance 0.5 s" in bench.lines[1]
    del bench.frames["floor"]
    assert bench.update()[0] == [0, 254, 0, 0]
    bench.frames["floor"] = (np.array([2.0, 0.0, 0.0]), 0.0)
    assert bench.update()[0] == [0, 0, 254, 0]
    assert len(bench.lines) == 2


def test_a_robot_in_a_zone_can_leave_it():
    bench = Bench(override_lethal_cost=True, lethal_override_cost=200)
    bench.show([[100, 100, 0, 100]])
    assert bench.update((0.5, 0.5, 0.0))[0] == [200, 200, 0, 200]
    assert bench.update((1.5, 0.5, 0.0))[0] == [200, 200, 0, 200]
    assert bench.update((2.5, 0.5, 0.0))[0] == [254, 254, 0, 254]
    assert [line for line in bench.lines if "in a keepout zone" in line] == bench.lines
    assert len(bench.lines) == 1
    bench.filter.reconfigure(KeepoutFilterParameters(override_lethal_cost=False))
    assert bench.update((0.5, 0.5, 0.0))[0] == [254, 254, 0, 254]


def test_a_missing_mask_is_one_line():
    bench = Bench(filter_info_topic="zone_info")
    for now in (10.0, 11.9):
        bench.update(now=now)
    assert bench.lines == []
    for now in (12.0, 13.0):
        bench.update(now=now)
    assert bench.lines == ["zones: there is no mask: no nav2_msgs/msg/CostmapFilterInfo came on zone_info"]
    bench.filter.set_info(FilterInfo(0, "zone_mask"))
    for now in (14.0, 15.0):
        bench.update(now=now)
    assert bench.lines[1:] == ["zones: there is no mask: no nav_msgs/msg/OccupancyGrid came on zone_mask"]


def test_information_that_is_of_no_use_is_refused():
    bench = Bench()
    assert bench.filter.set_info(FilterInfo(1, "mask")) is None
    assert bench.lines == ["zones: filter info of type 1 is not used, but only type 0"]
    assert bench.filter.set_info(FilterInfo(0, "")) is None
    asked = bench.filter.set_info(FilterInfo(0, "mask", base=math.nan))
    assert asked is None
    asked = bench.filter.set_info(FilterInfo(0, "mask"))
    assert (asked.topic, asked.type) == ("mask", FilterMask)
    with pytest.raises(CostmapError, match="zones: the mask has no cells"):
        bench.show(np.zeros((0, 0)))
    assert not np.any(bench.update())


def test_a_filter_that_is_switched_off_leaves_the_costs():
    bench = Bench()
    bench.show([[100]])
    bench.update()
    bench.filter.reconfigure(KeepoutFilterParameters(enabled=False))
    assert not np.any(bench.update())
