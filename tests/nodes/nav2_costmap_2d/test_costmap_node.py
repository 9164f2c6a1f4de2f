"""The costmaps of the servers: layers, topics and services, with the test as robot, sensor and map server."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PolygonStamped, TransformStamped
from nav2_msgs.msg import Costmap
from nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCostmap,
    GetCosts,
)
from nav_msgs.msg import OccupancyGrid
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan, PointCloud2, Range
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32, read_points_numpy
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from daidalos.nodes.conversions import grid_array, grid_message, pose_stamped, transform_stamped
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.nav2_planner.planner_server import PlannerServer
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

NODE = "/global_costmap/global_costmap"
FREE, INSCRIBED, LETHAL, UNKNOWN = 0, 253, 254, 255
ROLLING: dict[str, Any] = {
    "global_frame": "odom",
    "rolling_window": True,
    "width": 4.0,
    "height": 3.0,
    "resolution": 0.05,
    "update_frequency": 20.0,
    "publish_frequency": 20.0,
    "robot_radius": 0.2,
    "plugins": ["obstacle_layer", "inflation_layer"],
    "obstacle_layer": {"observation_sources": "front", "front": {"topic": "/scan", "raytrace_max_range": 5.0}},
    "inflation_layer": {"inflation_radius": 0.5},
}
STATIC: dict[str, Any] = {
    "update_frequency": 20.0,
    "publish_frequency": 20.0,
    "track_unknown_space": True,
    "plugins": ["static_layer"],
}


SEE_NEAR, NEAR = {10: 0.62}, (-0.31, -0.11)
SEE_FAR, FAR = {350: 1.52}, (-1.19, 0.26)
"""Ranges by the laser's degrees, and the places (x, y) that they are of when the robot stands at the origin."""


class Bench:
    """A planner server whose costmap is looked at."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.robot = stage.add_robot()
        self.server = stage.add(PlannerServer())
        self.costmaps = stage.collect(Costmap, "/global_costmap/costmap_raw", LATCHED)
        self._scans = stage.node.create_publisher(LaserScan, "/scan", 10)
        stage.publish(
            "/tf_static",
            TFMessage(transforms=[transform_stamped((0.3, 0.0, math.pi), "base_link", "laser", time_message(0))]),
            LATCHED,
        )

    def start(self) -> Bench:
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.stage.step()
        return self

    def step_until(self, condition: Callable[[Any], bool]) -> Any:
        """Return the first costmap that fulfils a condition."""
        self.stage.step_until(lambda: bool(self.costmaps) and condition(costmap_of(self.costmaps[-1])))
        return costmap_of(self.costmaps[-1])

    def see(self, ranges: dict[int, float]) -> None:
        """Publish a scan all around in degrees of the laser, which looks backwards from 0.3 m before the base."""
        scan = LaserScan(angle_min=0.0, angle_max=math.radians(359), angle_increment=math.radians(1), range_max=10.0)
        scan.ranges = array("f", [ranges.get(degree, math.inf) for degree in range(360)])
        scan.header.frame_id, scan.header.stamp = "laser", self.stage.stamp
        self._scans.publish(scan)


def cost(costmap: Any, x: float, y: float) -> int:
    column, row = costmap.world_to_map(x, y)
    return int(costmap.costs[row, column])


def room() -> Any:
    """Return a map of 2 m by 1 m from (-1, -0.5) whose left half is free, with one wall, and whose right is unknown."""
    cells = np.full((20, 40), -1, np.int8)
    cells[:, :20] = 0
    cells[:, 0] = 100
    return grid_message(cells, 0.05, (-1.0, -0.5), "map", time_message(0))


def test_the_costmap_takes_the_map_over(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: STATIC})).start()
    grids = bench.stage.collect(OccupancyGrid, "/global_costmap/costmap", LATCHED)
    bench.stage.publish("/map", room(), LATCHED)
    costmap = bench.step_until(lambda costmap: costmap.width == 40)
    assert tuple(costmap.origin) == pytest.approx((-1.0, -0.5))
    assert [cost(costmap, x, 0.0) for x in (-0.98, -0.5, 0.5)] == [LETHAL, FREE, UNKNOWN]
    assert bench.costmaps[-1].header.frame_id == "map"
    bench.stage.step_until(lambda: bool(grids) and grids[-1].info.width == 40)
    assert np.array_equal(grid_array(grids[-1]), grid_array(room()))
    assert grids[-1].header.frame_id == "map"


def test_the_map_topic_is_a_parameter(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: {**STATIC, "map_topic": "/floor"}})).start()
    bench.stage.publish("/floor", room(), LATCHED)
    bench.step_until(lambda costmap: costmap.width == 40)


def test_an_obstacle_is_marked_where_the_sensor_sees_it_and_cleared_when_it_is_gone(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    bench = Bench(stage({NODE: ROLLING})).start()
    bench.robot.pose = np.array([1.0, 0.02, math.pi / 2])
    bench.stage.step()
    # The laser is at (1, 0.32) and looks along -y; 90 degrees to its left is +x.
    bench.see({90: 1.02})
    costmap = bench.step_until(lambda costmap: (costmap.costs == LETHAL).any())
    assert cost(costmap, 2.02, 0.32) == LETHAL
    assert cost(costmap, 1.86, 0.32) == INSCRIBED
    assert 0 < cost(costmap, 1.6, 0.32) < INSCRIBED
    assert cost(costmap, 1.0, -1.0) == FREE
    bench.see({90: 1.52})
    costmap = bench.step_until(lambda costmap: cost(costmap, 2.02, 0.32) != LETHAL)
    assert cost(costmap, 2.52, 0.32) == LETHAL


def test_the_window_follows_the_robot(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: ROLLING})).start()
    for place in ((0.0, 0.0), (3.0, -2.0)):
        bench.robot.pose = np.array([*place, 0.0])
        corner = (place[0] - 2.0, place[1] - 1.5)
        costmap = bench.step_until(lambda costmap, at=corner: np.allclose(costmap.origin, at, atol=0.06))
        assert (costmap.width, costmap.height, costmap.resolution) == (80, 60, pytest.approx(0.05))
        assert bench.costmaps[-1].header.frame_id == "odom"


def test_what_was_seen_can_be_forgotten(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: ROLLING})).start()
    service = "/global_costmap/{}_global_costmap"

    def mark() -> Any:
        bench.see({**SEE_NEAR, **SEE_FAR})
        return bench.step_until(lambda costmap: cost(costmap, *NEAR) == cost(costmap, *FAR) == LETHAL)

    mark()
    bench.stage.call(ClearCostmapAroundRobot, service.format("clear_around"), reset_distance=1.2)
    costmap = bench.step_until(lambda costmap: cost(costmap, *NEAR) != LETHAL)
    assert cost(costmap, *FAR) == LETHAL
    mark()
    bench.stage.call(ClearCostmapExceptRegion, service.format("clear_except"), reset_distance=1.2)
    costmap = bench.step_until(lambda costmap: cost(costmap, *FAR) != LETHAL)
    assert cost(costmap, *NEAR) == LETHAL
    mark()
    poses = [pose_stamped(np.array([*place, 0.0]), "odom", time_message(0)) for place in (NEAR, FAR, (1.0, -1.0))]
    for use_footprint, blocked in ((False, LETHAL), (True, LETHAL)):
        answer = bench.stage.call(GetCosts, service.format("get_cost"), poses=poses, use_footprint=use_footprint)
        assert answer.success
        assert list(answer.costs) == [blocked, blocked, FREE]
    nowhere = pose_stamped(np.zeros(3), "nowhere", time_message(0))
    answer = bench.stage.call(GetCosts, service.format("get_cost"), poses=[nowhere])
    assert (answer.success, list(answer.costs)) == (False, [])
    bench.stage.call(ClearCostmapAroundPose, service.format("clear_around_pose"), pose=nowhere, reset_distance=9.0)
    bench.stage.call(ClearCostmapAroundPose, service.format("clear_around_pose"), pose=poses[1], reset_distance=0.3)
    costmap = bench.step_until(lambda costmap: cost(costmap, *FAR) != LETHAL)
    assert cost(costmap, *NEAR) == LETHAL
    mark()
    bench.stage.call(ClearEntireCostmap, service.format("clear_entirely"))
    costmap = bench.step_until(lambda costmap: not costmap.costs.any())
    answer = bench.stage.call(GetCostmap, "/global_costmap/get_costmap")
    assert np.array_equal(costmap_of(answer.map).costs, costmap.costs)
    assert answer.map.header.frame_id == "odom"


def test_the_footprint_is_published_where_the_robot_is(stage: Callable[[dict[str, Any]], Stage]) -> None:
    corners = "[[0.3, 0.2], [0.3, -0.2], [-0.1, -0.2], [-0.1, 0.2]]"
    bench = Bench(stage({NODE: {**ROLLING, "footprint": corners, "footprint_padding": 0.0}}))
    bench.robot.pose = np.array([1.0, 2.0, math.pi / 2])
    bench.stage.step()
    bench.start()
    outlines = bench.stage.collect(PolygonStamped, "/global_costmap/published_footprint")
    bench.stage.step_until(lambda: bool(outlines))
    points = np.array([(point.x, point.y) for point in outlines[-1].polygon.points])
    assert points == pytest.approx(np.array([[0.8, 2.3], [1.2, 2.3], [1.2, 1.9], [0.8, 1.9]]), abs=1e-6)
    assert outlines[-1].header.frame_id == "odom"


def test_topics_have_the_quality_of_service_of_nav2(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: {**ROLLING, "plugins": ["static_layer", "obstacle_layer"]}})).start()
    for topic in ("costmap", "costmap_raw"):
        (info,) = bench.stage.node.get_publishers_info_by_topic(f"/global_costmap/{topic}")
        assert info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        assert info.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        assert (info.node_namespace, info.node_name) == ("/global_costmap", "global_costmap")
    (info,) = bench.stage.node.get_subscriptions_info_by_topic("/map")
    assert info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    (info,) = bench.stage.node.get_subscriptions_info_by_topic("/scan")
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


def test_nothing_is_published_while_it_is_not_active(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: ROLLING}))
    bench.server.trigger_configure()
    bench.stage.step_for(1.0)
    assert bench.costmaps == []
    bench.server.trigger_activate()
    bench.step_until(lambda costmap: True)
    bench.server.trigger_deactivate()
    bench.stage.step()
    count = len(bench.costmaps)
    bench.stage.step_for(1.0)
    assert len(bench.costmaps) == count


def test_a_cleaned_costmap_forgets_what_it_saw(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: ROLLING})).start()
    bench.see(SEE_NEAR)
    bench.step_until(lambda costmap: cost(costmap, *NEAR) == LETHAL)
    bench.server.trigger_deactivate()
    bench.server.trigger_cleanup()
    del bench.costmaps[:]
    bench.start()
    assert not bench.step_until(lambda costmap: True).costs.any()


@pytest.mark.parametrize("frame", ["periscope", ""])
def test_a_sensor_without_a_transform_keeps_nobody_waiting(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str], frame: str
) -> None:
    bench = Bench(stage({NODE: ROLLING})).start()
    lost = LaserScan(ranges=array("f", [1.0]), angle_increment=0.1, range_max=5.0)
    lost.header.frame_id, lost.header.stamp = frame, bench.stage.stamp
    bench.stage.publish("/scan", lost)
    bench.step_until(lambda costmap: True)
    bench.see(SEE_NEAR)
    bench.step_until(lambda costmap: cost(costmap, *NEAR) == LETHAL)
    assert f"waiting for the transform from {frame} to base_link" in capfd.readouterr().err


def test_transforms_are_found_where_the_server_in_a_namespace_remaps_them(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    test = stage({})
    arguments = ["-r", "__ns:=/robot", "-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    server = test.add(PlannerServer(cli_args=["--ros-args", *arguments]))
    assert server.trigger_configure() == TransitionCallbackReturn.SUCCESS
    test.publish(
        "/robot/tf_static",
        TFMessage(transforms=[transform_stamped((2.0, 0.0, 0.0), "map", "base_link", test.stamp)]),
        LATCHED,
    )
    test.step_until(lambda: server._costmap.robot_pose() is not None)
    assert server._costmap.robot_pose()[0] == 2.0
    assert "/robot/scan" in {one.topic_name for one in server._costmap.subscriptions}


@pytest.mark.parametrize("latched", [True, False])
def test_a_map_is_taken_from_a_latched_topic_unless_the_layer_asks_for_new_ones_only(
    stage: Callable[[dict[str, Any]], Stage], latched: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    layer = {"map_subscribe_transient_local": latched}
    test = stage({NODE: {**STATIC, "always_send_full_costmap": True, "static_layer": layer}})
    server = test.add(PlannerServer())
    assert server.trigger_configure() == TransitionCallbackReturn.SUCCESS
    (listening,) = [one for one in server._costmap.subscriptions if one.topic_name == "/map"]
    assert (listening.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL) == latched
    told = capfd.readouterr().err
    assert "without effect: always_send_full_costmap: the whole costmap is always published" in told
    assert "not declared" not in told


def test_a_sonar_marks_what_it_measures(stage: Callable[[dict[str, Any]], Stage]) -> None:
    sonar = {"plugin": "nav2_costmap_2d::RangeSensorLayer", "topics": ["sonar"], "no_readings_timeout": 5.0}
    bench = Bench(stage({NODE: {**ROLLING, "plugins": ["sonar_layer"], "sonar_layer": sonar}})).start()
    assert bench.server._costmap._missing_input() == "there is no measurement on 'sonar'"
    message = Range(range=0.62, min_range=0.02, max_range=2.0, field_of_view=0.3)
    message.header.frame_id, message.header.stamp = "laser", bench.stage.stamp
    publisher = bench.stage.node.create_publisher(Range, "/sonar", 10)
    publisher.publish(message)
    bench.step_until(lambda costmap: cost(costmap, 0.3 - 0.62, 0.0) == LETHAL)
    assert bench.server._costmap._missing_input() == ""


def test_voxels_of_a_depth_camera_fade_sooner_where_it_looks(stage: Callable[[dict[str, Any]], Stage]) -> None:
    camera = {"topic": "/depth/points", "clearing": True, "decay_acceleration": 60.0, "obstacle_range": 3.0}
    layer = {
        "plugin": "spatio_temporal_voxel_layer/SpatioTemporalVoxelLayer", "voxel_decay": 15, "voxel_size": 0.05,
        "publish_voxel_map": True, "observation_sources": "camera", "camera": camera,
    }  # fmt: skip
    bench = Bench(stage({NODE: {**ROLLING, "plugins": ["stvl"], "stvl": layer}})).start()
    voxels = bench.stage.collect(PointCloud2, "/global_costmap/stvl/voxel_grid")
    optical = TransformStamped(child_frame_id="depth")
    optical.header.frame_id = "base_link"
    optical.transform.translation.z = 0.4
    q = optical.transform.rotation  # z ahead, x to the right
    q.x, q.y, q.z, q.w = -0.5, 0.5, -0.5, 0.5
    bench.stage.publish("/tf_static", TFMessage(transforms=[optical]), LATCHED)
    clouds = bench.stage.node.create_publisher(PointCloud2, "/depth/points", 10)

    def see(*points: tuple[float, float, float]) -> None:
        clouds.publish(create_cloud_xyz32(Header(frame_id="depth", stamp=bench.stage.stamp), list(points)))

    see((-0.1, 0.0, 1.0), (0.0, 0.0, 1.5))
    bench.step_until(lambda costmap: cost(costmap, 1.0, 0.1) == cost(costmap, 1.5, 0.0) == LETHAL)
    assert read_points_numpy(voxels[-1], ["x", "y", "z"])[:, 2] == pytest.approx([0.4, 0.4], abs=0.03)
    for _ in range(30):
        see((0.0, 0.0, 1.5))
        bench.stage.step()
    costmap = bench.step_until(lambda costmap: cost(costmap, 1.0, 0.1) == FREE)
    assert cost(costmap, 1.5, 0.0) == LETHAL
    bench.stage.step_for(1.0)
    assert "'/depth/points' is" in bench.server._costmap._missing_input()


def test_layers_in_a_container_have_parameters_and_topics_of_their_own(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    obstacles = {**ROLLING["obstacle_layer"], "plugin": "nav2_costmap_2d::ObstacleLayer"}
    inside = {"plugins": ["front_obstacles"], "front_obstacles": obstacles}
    contained = {"plugin": "nav2_costmap_2d::PluginContainerLayer", **inside}
    alone = {name: value for name, value in ROLLING.items() if name != "obstacle_layer"}
    bench = Bench(stage({NODE: {**alone, "plugins": ["group"], "group": contained}})).start()
    bench.see(SEE_NEAR)
    bench.step_until(lambda costmap: cost(costmap, *NEAR) == LETHAL)


def test_an_unknown_layer_in_a_container_is_named(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    contained = {
        "plugin": "nav2_costmap_2d::PluginContainerLayer",
        "plugins": ["front"],
        "front": {"plugin": "nav2_costmap_2d::ObstacleLayr"},
    }
    test = stage({NODE: {**ROLLING, "plugins": ["group"], "group": contained}})
    assert test.add(PlannerServer()).trigger_configure() == TransitionCallbackReturn.FAILURE
    told = capfd.readouterr().err
    assert "'group.front.plugin': there is no costmap layer 'nav2_costmap_2d::ObstacleLayr'; did you mean" in told
