"""The point of a path at the look-ahead distance."""

import numpy as np
import pytest

from daidalos.navigation.controllers.look_ahead import look_ahead_point


@pytest.mark.parametrize(
    ("points", "distance", "point", "index"),
    [
        ([(0.0, 0.0), (2.0, 0.0)], 0.5, (0.5, 0.0), 1),
        ([(0.0, 0.3), (1.0, 0.3), (2.0, 0.3)], 0.5, (0.4, 0.3), 1),
        ([(0.0, 0.0), (0.3, 0.0)], 0.5, (0.3, 0.0), 1),
        ([(1.0, 0.0), (2.0, 0.0)], 0.5, (1.0, 0.0), 0),
        ([(0.2, 0.0)], 0.5, (0.2, 0.0), 0),
    ],
)
def test_the_point_is_where_the_path_leaves_the_circle(points, distance, point, index):
    found, outer = look_ahead_point(np.array(points), distance)
    assert found == pytest.approx(point)
    assert outer == index
