"""Names of extensions that nobody knows, in the parameters of Nav2's servers and among components."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rclpy.lifecycle import TransitionCallbackReturn

from daidalos.common.extensions import ExtensionError
from daidalos.nodes.extensions import find_component
from daidalos.nodes.nav2_behaviors.behavior_server import BehaviorServer
from daidalos.nodes.nav2_bt_navigator.bt_navigator import BtNavigator
from daidalos.nodes.nav2_controller.controller_server import ControllerServer
from daidalos.nodes.nav2_planner.planner_server import PlannerServer
from daidalos.workspaces.executables import LEFT_OUT
from nodes.stepped import Stage, stage

__all__ = ["stage"]

LOCAL = "/local_costmap/local_costmap"
MPPI = {"plugin": "nav2_mppi_controller::MPPIController", "critics": ["CostCritik"], "batch_size": 10}


@pytest.mark.parametrize(
    ("server", "node", "values", "message"),
    [
        (
            PlannerServer,
            "/planner_server",
            {"GridBased": {"plugin": "nav2_navfn_planner::NavfnPlaner"}},
            "'GridBased.plugin': there is no planner 'nav2_navfn_planner::NavfnPlaner'; did you mean "
            "'nav2_navfn_planner::NavfnPlanner'?",
        ),
        (
            ControllerServer,
            "/controller_server",
            {"FollowPath": {"plugin": "rtabmap_nav::Pilot"}},
            "'FollowPath.plugin': there is no navigation controller 'rtabmap_nav::Pilot'; there are: ",
        ),
        (
            ControllerServer,
            "/controller_server",
            {"FollowPath": MPPI},
            "'FollowPath.critics': there is no critic 'CostCritik'; did you mean 'mppi::critics::CostCritic'",
        ),
        (
            ControllerServer,
            "/controller_server",
            {"goal_checker": {"plugin": "nav2_controller::SimpleGoalCheker"}},
            "'goal_checker.plugin': there is no goal checker 'nav2_controller::SimpleGoalCheker'; did you mean ",
        ),
        (
            ControllerServer,
            "/controller_server",
            {"progress_checker": {"plugin": "nav2_controller::Progress"}},
            "'progress_checker.plugin': there is no progress checker 'nav2_controller::Progress'; there are: ",
        ),
        (
            ControllerServer,
            LOCAL,
            {"plugins": ["voxels"], "voxels": {"plugin": "nav2_costmap_2d::BoxLayer"}},
            "'voxels.plugin': there is no costmap layer 'nav2_costmap_2d::BoxLayer'; ",
        ),
        (
            ControllerServer,
            LOCAL,
            {"plugins": [], "filters": ["zones"], "zones": {"plugin": "nav2_costmap_2d::KeepoutFiltre"}},
            "'zones.plugin': there is no costmap layer 'nav2_costmap_2d::KeepoutFiltre'; did you mean ",
        ),
        (
            BehaviorServer,
            "/behavior_server",
            {"behavior_plugins": ["assist"], "assist": {"plugin": "nav2_behaviors::Teleop"}},
            "'assist.plugin': there is no behavior 'nav2_behaviors::Teleop'; there are: ",
        ),
    ],
)
def test_the_transition_fails_with_one_line_that_names_file_and_line(
    stage: Callable[[dict[str, Any]], Stage],
    capfd: pytest.CaptureFixture[str],
    server: Any,
    node: str,
    values: dict[str, Any],
    message: str,
) -> None:
    made = stage({node: values}).add(server())
    assert made.trigger_configure() == TransitionCallbackReturn.FAILURE
    assert made.current_state.label == "unconfigured"
    printed = _wait_for_message(capfd, message)
    line = next(line for line in printed.splitlines() if message in line)
    assert "parameters.yaml:" in line
    assert "Traceback" not in printed


def test_a_tree_with_an_unknown_node_fails_the_transition(
    stage: Callable[[dict[str, Any]], Stage],
    capfd: pytest.CaptureFixture[str],
    tmp_path: Any,
) -> None:
    tree = tmp_path / "tree.xml"
    tree.write_text('<root BTCPP_format="4">\n<BehaviorTree ID="Main">\n<Spim/>\n</BehaviorTree></root>')
    made = stage({"/bt_navigator": {"default_nav_to_pose_bt_xml": str(tree)}}).add(BtNavigator())
    assert made.trigger_configure() == TransitionCallbackReturn.FAILURE
    printed = _wait_for_message(capfd, f"{tree}:3: '<Spim>': there is no tree node 'Spim'; did you mean 'Spin'")
    assert "Traceback" not in printed


def test_a_component_of_which_the_build_left_out_the_cpp_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    index = tmp_path / "share" / "ament_index" / "resource_index"
    for kind, text in (("packages", ""), (LEFT_OUT, "talker_component: 'talker_component' is C++ and was left out\n")):
        (index / kind).mkdir(parents=True)
        (index / kind / "cpp_pubsub").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    with pytest.raises(ExtensionError, match="of package 'cpp_pubsub' was left out of the build: talker_component"):
        find_component("cpp_pubsub", "cpp_pubsub::Talker")


def _wait_for_message(capfd: pytest.CaptureFixture[str], message: str, timeout_s: float = 30.0) -> str:
    """Return what was printed on standard error until a message, which another thread may print, is in it."""
    printed = ""
    deadline = time.monotonic() + timeout_s
    while message not in printed:
        assert time.monotonic() < deadline, f"no '{message}' in:\n{printed}"
        printed += capfd.readouterr().err
        time.sleep(0.01)
    return printed
