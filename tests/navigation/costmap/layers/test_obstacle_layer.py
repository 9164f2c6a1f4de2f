"""Marking and clearing: what rays leave behind."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, box

from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Bounds, Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.obstacle_layer import (
    ObservationSource,
    ObstacleLayer,
    ObstacleLayerParameters,
    clear_rays,
)
from daidalos.navigation.costmap.observation import Observation
from properties import examples

ROBOT = Footprint.circle(0.1)
HERE = np.array([1.0, 1.0, 0.0])


def layer_of(**source):
    parameters = ObstacleLayerParameters(
        sources={"scan": ObservationSource(**source)}, footprint_clearing_enabled=False
    )
    return ObstacleLayer(parameters, NavigationContext(footprint=ROBOT))


def see(layer, costmap, ends, hits=True, stamp=0.0, now=None):
    """Feed a layer with rays from (1, 1), and return the costmap that it makes of free ground."""
    ends = np.atleast_2d(np.array(ends, dtype=float))
    hits = np.broadcast_to(hits, ends.shape[:1]).copy()
    layer.add_observation(Observation(HERE[:2], ends, hits, stamp))
    return refresh(layer, costmap, stamp if now is None else now)


def refresh(layer, costmap, now):
    layer.match_size(costmap)
    layer.update_bounds(HERE, now, Bounds())
    fresh = costmap.copy()
    layer.update_costs(fresh, fresh.window)
    return fresh


@pytest.fixture
def ground():
    return Costmap.filled(40, 40, 0.1, (0.0, 0.0), 255)


def test_a_ray_frees_its_way_and_marks_its_end(ground):
    costmap = see(layer_of(), ground, [2.05, 1.0])
    assert costmap.cost_at(2.05, 1.05) == 254
    assert all(costmap.cost_at(x, 1.05) == 0 for x in np.arange(1.05, 2.0, 0.1))
    assert costmap.cost_at(2.25, 1.05) == 255


def test_an_obstacle_that_went_away_is_cleared_by_the_ray_that_passes(ground):
    layer = layer_of()
    see(layer, ground, [2.05, 1.05])
    costmap = see(layer, ground, [3.05, 1.05], stamp=1.0)
    assert costmap.cost_at(2.05, 1.05) == 0
    assert costmap.cost_at(3.05, 1.05) == 254


def test_an_obstacle_stays_when_no_ray_passes(ground):
    layer = layer_of()
    see(layer, ground, [2.05, 1.05])
    assert see(layer, ground, [1.05, 2.05], stamp=9.0).cost_at(2.05, 1.05) == 254


def test_a_ray_without_a_hit_clears_and_marks_nothing(ground):
    layer = layer_of()
    see(layer, ground, [2.05, 1.05])
    costmap = see(layer, ground, [11.0, 1.05], hits=False, stamp=1.0)
    assert costmap.cost_at(2.05, 1.05) == 0
    assert not (costmap.costs == 254).any()


def test_far_obstacles_are_not_marked_and_far_cells_not_cleared(ground):
    costmap = see(layer_of(obstacle_max_range=1.0, raytrace_max_range=1.5), ground, [3.05, 1.05])
    assert costmap.cost_at(3.05, 1.05) == 255
    assert costmap.cost_at(2.35, 1.05) == 0
    assert costmap.cost_at(2.75, 1.05) == 255


def test_near_obstacles_are_left_out_below_the_least_range(ground):
    costmap = see(layer_of(obstacle_min_range=0.5), ground, [1.25, 1.05])
    assert not (costmap.costs == 254).any()


def test_a_ray_of_one_scan_does_not_wipe_out_what_another_hit(ground):
    ends = [[2.05, 1.05], [3.05, 1.06]]
    costmap = see(layer_of(), ground, ends)
    assert costmap.cost_at(2.05, 1.05) == 254


def test_of_several_readings_between_two_updates_the_latest_alone_is_used(ground):
    layer = layer_of()
    for stamp, x in enumerate((1.55, 2.05, 2.55)):
        layer.add_observation(Observation(HERE[:2], np.array([[x, 1.05]]), np.array([True]), float(stamp)))
    costmap = refresh(layer, ground, 3.0)
    assert [costmap.cost_at(x, 1.05) for x in (1.55, 2.05, 2.55)] == [0, 0, 254]


def test_readings_persist_as_long_as_told(ground):
    layer = layer_of(observation_persistence=1.0, clearing=False)
    see(layer, ground, [2.05, 1.05], stamp=0.0)
    layer.clear(ground.window, inside=True)
    layer.add_observation(Observation(HERE[:2], np.array([[2.05, 1.05]]), np.array([True]), 5.0))
    refresh(layer, ground, 5.0)
    layer._seen.costs[:] = 255
    assert refresh(layer, ground, 5.9).cost_at(2.05, 1.05) == 254
    layer._seen.costs[:] = 255
    assert refresh(layer, ground, 6.1).cost_at(2.05, 1.05) == 254
    layer._seen.costs[:] = 255
    assert refresh(layer, ground, 6.2).cost_at(2.05, 1.05) == 255


def test_the_cells_under_the_robot_are_free():
    ground = Costmap.filled(40, 40, 0.05, (0.0, 0.0), 254)
    layer = ObstacleLayer(None, NavigationContext(footprint=Footprint.circle(0.3)))
    costmap = refresh(layer, ground, 0.0)
    assert costmap.cost_at(1.0, 1.0) == costmap.cost_at(1.2, 1.0) == 0
    assert costmap.cost_at(1.4, 1.0) == 254


def test_what_was_seen_moves_with_a_rolling_window():
    ground = Costmap.filled(20, 20, 0.1, (0.0, 0.0), 255)
    layer = layer_of()
    see(layer, ground, [1.55, 1.05])
    ground.cover(20, 20, np.array([0.5, 0.3]), 255)
    assert refresh(layer, ground, 1.0).cost_at(1.55, 1.05) == 254


def test_clearing_inside_and_outside_of_a_window(ground):
    for inside, kept in ((True, (False, True)), (False, (True, False))):
        layer = layer_of(clearing=False)
        see(layer, ground, [[1.55, 1.05], [3.05, 1.05]])
        window = ground.window_of(Bounds(1.0, 0.5, 2.0, 1.5))
        layer.clear(window, inside=inside)
        costmap = refresh(layer, ground, 1.0)
        assert (costmap.cost_at(1.55, 1.05) == 254, costmap.cost_at(3.05, 1.05) == 254) == kept


def test_the_higher_cost_wins_unless_told_to_overwrite(ground):
    ground.costs[:] = 100
    assert see(layer_of(), ground, [2.05, 1.05]).cost_at(1.55, 1.05) == 100
    overwriting = ObstacleLayer(
        ObstacleLayerParameters(combination_method=0, footprint_clearing_enabled=False),
        NavigationContext(footprint=ROBOT),
    )
    assert see(overwriting, ground, [2.05, 1.05]).cost_at(1.55, 1.05) == 0


def test_an_unknown_source_is_an_error():
    with pytest.raises(KeyError):
        layer_of().add_observation(Observation(HERE[:2], np.zeros((0, 2)), np.zeros(0, bool), 0.0), "sonar")


def test_rays_of_a_scan():
    ranges = np.array([1.0, math.inf, math.nan, 0.05, 30.0, -math.inf, 0.0])
    scan = LaserScanData(ranges, 0.0, math.pi / 2, 0.1, 20.0, 0.0, (0.5, 0.0, 0.0))
    seen = Observation.from_scan(scan, np.array([1.0, 2.0, math.pi / 2]), 3.0)
    assert np.allclose(seen.origin, [1.0, 2.5])
    assert seen.hits.tolist() == [True, False]
    assert np.allclose(seen.ends, [[1.0, 3.5], [-19.0, 2.5]])
    assert Observation.from_scan(scan, np.zeros(3), 3.0, inf_is_valid=False).ends.shape == (1, 2)


def off_borders(low, high):
    """Coordinates [m] in steps of a millimetre that are never on the border of a cell."""
    return st.integers(low, high).map(lambda millimetres: millimetres / 1000.0 + 0.00037)


def cells_by_sampling(start, end, hit, min_range, max_range, resolution=0.1):
    """Cells that a ray crosses, by points very near to each other."""
    away = math.hypot(end[0] - start[0], end[1] - start[1])
    cells = set()
    for d in np.arange(min_range, min(away, max_range), resolution / 300.0):
        x, y = (start[i] + (end[i] - start[i]) * d / away for i in range(2))
        cells.add((math.floor(x / resolution), math.floor(y / resolution)))
    if hit:
        cells.discard((math.floor(end[0] / resolution), math.floor(end[1] / resolution)))
    return {(c, r) for c, r in cells if 0 <= c < 20 and 0 <= r < 20}


@examples(150)
@given(
    start=st.tuples(off_borders(100, 1900), off_borders(100, 1900)),
    end=st.tuples(off_borders(-1000, 3000), off_borders(-1000, 3000)),
    hit=st.booleans(),
    ranges=st.sampled_from([(0.0, 10.0), (0.0, 0.7), (0.3, 1.2)]),
)
def test_every_cell_on_the_way_is_freed_and_no_other(start, end, hit, ranges):
    if math.hypot(end[0] - start[0], end[1] - start[1]) < 0.01:
        return
    costs = np.full((20, 20), 9, dtype=np.uint8)
    clear_rays(costs, 0.1, np.zeros(2), np.array(start), np.array([end]), np.array([hit]), ranges[0], ranges[1])
    freed = {(int(c), int(r)) for r, c in np.argwhere(costs == 0)}
    sampled = cells_by_sampling(start, end, hit, *ranges)
    assert sampled <= freed
    # What sampling misses are cells that the ray only grazes.
    ray = LineString([start, end])
    assert all(ray.distance(box(0.1 * c, 0.1 * r, 0.1 * c + 0.1, 0.1 * r + 0.1)) < 1e-9 for c, r in freed - sampled)
