"""Parameters of ROS 1's files, and those that Nav2's servers get for them."""

import pytest

from daidalos.common.errors import UserError
from daidalos.common.parameters import ParameterError
from daidalos.nodes.move_base._parameters import CLEAR, ROTATE, MoveBaseParameters, Recovery, recoveries
from daidalos.nodes.move_base._translation import translate

TEB = "teb_local_planner/TebLocalPlannerROS"


def nodes(**more):
    """Return the parameters of the nodes for given ones, with dots in place of `__`."""
    p = {name: more.pop(name) for name in list(more) if name in ("base_global_planner", "base_local_planner")}
    given = {name.replace("__", "."): value for name, value in more.items()}
    return translate(MoveBaseParameters(**{"base_local_planner": TEB} | p), given, "/robot", "/robot/odom")


def test_older_costmaps_without_a_list_of_layers():
    found = nodes(
        global_costmap__global_frame="/map", global_costmap__robot_base_frame="base_footprint",
        global_costmap__static_map=True, global_costmap__obstacle_range=3, global_costmap__raytrace_range=3.5,
        global_costmap__inflation_radius=1, global_costmap__cost_scaling_factor=3.0,
        global_costmap__observation_sources="scan bump", global_costmap__scan__topic="scan",
        global_costmap__scan__raytrace_range=5, global_costmap__scan__sensor_frame="base_scan",
        global_costmap__bump__data_type="PointCloud2", global_costmap__bump__topic="/bump",
        local_costmap__rolling_window=True, local_costmap__width=3, local_costmap__map_type="voxel",
        local_costmap__footprint="[[0.1, 0.1], [0.1, -0.1], [-0.1, 0.0]]",
    )  # fmt: skip
    whole, local = (found.nodes[f"{name}/{name}"] for name in ("global_costmap", "local_costmap"))
    assert whole["plugins"] == ["static_layer", "obstacle_layer", "inflation_layer"]
    assert (whole["global_frame"], whole["robot_base_frame"]) == ("map", "base_footprint")
    assert whole["map_topic"] == "/robot/map"
    assert whole["inflation_layer"] == {
        "plugin": "nav2_costmap_2d::InflationLayer", "inflation_radius": 1.0, "cost_scaling_factor": 3.0
    }  # fmt: skip
    layer = whole["obstacle_layer"]
    assert layer["plugin"] == "nav2_costmap_2d::ObstacleLayer"
    assert layer["observation_sources"] == "scan bump"
    assert layer["scan"] == {"topic": "/robot/scan", "obstacle_max_range": 3.0, "raytrace_max_range": 5.0}
    assert layer["bump"] == {
        "topic": "/bump", "data_type": "PointCloud2", "obstacle_max_range": 3.0, "raytrace_max_range": 3.5
    }  # fmt: skip
    assert local["plugins"] == ["obstacle_layer", "inflation_layer"]
    assert local["obstacle_layer"]["plugin"] == "nav2_costmap_2d::VoxelLayer"
    assert (local["rolling_window"], local["width"], local["global_frame"]) == (True, 3.0, "odom")
    assert found.nodes["behavior_server"]["local_frame"] == "odom"
    assert "global_costmap.scan.sensor_frame" in found.used


def test_layers_of_a_list_have_their_parameters_below_their_names():
    found = nodes(
        global_costmap__plugins="[{'name': 'map', 'type': 'costmap_2d::StaticLayer'}, "
        "{'name': 'lasers', 'type': 'costmap_2d::ObstacleLayer'}]",
        global_costmap__map__map_topic="floor", global_costmap__lasers__observation_sources="front",
        global_costmap__lasers__front__marking=False, global_costmap__lasers__obstacle_range=4,
    )  # fmt: skip
    whole = found.nodes["global_costmap/global_costmap"]
    assert whole["plugins"] == ["map", "lasers"]
    assert whole["map"]["map_topic"] == "/robot/floor"
    assert whole["lasers"]["front"] == {"topic": "/robot/front", "marking": False, "obstacle_max_range": 4.0}
    with pytest.raises(UserError, match=r"'plugins' must be a list of \{name: ..., type: ...\}, got '\[1\]'"):
        nodes(global_costmap__plugins="[1]")
    with pytest.raises(
        UserError, match=r"'map\.type': there is no costmap layer 'nav2_costmap_2d::StatikLayer'; did you mean"
    ):
        nodes(global_costmap__plugins="[{'name': 'map', 'type': 'costmap_2d::StatikLayer'}]")


def test_the_timed_elastic_band_leaves_its_tolerances_to_the_checker():
    found = nodes(
        TebLocalPlannerROS__max_vel_x=1, TebLocalPlannerROS__xy_goal_tolerance=0.3, TebLocalPlannerROS__odom_topic="o"
    )
    server = found.nodes["controller_server"]
    assert server["controller_plugins"] == ["TebLocalPlannerROS"]
    assert server["TebLocalPlannerROS"] == {"plugin": "teb_local_planner::TebLocalPlannerROS", "max_vel_x": 1.0}
    assert isinstance(server["TebLocalPlannerROS"]["max_vel_x"], float)
    assert server["goal_checker"]["xy_goal_tolerance"] == 0.3
    assert server["odom_topic"] == "/robot/o"
    assert nodes().nodes["controller_server"]["odom_topic"] == "/robot/odom"


@pytest.mark.parametrize("name", ["dwa_local_planner/DWAPlannerROS", "base_local_planner/TrajectoryPlannerROS"])
def test_planners_of_arcs_have_todays_names(name):
    short = name.split("/")[1]
    given = {"acc_lim_x": 1, "vth_samples": 9, "occdist_scale": 0.02, "path_distance_bias": 32, "min_vel_theta": -1.0}
    given |= {"max_vel_trans": 0.4, "latch_xy_goal_tolerance": True, "dwa": True}
    found = nodes(base_local_planner=name, **{f"{short}__{key}": value for key, value in given.items()})
    controller = found.nodes["controller_server"][short]
    assert controller["plugin"] == "dwb_core::DWBLocalPlanner"
    assert {key: controller[key] for key in ("acc_lim_x", "decel_lim_x", "vtheta_samples", "max_speed_xy")} == {
        "acc_lim_x": 1.0, "decel_lim_x": -1.0, "vtheta_samples": 9, "max_speed_xy": 0.4
    }  # fmt: skip
    assert (controller["BaseObstacle.scale"], controller["PathDist.scale"], controller["PathAlign.scale"]) == (
        0.02,
        32,
        32,
    )
    assert "min_speed_theta" not in controller
    assert found.nodes["controller_server"]["goal_checker"]["stateful"] is True
    assert found.without_effect == {f"{short}.dwa"}


def test_planners_have_todays_names():
    found = nodes(
        base_global_planner="global_planner/GlobalPlanner", GlobalPlanner__use_dijkstra=False,
        GlobalPlanner__default_tolerance=1, GlobalPlanner__neutral_cost=66, GlobalPlanner__allow_unknown=False,
    )  # fmt: skip
    server = found.nodes["planner_server"]
    assert server["planner_plugins"] == ["GlobalPlanner"]
    assert server["GlobalPlanner"] == {
        "plugin": "nav2_navfn_planner::NavfnPlanner", "tolerance": 1.0, "use_astar": True, "allow_unknown": False
    }  # fmt: skip
    assert found.without_effect == {"GlobalPlanner.neutral_cost"}
    today = nodes(base_global_planner="nav2_smac_planner/SmacPlannerHybrid", SmacPlannerHybrid__tolerance=0.5)
    assert today.nodes["planner_server"]["SmacPlannerHybrid"]["tolerance"] == 0.5
    with pytest.raises(
        UserError, match="'base_global_planner': there is no planner 'carrot_planner/CarrotPlanner'; there are: "
    ):
        nodes(base_global_planner="carrot_planner/CarrotPlanner")


def test_a_value_of_another_type_is_named():
    with pytest.raises(ParameterError, match=r"'TebLocalPlannerROS.max_vel_x' must be a float, got 'fast'"):
        nodes(TebLocalPlannerROS__max_vel_x="fast")
    with pytest.raises(ParameterError, match=r"'local_costmap.resolution' must be a float, got '5 cm'"):
        nodes(local_costmap__resolution="5 cm")


def test_recoveries_are_those_of_ros_1():
    turn = Recovery("rotate_recovery", ROTATE)
    reset, last = Recovery("conservative_reset", CLEAR, 3.0), Recovery("aggressive_reset", CLEAR, 0.8)
    assert recoveries(MoveBaseParameters(), {}, 0.2) == [reset, turn, last, turn]
    assert recoveries(MoveBaseParameters(clearing_rotation_allowed=False), {}, 0.2) == [reset, last]
    assert recoveries(MoveBaseParameters(recovery_behavior_enabled=False), {}, 0.2) == []
    listed = "[{'name': 'near', 'type': 'clear_costmap_recovery/ClearCostmapRecovery'}]"
    given = {"near.reset_distance": 1.5}
    assert recoveries(MoveBaseParameters(recovery_behaviors=listed), given, 0.2) == [Recovery("near", CLEAR, 1.5)]
    wrong = "[{'name': 'near', 'type': 'rotate_recovery/RotateRecovry'}]"
    with pytest.raises(UserError, match="there is no recovery 'rotate_recovery/RotateRecovry'; did you mean"):
        recoveries(MoveBaseParameters(recovery_behaviors=wrong), {}, 0.2)
