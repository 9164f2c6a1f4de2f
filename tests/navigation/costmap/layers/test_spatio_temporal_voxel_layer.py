"""The spatio-temporal voxel layer: how voxels fade, the views of sensors, and each parameter."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from daidalos.common.parameters import parameters_from
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap, Window
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.spatio_temporal_voxel_layer import (
    SpatioTemporalVoxelLayer,
    SpatioTemporalVoxelLayerParameters,
)
from daidalos.navigation.costmap.observation import CloudData
from daidalos.navigation.costmap.voxel_memory import (
    DEPTH_CAMERA,
    EXPONENTIAL,
    LIDAR,
    LINEAR,
    PERSISTENT,
    View,
    VoxelMemory,
)
from properties import examples

AHEAD = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Axes of an optical frame that looks along x: its z is x, its x is -y, its y is -z."""
POSE = np.array([1.0, 2.0, 0.0])
EYE = np.array([0.0, 0.0, 0.5])


def view(kind=DEPTH_CAMERA, rotation=AHEAD, **more):
    given = {
        "position": EYE, "rotation": rotation, "nearest": 0.2, "farthest": 3.0, "vertical": 0.8, "horizontal": 1.2,
        "padding": 0.0, "acceleration": 6.0,
    }  # fmt: skip
    return View(kind, **(given | more))


class Scene:
    """A costmap of 4 m by 4 m with the layer alone, and a robot at (1, 2) that looks along x."""

    def __init__(self, source=None, **layer):
        values = {"observation_sources": "camera", "voxel_decay": 5.0, "camera": source or {}} | layer
        context = NavigationContext(name="stvl", footprint=Footprint.circle(0.2))
        self.layer = SpatioTemporalVoxelLayer(parameters_from(SpatioTemporalVoxelLayerParameters, values), context)
        self.costmap = LayeredCostmap(
            CostmapParameters(width=4.0, height=4.0, resolution=0.05, track_unknown_space=False), [self.layer]
        )
        self.now = 0.0

    def see(self, *points, rotation=AHEAD, sensor=EYE):
        """Take a cloud of points in the frame of the base."""
        cloud = CloudData(np.reshape(points, (-1, 3)).astype(float), sensor, rotation)
        self.layer.add_cloud("camera", cloud, POSE, self.now)

    def after(self, seconds):
        self.now += seconds
        self.costmap.update(POSE, self.now)
        return self

    def cost(self, x, y):
        """Return the cost at a place in the frame of the base."""
        return int(self.costmap.costmap.cost_at(POSE[0] + x, POSE[1] + y))


@examples(50)
@given(
    points=st.lists(st.tuples(*[st.floats(-4.0, 4.0)] * 3), min_size=1, max_size=30),
    yaw=st.floats(-3.0, 3.0),
)
def test_views_are_those_of_angles(points, yaw):
    points = np.array(points)
    turned = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1.0]])
    local = (points - EYE) @ turned
    ahead, side, up = local.T
    with np.errstate(divide="ignore", invalid="ignore"):
        camera = (ahead >= 0.2) & (ahead <= 3.0)
        camera &= (np.abs(np.arctan2(side, ahead)) <= 0.6) & (np.abs(np.arctan2(up, ahead)) <= 0.4)
    away = np.hypot(ahead, side)
    lidar = (away >= 0.2) & (away <= 3.0) & (np.abs(np.arctan2(side, ahead)) <= 0.6)
    lidar &= np.abs(up) <= np.tan(0.4) * away + 0.1
    near = (np.abs(np.abs(np.arctan2(side, ahead)) - 0.6) < 1e-6) | (np.abs(np.abs(np.arctan2(up, ahead)) - 0.4) < 1e-6)
    sure = ~near & (np.abs(away - 0.2) > 1e-6) & (np.abs(ahead - 0.2) > 1e-6) & (np.abs(ahead - 3.0) > 1e-6)
    sure &= (np.abs(away - 3.0) > 1e-6) & (np.abs(np.abs(up) - np.tan(0.4) * away - 0.1) > 1e-6)
    assert (view(rotation=turned @ AHEAD).contains(points) == camera)[sure].all()
    assert (view(LIDAR, turned, padding=0.1).contains(points) == lidar)[sure].all()


@examples(50)
@given(points=st.lists(st.tuples(*[st.floats(-50.0, 50.0)] * 3), min_size=1, max_size=40), size=st.floats(0.02, 0.5))
def test_voxels_hold_their_points_and_the_latest_time(points, size):
    memory = VoxelMemory(size)
    half = len(points) // 2
    memory.mark(np.array(points[half:]), 2.0)
    memory.mark(np.reshape(points[:half], (-1, 3)), 1.0)
    expected = {}
    for place, time in [*((one, 2.0) for one in points[half:]), *((one, 1.0) for one in points[:half])]:
        key = tuple(np.floor(np.array(place) / size).astype(int))
        expected[key] = max(time, expected.get(key, 0.0))
    found = {tuple(np.floor(c / size + 1e-6).astype(int)): t for c, t in zip(memory.centres, memory.times, strict=True)}
    assert found == expected


@pytest.mark.parametrize(
    ("model", "duration", "views", "gone"),
    [
        (LINEAR, 5.0, False, 5.0),
        (LINEAR, 5.0, True, brentq(lambda t: 5.0 - t - t**3, 0.0, 5.0)),
        (LINEAR, -1.0, True, math.inf),
        (EXPONENTIAL, 5.0, False, math.inf),
        (EXPONENTIAL, 5.0, True, brentq(lambda t: 5.0 * math.exp(-t) - t**3, 0.0, 5.0)),
        (PERSISTENT, 5.0, False, math.inf),
        (PERSISTENT, 5.0, True, 5.0 ** (1 / 3)),
    ],
)
def test_voxels_fade_by_the_model_and_sooner_in_a_view(model, duration, views, gone):
    for age in (0.0, 0.9 * min(gone, 50.0), 0.999 * min(gone, 50.0), 1.01 * gone):
        if math.isinf(age):
            continue
        memory = VoxelMemory(0.1)
        memory.mark(np.array([[1.0, 0.0, 0.5], [-2.0, 0.0, 0.5]]), 0.0)
        memory.fade(age, model, duration, [view()] if views else [])
        assert (memory.times.size and memory.centres[:, 0].max() > 0.0) == (age <= gone)
        if views:
            assert memory.centres[:, 0].min() < 0.0  # behind the sensor


def test_points_become_obstacles_and_fade():
    scene = Scene()
    scene.see((1.0, 0.0, 0.5))
    assert scene.after(0.1).cost(1.0, 0.0) == 254
    scene.see((1.5, 0.5, 0.5))
    assert scene.after(4.8).cost(1.0, 0.0) == 254
    scene.see((1.5, 0.5, 0.5))
    assert scene.after(0.2).cost(1.0, 0.0) == 0
    assert scene.cost(1.5, 0.5) == 254


def test_what_a_clearing_sensor_no_longer_sees_goes_sooner():
    source = {"clearing": True, "decay_acceleration": 60.0}
    for sight, expected in ((2.0, 0), (0.6, 254)):
        scene = Scene(source | {"max_z": sight})
        scene.see((1.0, 0.0, 0.5))
        scene.after(0.1)
        for _ in range(10):
            scene.see((1.5, 0.3, 0.5))
            scene.after(0.1)
        assert scene.cost(1.0, 0.0) == expected
    for other in ({"clearing": False}, {"horizontal_fov_angle": 0.0}, {"min_z": 1.5}, {"decay_acceleration": 0.0}):
        scene = Scene(source | other)
        scene.see((1.0, 0.02, 0.5))
        scene.after(0.1)
        for _ in range(10):
            scene.see((1.5, 0.3, 0.5))
            scene.after(0.1)
        assert scene.cost(1.0, 0.0) == 254, other


@pytest.mark.parametrize(
    ("source", "point", "expected"),
    [
        ({}, (1.0, 0.0, 0.5), 254),
        ({"obstacle_range": 0.9}, (1.0, 0.0, 0.5), 0),
        ({"min_obstacle_height": 0.6}, (1.0, 0.0, 0.5), 0),
        ({"max_obstacle_height": 0.4}, (1.0, 0.0, 0.5), 0),
        ({"max_obstacle_height": 0.4, "filter": "none"}, (1.0, 0.0, 0.5), 254),
        ({"filter": "voxel", "voxel_min_points": 2}, (1.0, 0.0, 0.5), 0),
        ({"marking": False}, (1.0, 0.0, 0.5), 0),
        ({"enabled": False}, (1.0, 0.0, 0.5), 0),
        ({}, (0.1, 0.0, 0.5), 0),
        ({}, (np.nan, 0.0, 0.5), 0),
    ],
)
def test_which_points_are_marked(source, point, expected):
    scene = Scene(source)
    scene.see(point)
    scene.after(0.1)
    assert scene.cost(*(point[:2] if np.isfinite(point[0]) else (1.0, 0.0))) == expected


def test_the_voxel_filter_keeps_full_voxels():
    scene = Scene({"filter": "voxel", "voxel_min_points": 2})
    scene.see((1.01, 0.01, 0.51), (1.02, 0.02, 0.52))
    assert scene.after(0.1).cost(1.01, 0.01) == 254


def test_parameters_of_the_layer():
    tower = [(1.06, 0.06, 0.15 + 0.1 * k) for k in range(3)]
    for threshold, expected in ((0, 254), (2, 254), (3, 0)):
        scene = Scene(mark_threshold=threshold, voxel_size=0.1)
        scene.see(*tower)
        scene.after(0.1)
        near = np.array([[scene.cost(1.025 + 0.05 * i, 0.025 + 0.05 * k) for k in range(-1, 3)] for i in range(-1, 3)])
        assert (near[1:3, 1:3] == expected).all()
        assert near.sum() == 4 * expected
    for unknown, expected in ((True, 255), (False, 0)):
        scene = Scene(track_unknown_space=unknown)
        scene.costmap = LayeredCostmap(CostmapParameters(4.0, 4.0, 0.05, track_unknown_space=True), [scene.layer])
        assert scene.after(0.1).cost(0.18, 0.18) == expected
    for method, expected in ((1, 100), (0, 0)):
        scene = Scene(combination_method=method)
        below = Costmap.filled(80, 80, 0.05, (0.0, 0.0), 100)
        scene.layer.update_costs(below, below.window)
        assert below.cost_at(2.0, 2.0) == expected
    scene = Scene(update_footprint_enabled=False)
    scene.see((0.1, 0.0, 0.5))
    assert scene.after(0.1).cost(0.1, 0.0) == 254
    assert Scene().layer.outputs[0].give() is None
    scene = Scene(publish_voxel_map=True)
    scene.see((1.0, 0.0, 0.5))
    scene.after(0.1)
    output = scene.layer.outputs[0]
    assert output.topic == "stvl/voxel_grid"
    assert output.give().points == pytest.approx(np.array([[2.0, 2.0, 0.5]]), abs=0.05)


def test_observations_persist_as_their_parameters_say():
    for source, cleared in (({}, 254), ({"clear_after_reading": True}, 0)):
        scene = Scene({**source, "observation_persistence": 2.0}, voxel_decay=1.5)
        scene.see((1.0, 0.0, 0.5))
        scene.after(0.1)
        scene.layer.memory.keep(np.zeros(scene.layer.memory.times.size, bool))
        assert scene.after(0.1).cost(1.0, 0.0) == cleared


def test_scans_are_marked_and_miss_nothing_where_inf_is_valid():
    empty = LaserScanData(np.full(5, np.inf), -0.2, 0.1, 0.1, 5.0)
    for valid in (False, True):
        scene = Scene({"data_type": "LaserScan", "inf_is_valid": valid})
        scan = replace(empty, ranges=np.array([np.inf, np.inf, 1.0, np.inf, np.inf]))
        scene.layer.add_scan("camera", scan, POSE, 0.0)
        assert scene.after(0.1).cost(1.0, 0.0) == 254
        scene.layer.add_scan("camera", empty, POSE, 0.4)
        assert (scene.layer.missing_input(0.7) == "") == valid


def test_a_sensor_that_stops_is_missed():
    scene = Scene()
    assert scene.layer.missing_input(0.0) == "there is no observation of 'camera'"
    scene.see((1.0, 0.0, 0.5))
    assert scene.layer.missing_input(0.4) == ""
    assert scene.layer.age_of_input(0.25) == pytest.approx(0.5)
    assert "longer than expected_update_rate 0.5 s" in scene.layer.missing_input(0.6)
    assert Scene({"expected_update_rate": 0.0}).layer.missing_input(9.0) == ""
    assert Scene({"enabled": False}).layer.missing_input(9.0) == ""


@pytest.mark.parametrize("inside", [True, False])
def test_voxels_are_cleared_on_demand(inside):
    scene = Scene()
    scene.see((1.0, 0.0, 0.5), (0.5, 1.0, 0.5))
    scene.after(0.1)
    scene.layer.clear(Window(30, 30, 45, 45), inside=inside)  # around (1.0, 0.0) is cell (40, 40)
    scene.costmap.update(POSE, 0.2)
    scene.after(0.1)
    assert (scene.cost(1.0, 0.0), scene.cost(0.5, 1.0)) == ((0, 254) if inside else (254, 0))
