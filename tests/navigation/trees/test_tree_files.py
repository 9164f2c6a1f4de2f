"""The tree files of nav2_bt_navigator, with a robot of scripts."""

from types import SimpleNamespace

import pytest

from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.services import Outcome

from .robots import FAILURE, SUCCESS, ScriptedRobot, path_of, stamped

FOLDER = DEFAULT_TREE.parent
STRAIGHT = Outcome(True, {"path": path_of((0.0, 0.0), (2.0, 0.0))})
ROUTE = Outcome(True, {"path": path_of((1.0, 0.0), (4.0, 0.0)), "route": SimpleNamespace()})


def load(name, robot):
    board = Blackboard()
    board.set("goal", stamped(5.0))
    board.set("goals", [stamped(5.0), stamped(9.0)])
    return BehaviorTree.load(FOLDER / f"{name}.xml", robot, board)


def robot_of(**scripts):
    defaults = {
        "ComputePathToPose": [(0, STRAIGHT)],
        "ComputePathThroughPoses": [(0, STRAIGHT)],
        "ComputeRoute": [(0, ROUTE)],
        "SmoothPath": [(0, STRAIGHT)],
        "FollowPath": [(30, SUCCESS)],
        "IsPathValid": [(0, SUCCESS)],
    }
    return ScriptedRobot(**(defaults | scripts))


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.xml")), ids=lambda path: path.stem)
def test_a_tree_drives_to_its_end(path):
    robot = robot_of()
    tree = load(path.stem, robot)
    status = robot.run(tree, ticks=60)
    if path.stem == "follow_point":
        assert status == "RUNNING"
    else:
        assert status == "SUCCESS"
    assert ("DriveOnHeading" if path.stem == "odometry_calibration" else "FollowPath") in robot.log


@pytest.mark.parametrize(
    ("name", "plans"),
    [
        ("navigate_w_replanning_time", 3),
        ("navigate_w_replanning_distance", 1),
        ("navigate_w_replanning_only_if_goal_is_updated", 1),
        ("navigate_w_replanning_only_if_path_becomes_invalid", 1),
        ("nav_to_pose_with_consistent_replanning_and_if_path_becomes_invalid", 1),
    ],
)
def test_how_often_it_plans(name, plans):
    robot = robot_of(FollowPath=[(99, SUCCESS)])
    tree = load(name, robot)
    robot.run(tree, ticks=28)
    assert robot.log.count("ComputePathToPose") == plans


@pytest.mark.parametrize(
    "name",
    [
        "navigate_w_replanning_only_if_path_becomes_invalid",
        "navigate_w_recovery_and_replanning_only_if_path_becomes_invalid",
        "nav_to_pose_with_consistent_replanning_and_if_path_becomes_invalid",
    ],
)
def test_a_path_that_is_blocked_is_planned_anew(name):
    robot = robot_of(FollowPath=[(99, SUCCESS)], IsPathValid=[(0, SUCCESS), (0, FAILURE), (0, SUCCESS)])
    tree = load(name, robot)
    robot.run(tree, ticks=35)
    assert robot.log.count("ComputePathToPose") == 2


def test_a_new_goal_is_planned_for():
    robot = robot_of(FollowPath=[(99, SUCCESS)])
    tree = load("navigate_w_replanning_only_if_goal_is_updated", robot)
    robot.run(tree, ticks=15)
    tree.blackboard.set("goal", stamped(7.0, sec=1))
    robot.run(tree, ticks=15)
    assert robot.log.count("ComputePathToPose") == 2


def test_the_robot_waits_near_the_goal_for_the_way_to_open():
    detour = Outcome(True, {"path": path_of((0.0, 0.0), (1.0, 2.0), (2.0, 0.0))})
    robot = robot_of(ComputePathToPose=[(0, STRAIGHT), (0, detour)], FollowPath=[(99, SUCCESS)], Wait=[(30, SUCCESS)])
    tree = load("navigate_to_pose_w_replanning_goal_patience_and_recovery", robot)
    robot.run(tree, ticks=15)
    assert "Wait" in robot.log
    assert robot.log.index("halt FollowPath") < robot.log.index("Wait") or "CancelControl" in robot.log


def test_a_controller_that_fails_is_followed_by_a_recovery():
    failing = Outcome(False, {}, "FAILED_TO_MAKE_PROGRESS", "stuck")
    robot = robot_of(FollowPath=[(0, failing), (0, failing), (0, SUCCESS)])
    for name in (
        "navigate_w_recovery_and_replanning_only_if_path_becomes_invalid",
        "navigate_on_route_graph_w_recovery",
    ):
        robot.log.clear()
        robot.scripts["FollowPath"] = [(0, failing), (0, failing), (0, SUCCESS)]
        assert robot.run(load(name, robot), ticks=60) == "SUCCESS"
        assert robot.log.count("ClearEntireCostmap") == 3


def test_the_way_along_a_graph_goes_from_the_robot_over_the_route_to_the_goal():
    robot = robot_of()
    assert robot.run(load("navigate_on_route_graph_w_recovery", robot), ticks=60) == "SUCCESS"
    path = robot.goals["FollowPath"]["path"]
    assert [pose.pose.position.x for pose in path.poses] == [0.0, 2.0, 1.0, 4.0, 0.0, 2.0]


def test_follow_point_follows_the_last_point():
    robot = robot_of(FollowPath=[(5, SUCCESS)])
    robot.heard["goal_update"] = stamped(7.0, sec=5)
    robot.run(load("follow_point", robot), ticks=20)
    assert robot.goals["ComputePathToPose"]["goal"].pose.position.x == 7.0
    assert robot.goals["FollowPath"]["path"].poses[-1].pose.position.x < 1.05
