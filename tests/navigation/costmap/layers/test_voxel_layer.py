"""Voxels: what rays in space mark and clear."""

import numpy as np
import pytest

from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Bounds, Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.obstacle_layer import ObservationSource
from daidalos.navigation.costmap.layers.voxel_layer import VoxelLayer, VoxelLayerParameters
from daidalos.navigation.costmap.observation import CloudData, Observation

HERE = np.array([1.05, 1.05, 0.0])
SENSOR_HEIGHT = 0.5


def layer_of(**parameters):
    names = {"sources": {"scan": ObservationSource(raytrace_max_range=5.0, obstacle_max_range=5.0)}}
    given = VoxelLayerParameters(**names, z_resolution=0.2, footprint_clearing_enabled=False, **parameters)
    return VoxelLayer(given, NavigationContext(footprint=Footprint.circle(0.1)))


def see(layer, costmap, *points, hits=True, stamp=0.0):
    """Feed a layer with rays from (1.05, 1.05, 0.5) to points, and return the costmap that it makes."""
    points = np.array(points, dtype=float)
    marks = np.full(points.shape[0], hits)
    layer.add_observation(
        Observation(HERE[:2], points[:, :2], marks, stamp, SENSOR_HEIGHT, np.ascontiguousarray(points[:, 2]))
    )
    layer.match_size(costmap)
    layer.update_bounds(HERE, stamp, Bounds())
    fresh = costmap.copy()
    layer.update_costs(fresh, fresh.window)
    return fresh


@pytest.fixture
def ground():
    return Costmap.filled(40, 40, 0.1, (0.0, 0.0), 255)


def test_a_ray_frees_its_way_and_marks_its_end(ground):
    costmap = see(layer_of(), ground, (2.05, 1.05, 0.5))
    assert costmap.cost_at(2.05, 1.05) == 254
    assert all(costmap.cost_at(x, 1.05) == 0 for x in np.arange(1.05, 2.0, 0.1))


def test_a_ray_that_passes_above_an_obstacle_leaves_it(ground):
    layer = layer_of()
    see(layer, ground, (2.05, 1.05, 0.1))
    costmap = see(layer, ground, (3.05, 1.05, 0.5), stamp=1.0)
    assert costmap.cost_at(2.05, 1.05) == 254
    costmap = see(layer, ground, (3.05, 1.05, -0.3), stamp=2.0)  # through (2.05, 1.05, 0.1)
    assert costmap.cost_at(2.05, 1.05) == 0


def test_a_cell_is_an_obstacle_with_more_voxels_than_mark_threshold(ground):
    layer = layer_of(mark_threshold=1)
    assert see(layer, ground, (2.05, 1.05, 0.5)).cost_at(2.05, 1.05) != 254
    assert see(layer, ground, (2.05, 1.05, 0.9), stamp=1.0).cost_at(2.05, 1.05) == 254


def test_a_cell_is_free_with_at_most_unknown_threshold_unknown_voxels(ground):
    passing = (3.05, 1.05, 0.5)
    assert see(layer_of(unknown_threshold=15), ground, passing).cost_at(2.05, 1.05) == 0
    assert see(layer_of(unknown_threshold=3, z_voxels=5), ground, passing).cost_at(2.05, 1.05) == 255


@pytest.mark.parametrize("height", [-0.1, 2.1])
def test_points_outside_of_the_heights_are_no_obstacles_and_are_named(ground, height):
    lines = []
    layer = layer_of()
    layer.context = NavigationContext(name="voxels", warn=lines.append)
    assert see(layer, ground, (2.05, 1.05, height)).cost_at(2.05, 1.05) != 254
    assert see(layer, ground, (2.05, 1.05, height), stamp=1.0).cost_at(2.05, 1.05) != 254
    assert len(lines) == 1
    assert "min_obstacle_height" in lines[0]


def test_points_below_the_lowest_voxel_are_in_it(ground):
    assert see(layer_of(origin_z=0.4), ground, (2.05, 1.05, 0.1)).cost_at(2.05, 1.05) == 254


def test_voxels_move_with_a_rolling_window_and_are_cleared(ground):
    layer = layer_of(publish_voxel_map=True)
    see(layer, ground, (2.05, 1.05, 0.5))
    assert layer.voxels.marked[10, 20] == 1 << 2
    layer.match_size(Costmap.filled(40, 40, 0.1, (0.5, -0.2), 255))
    voxels = layer.voxels
    assert voxels.marked[12, 15] == 1 << 2
    assert np.count_nonzero(voxels.marked) == 1
    assert voxels.unknown[0, 39] == (1 << 10) - 1
    layer.clear(Costmap.filled(40, 40, 0.1, (0.5, -0.2), 255).window, inside=True)
    assert not layer.voxels.marked.any()


def test_a_cloud_is_seen_where_it_is():
    cloud = CloudData(np.array([[1.0, 0.0, 0.3], [np.nan, 0.0, 0.0]]), np.array([0.2, 0.0, 0.4])).lifted(0.1)
    seen = Observation.from_cloud(cloud, np.array([1.0, 2.0, np.pi / 2]), 3.0)
    assert seen.ends == pytest.approx(np.array([[1.0, 3.0]]))
    assert seen.origin == pytest.approx([1.0, 2.2])
    assert (seen.origin_height, *seen.end_heights) == pytest.approx((0.5, 0.4))


@pytest.mark.parametrize(
    ("tilt", "end", "height"),
    [
        ((0.0, 0.0), (0.0, 1.0), 0.2),
        ((np.pi, 0.0), (0.0, -1.0), 0.2),
        ((0.5, 0.0), (0.0, np.cos(0.5)), 0.2 + np.sin(0.5)),
    ],
)
def test_a_scan_of_a_tilted_or_inverted_lidar_is_seen_where_it_is(tilt, end, height):
    scan = LaserScanData(np.array([1.0]), np.pi / 2, 0.1, 0.1, 10.0, sensor_tilt=tilt, sensor_height=0.2)
    seen = Observation.from_scan(scan, np.zeros(3), 0.0)
    assert seen.ends[0] == pytest.approx(end, abs=1e-9)
    assert seen.end_heights[0] == pytest.approx(height)
