"""Costmaps and footprints as messages."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message, costmap_of, footprint_message

STAMP = Time(sec=3, nanosec=4)


def test_a_costmap_comes_back_as_it_was():
    costs = np.arange(6, dtype=np.uint8).reshape(2, 3) * 50
    message = costmap_message(Costmap(costs, 0.05, (-1.0, 2.5)), "map", STAMP)
    assert (message.header.frame_id, message.header.stamp) == ("map", STAMP)
    assert (message.metadata.size_x, message.metadata.size_y) == (3, 2)
    back = costmap_of(message)
    np.testing.assert_array_equal(back.costs, costs)
    assert back.resolution == pytest.approx(0.05)
    assert back.origin == pytest.approx((-1.0, 2.5))


def test_a_footprint_stands_where_the_robot_does():
    """A rectangle turned by a quarter: what was ahead is left."""
    footprint = Footprint.from_parameters("[[0.3, 0.1], [-0.3, 0.1], [-0.3, -0.1], [0.3, -0.1]]", 0.0, 0.0)
    message = footprint_message(footprint, np.array([1.0, 2.0, math.pi / 2]), "odom", STAMP)
    assert message.header.frame_id == "odom"
    points = [(point.x, point.y) for point in message.polygon.points]
    assert np.array(points) == pytest.approx(np.array([(0.9, 2.3), (0.9, 1.7), (1.1, 1.7), (1.1, 2.3)]))
