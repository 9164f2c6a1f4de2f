import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from daidalos.navigation.controllers.teb.alternatives import (
    distinct_paths,
    is_free,
    obstacles_beside,
    signature_of,
)

ORIGIN, RESOLUTION = np.array([-1.0, -2.0]), 0.05
START, GOAL = np.array([0.0, 0.0]), np.array([4.0, 0.0])


def field_of(*boxes):
    """Distance to boxes (x, y, width, height) [m] on a ground of 6 m by 4 m."""
    lethal = np.zeros((80, 120), dtype=bool)
    for x, y, width, height in boxes:
        left, bottom = np.round((np.array([x, y]) - ORIGIN) / RESOLUTION).astype(int)
        lethal[bottom : bottom + round(height / RESOLUTION), left : left + round(width / RESOLUTION)] = True
    if not lethal.any():
        return np.full(lethal.shape, 1e3, dtype=np.float32)
    return (distance_transform_edt(~lethal) * RESOLUTION).astype(np.float32)


def ways(field, most=4, known=(), threshold=0.45):
    obstacles = obstacles_beside(field, ORIGIN, RESOLUTION, START, GOAL, width=5.0, away=0.2)
    found = distinct_paths(
        field, ORIGIN, RESOLUTION, START, GOAL, obstacles, threshold=threshold, known=set(known), most=most
    )
    return found, obstacles


def test_one_obstacle_is_passed_on_both_sides():
    field = field_of((1.8, -0.3, 0.4, 0.6))
    found, obstacles = ways(field)
    assert len(obstacles.centers) == 1
    middles = sorted(float(path[len(path) // 2, 1]) for path in found)
    assert len(middles) == 2
    assert middles[0] < -0.35
    assert middles[1] > 0.35
    assert all(is_free(path, field, ORIGIN, RESOLUTION) for path in found)
    assert len({signature_of(path, obstacles) for path in found}) == 2


def test_two_obstacles_are_passed_on_four_sides():
    found, obstacles = ways(field_of((1.0, -0.3, 0.2, 0.6), (2.6, -0.3, 0.2, 0.6)))
    assert len(obstacles.centers) == 2
    assert len({signature_of(path, obstacles) for path in found}) == 4


def test_known_classes_are_left_out():
    field = field_of((1.8, -0.3, 0.4, 0.6))
    found, obstacles = ways(field)
    known = signature_of(found[0], obstacles)
    (other,), _ = ways(field, known=[known])
    assert signature_of(other, obstacles) != known


def test_what_the_robot_cannot_pass_between_is_one_obstacle():
    _, obstacles = ways(field_of((1.8, -0.3, 0.2, 0.2), (1.8, 0.2, 0.2, 0.2)))
    assert len(obstacles.centers) == 1


def test_free_ground_has_one_way():
    (path,), obstacles = ways(field_of())
    assert len(obstacles.centers) == 0
    assert path[-1] == pytest.approx(GOAL)
    assert signature_of(path, obstacles) == ()


def test_lines_through_obstacles_are_not_free():
    field = field_of((1.8, -0.3, 0.05, 0.6))
    assert not is_free(np.array([START, GOAL]), field, ORIGIN, RESOLUTION)
    assert is_free(np.array([START, [1.5, 1.0], GOAL + 0.01]), field, ORIGIN, RESOLUTION)
