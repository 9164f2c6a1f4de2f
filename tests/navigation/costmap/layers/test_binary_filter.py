"""States of a mask, at the places of the robot."""

import numpy as np
import pytest

from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Bounds
from daidalos.navigation.costmap.costmap_filter import FilterInfo, FilterMask
from daidalos.navigation.costmap.layers.binary_filter import BinaryFilter, BinaryFilterParameters


@pytest.mark.parametrize("default", [False, True])
def test_the_state_flips_above_the_threshold(default):
    lines = []
    context = NavigationContext(name="camera", warn=lines.append)
    switch = BinaryFilter(BinaryFilterParameters(default_state=default, flip_threshold=30.0), context)
    (output,) = switch.outputs

    def state_at(x):
        switch.update_bounds(np.array([x, 0.5, 0.0]), 0.0, Bounds())
        return output.give()

    assert [state_at(0.5), state_at(0.5)] == [default, None]
    switch.set_info(FilterInfo(3, "mask", 10.0, 2.0))
    switch.set_mask(FilterMask(OccupancyGrid(np.array([[10, 11, -1]], dtype=np.int8), 1.0, (0.0, 0.0, 0.0)), "map"))
    assert [state_at(x) for x in (0.5, 1.5, 2.5, 0.5, 1.5, 4.0)] == [
        None,
        not default,
        None,
        default,
        not default,
        default,
    ]
    assert lines == ["camera: the mask is unknown where the robot is; the last state stays"]
