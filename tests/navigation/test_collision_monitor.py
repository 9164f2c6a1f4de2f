"""Zones of the collision monitor: shapes and actions."""

import math

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError, parameters_from
from daidalos.common.pose2 import inverse, move_along_arc, transform_points
from daidalos.navigation.collision_monitor import Zone, ZoneParameters

SQUARE = "[[0.5, 0.5], [0.5, -0.5], [-0.5, -0.5], [-0.5, 0.5]]"
AHEAD = np.array([[0.4, 0.01 * k] for k in range(6)])
FAR = AHEAD + np.array([1.0, 0.0])
FORWARD = np.array([0.5, 0.0, 0.0])


def zone(**values) -> Zone:
    return Zone(parameters_from(ZoneParameters, {"points": SQUARE} | values))


@pytest.mark.parametrize(
    ("values", "ratio"),
    [
        ({"action_type": "stop"}, 0.0),
        ({"action_type": "slowdown", "slowdown_ratio": 0.3}, 0.3),
        ({"action_type": "limit", "linear_limit": 0.1}, 0.2),
        ({"action_type": "limit", "linear_limit": 1.0}, 1.0),
        ({"action_type": "none"}, 1.0),
        ({"type": "circle", "points": "", "radius": 0.5}, 0.0),
        ({"type": "circle", "points": "", "radius": 0.3}, 1.0),
        ({"min_points": 7}, 1.0),
        ({"min_points": 6}, 0.0),
        ({"max_points": 6}, 1.0),
        ({"max_points": 5}, 0.0),
    ],
)
def test_obstacles_inside_act_and_others_do_not(values, ratio):
    assert zone(**values).judge(FORWARD, AHEAD).ratio == pytest.approx(ratio)
    assert zone(**values).judge(FORWARD, FAR).ratio == 1.0
    assert zone(**values).judge(FORWARD, np.zeros((0, 2))).ratio == 1.0


def test_approach_keeps_the_time_to_a_collision():
    approach = zone(action_type="approach", time_before_collision=2.0, simulation_time_step=0.05)
    wall = FAR - np.array([0.1, 0.0])  # 1.3 m ahead, 0.8 m from the outline
    assert approach.judge(FORWARD, wall).ratio == pytest.approx(0.8, abs=0.05)
    assert approach.judge(-FORWARD, wall).ratio == 1.0
    assert approach.judge(FORWARD, AHEAD).ratio == 0.0
    assert approach.judge(np.array([0.0, 0.5, 0.0]), wall + np.array([0.0, 1.2])).ratio == 1.0
    assert approach.judge(np.array([0.5, 0.0, 1.5]), np.tile([[0.3, 0.6]], (4, 1))).ratio < 0.5


@pytest.mark.parametrize("shape", [{}, {"type": "circle", "points": "", "radius": 0.6}])
def test_the_time_to_a_collision_is_that_of_all_points(shape):
    random = np.random.default_rng(0)
    approach = zone(action_type="approach", time_before_collision=2.0, simulation_time_step=0.1, **shape)
    ratios = set()
    for _ in range(200):
        velocity = random.uniform(-1.0, 1.0, 3)
        points = random.uniform(-2.5, 2.5, 2) + random.normal(0.0, 0.1, (8, 2))
        times = (0.1 * k for k in range(20))
        poses = ((time, move_along_arc(np.zeros(3), *(velocity * time)[[0, 2, 1]])) for time in times)
        first = next((t for t, pose in poses if approach.holds_obstacle(transform_points(inverse(pose), points))), 2.0)
        ratio = approach.judge(velocity, points).ratio
        assert ratio == pytest.approx(first / 2.0)
        ratios.add(round(ratio, 3))
    assert len(ratios) > 5


def test_a_velocity_chooses_the_shape():
    shapes = {
        "slow": {"points": SQUARE, "linear_max": 0.3, "theta_min": -1.0, "theta_max": 1.0},
        "fast": {
            "points": "[[2.0, 0.5], [2.0, -0.5], [-0.5, -0.5], [-0.5, 0.5]]",
            "linear_min": 0.3, "linear_max": 1.0, "theta_min": -1.0, "theta_max": 1.0,
        },
    }  # fmt: skip
    chosen = zone(type="velocity_polygon", points="", velocity_polygons=list(shapes), **shapes)
    assert "shape is not known" in chosen.judge(np.array([5.0, 0.0, 0.0]), FAR).reason
    assert chosen.judge(np.array([0.2, 0.0, 0.0]), FAR).ratio == 1.0
    assert chosen.judge(np.array([0.8, 0.0, 0.0]), FAR).ratio == 0.0
    assert chosen.judge(np.array([5.0, 0.0, 0.0]), FAR).ratio == 0.0


def test_a_holonomic_robot_chooses_by_its_direction():
    left = {
        "points": "[[0.5, 2.0], [-0.5, 2.0], [-0.5, 0.0], [0.5, 0.0]]", "linear_max": 1.0, "theta_max": 0.1,
        "direction_start_angle": 0.5, "direction_end_angle": 2.5,
    }  # fmt: skip
    ahead = {"points": SQUARE, "linear_max": 1.0, "theta_max": 0.1}
    chosen = zone(
        type="velocity_polygon", points="", holonomic=True, velocity_polygons=["left", "ahead"], left=left, ahead=ahead
    )
    beside = np.array([[0.0, 1.5]] * 4)
    assert chosen.judge(FORWARD, beside).ratio == 1.0
    assert chosen.judge(np.array([0.0, 0.5, 0.0]), beside).ratio == 0.0


def test_a_zone_without_a_shape_stops():
    unknown = zone(action_type="approach", points="")
    assert unknown.parameters.topic == "local_costmap/published_footprint"
    verdict = unknown.judge(FORWARD, FAR)
    assert (verdict.ratio, verdict.reason) == (0.0, "its shape is not known")


@pytest.mark.parametrize("points", ["[[1, 2]]", "1, 2", "[[1, 2, 3], [1, 2, 3], [1, 2, 3]]", "[[1, 2], [3", "[[1,1],"])
def test_corners_that_are_none_are_refused(points):
    with pytest.raises(ParameterError, match="three or more pairs"):
        zone(points=points)
    with pytest.raises(ParameterError, match="no topic"):
        zone(points="")


def test_a_circle_has_an_outline():
    outline = zone(type="circle", points="", radius=0.7).outline
    assert all(math.hypot(x, y) == pytest.approx(0.7) for x, y in outline)
