"""Each example of an extension, installed and used from outside."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from controller_manager_msgs import srv
from std_msgs.msg import Float64MultiArray

from daidalos.navigation.trees.behavior_tree import BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.nodes.conversions import path_array
from daidalos.simulation import Simulation
from navigation.trees.robots import ScriptedRobot, document
from nodes.controller_manager.rig import rig
from nodes.nav2_controller import test_controller_server as controllers
from nodes.nav2_planner import test_planner_server as planners
from nodes.stepped import Stage
from simulation.models import box, world

Set = Callable[[dict[str, Any]], Stage]
Install = Callable[[str], None]


def daidalos(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "daidalos.cli.daidalos", *words], capture_output=True, text=True, timeout=60
    )


@pytest.mark.parametrize(
    ("example", "kind", "name", "origin"),
    [
        ("sensor", "sensor", "inclinometer", "inclinometer 1.0"),
        ("planner", "planner", "straight_planner::StraightPlanner", "straight-planner 1.0"),
        ("controller", "navigation_controller", "carrot_controller::CarrotController", "carrot-controller 1.0"),
        ("joint_controller", "controller", "follow_target/FollowTarget", "follow-target 1.0"),
        ("tree_node", "tree_node", "IsPathShort", "path-conditions 1.0"),
        ("verb", "daidalos_verb", "weigh", "weigh 1.0"),
    ],
)
def test_it_is_listed_with_where_it_comes_from(
    install: Install, example: str, kind: str, name: str, origin: str
) -> None:
    install(example)
    listed = daidalos("extensions", kind, "--json")
    assert listed.returncode == 0, listed.stderr
    found = {one["name"]: one["origin"] for one in json.loads(listed.stdout)[kind]["extensions"]}
    assert found[name] == origin


def test_the_sensor_measures_how_far_its_link_leans(install: Install) -> None:
    install("sensor")
    sensor = "<sensor name='tilt' type='inclinometer'><update_rate>10</update_rate><offset>0.1</offset></sensor>"
    simulation = Simulation(world(box("b", pose="0 0 9 0.5 0 0", extra=sensor)))
    (sample, *_) = simulation.advance(100_000_000)
    assert (sample.topic, simulation.warnings) == ("/b/link/tilt/inclination", [])
    assert sample.value == pytest.approx(0.6, abs=1e-6)


@pytest.mark.slow
@pytest.mark.usefixtures("compiled")
@pytest.mark.timeout(300)
def test_the_planner_plans_where_the_straight_line_is_free(install: Install, stage: Set) -> None:
    install("planner")
    plugin = {"plugin": "straight_planner::StraightPlanner", "interpolation_resolution": 0.1}
    parameters = planners.changed("/planner_server", planner_plugins=["GridBased"], GridBased=plugin)
    bench = planners.Bench(stage(parameters)).start(planners.room())
    status, result = bench.plan(goal=planners.pose(-1.5, -1.0, yaw=0.5))
    assert status == GoalStatus.STATUS_SUCCEEDED
    path = path_array(result.path)
    assert path.shape == (21, 3)
    assert np.allclose(path[:, 0], -1.5)
    status, result = bench.plan(goal=planners.pose(1.5, 1.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, planners.Result.NO_VALID_PATH)
    assert "the straight line meets an obstacle" in result.error_msg


@pytest.mark.usefixtures("compiled")
@pytest.mark.timeout(300)
def test_the_controller_follows_a_path(install: Install, stage: Set) -> None:
    install("controller")
    plugin = {"plugin": "carrot_controller.CarrotController", "speed": 0.4}
    parameters = controllers.changed("/controller_server", controller_plugins=["FollowPath"], FollowPath=plugin)
    bench = controllers.Bench(stage(parameters)).start()
    status, _ = bench.drive(controllers.straight(1.0))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert max(command[0] for command in bench.robot.commands) == pytest.approx(0.4)


@pytest.mark.usefixtures("graph")
def test_the_joint_controller_follows_its_target(install: Install, tmp_path: Path) -> None:
    install("joint_controller")
    file = tmp_path / "follow.yaml"
    file.write_text("follow: {ros__parameters: {joint: elbow, gain: 2.0}}")
    with rig(**{"follow.type": "follow_target/FollowTarget", "follow.params_file": str(file)}) as one:
        assert "follow_target/FollowTarget" in one.ask(srv.ListControllerTypes, "list_controller_types").types
        one.start("follow")
        publisher = one.user.create_publisher(Float64MultiArray, "/follow/target", 10)
        publisher.publish(Float64MultiArray(data=[0.5]))
        states = one.node.manager.components["mock"].hardware.states
        one.cycle_until(lambda: states["elbow/velocity"] == 1.0)


def test_the_tree_node_judges_paths(install: Install) -> None:
    install("tree_node")
    text = document('<IsPathShort path="{path}" max_length="1.5"/>')
    for length, status in ((1.0, "SUCCESS"), (2.0, "FAILURE")):
        blackboard = Blackboard()
        blackboard.set("path", controllers.straight(length))
        robot = ScriptedRobot()
        assert robot.run(BehaviorTree.parse(text, robot, blackboard)) == status


@pytest.mark.slow
def test_the_verb_runs_and_is_in_the_help(install: Install, tmp_path: Path) -> None:
    install("verb")
    robot = tmp_path / "r.urdf"
    mass = "<inertial><mass value='2.5'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    robot.write_text(f"<robot name='r'><link name='base'>{mass}</link></robot>")
    assert daidalos("weigh", str(robot)).stdout == "2.5 kg\n"
    assert "  weigh       Add up the masses of a robot's links\n" in daidalos().stdout
    failed = daidalos("weigh", str(tmp_path / "none.urdf"))
    assert (failed.returncode, failed.stderr.count("\n")) == (2, 1)
