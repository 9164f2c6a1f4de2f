"""Nodes for recoveries: error codes, standing still, goals in obstacles and costmaps."""

import pytest
from nav_msgs.msg import Odometry

from daidalos.navigation.trees.behavior_tree import BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.services import ErrorCode, Outcome

from .robots import SUCCESS, ScriptedRobot, document, stamped


def build(robot, inside, **values):
    board = Blackboard()
    for name, value in values.items():
        board.set(name, value)
    return BehaviorTree.parse(document(inside), robot, board)


@pytest.mark.parametrize(
    ("codes", "code", "status"),
    [
        ("207;208", ErrorCode("NO_VALID_PATH", 208), "SUCCESS"),
        ("207;208", ErrorCode("TIMEOUT", 206), "FAILURE"),
        ("json:[207, 208]", 207, "SUCCESS"),
        ("{wanted}", 101, "SUCCESS"),
        ("207", None, "FAILURE"),
    ],
)
def test_error_codes_are_compared_by_number(codes, code, status):
    inside = f'<AreErrorCodesPresent error_code="{{code}}" error_codes_to_check="{codes}"/>'
    robot = ScriptedRobot()
    assert robot.run(build(robot, inside, code=code, wanted=[101, 107])) == status


def test_error_codes_that_are_no_numbers_are_refused():
    with pytest.raises(TreeError, match="the port 'error_codes_to_check' must be a code_list, not '1;b'"):
        build(ScriptedRobot(), '<AreErrorCodesPresent error_code="{code}" error_codes_to_check="1;b"/>')


def test_error_codes_of_an_action_have_names_and_numbers():
    robot = ScriptedRobot(Spin=[(0, Outcome(False, {}, ErrorCode("TIMEOUT", 702))), (0, SUCCESS)])
    tree = build(robot, "<Spin error_code_id=\"{code}\" _post=\"text := code == 702 ? 'late' : 'none'\"/>")
    robot.run(tree)
    assert (tree.blackboard.get("code"), tree.blackboard.get("text")) == ("TIMEOUT", "late")
    robot.run(tree)
    assert (tree.blackboard.get("code"), tree.blackboard.get("code").number) == ("NONE", 0)


def odometry(seconds, speed):
    message = Odometry()
    message.header.stamp.sec, message.header.stamp.nanosec = int(seconds), int(seconds % 1 * 1e9)
    message.twist.twist.linear.x = speed
    return message


def test_a_robot_is_stuck_that_stops_faster_than_it_can_brake():
    robot = ScriptedRobot()
    tree = build(robot, "<IsStuck/>")
    seen = []
    for message in (odometry(1.0, 0.5), odometry(1.1, 0.4), odometry(1.12, 0.0), odometry(1.12, -0.5)):
        robot.heard["odom"] = message
        seen.append([robot.run(tree), robot.run(tree)])
    assert seen == [["FAILURE"] * 2, ["FAILURE"] * 2, ["SUCCESS"] * 2, ["FAILURE"] * 2]


@pytest.mark.parametrize("node", ["IsStopped", "CheckStopStatus"])
def test_a_robot_has_stopped_after_a_time_at_rest(node):
    robot = ScriptedRobot()
    tree = build(robot, f'<{node} velocity_threshold="0.1" duration_stopped="250"/>')
    robot.speed = -0.2
    assert robot.run(tree) == "FAILURE"
    robot.speed = 0.05
    assert robot.run(tree, 3) == "RUNNING"
    assert robot.run(tree) == "SUCCESS"
    assert robot.run(tree) == "RUNNING"
    robot.velocity = lambda: None
    assert robot.run(tree) == "FAILURE"


@pytest.mark.parametrize(
    ("more", "kept"),
    [("", [1, 3, 4]), ('consider_unknown_as_obstacle="true"', [1, 3]), ('cost_threshold="100"', [1, 4])],
)
def test_goals_in_obstacles_are_removed(more, kept):
    costs = {"costs": [0.0, 254.0, 120.0, 255.0]}
    robot = ScriptedRobot(RemoveInCollisionGoals=[(1, Outcome(True, costs))])
    inside = f'<RemoveInCollisionGoals input_goals="{{goals}}" output_goals="{{goals}}" {more}/>'
    tree = build(robot, inside, goals=[stamped(x) for x in (1, 2, 3, 4)])
    assert robot.run(tree, 9) == "SUCCESS"
    assert [goal.pose.position.x for goal in tree.blackboard.get("goals")] == kept
    assert robot.goals["RemoveInCollisionGoals"]["use_footprint"] is True


def test_goals_stay_where_their_costs_are_not_known():
    robot = ScriptedRobot(RemoveInCollisionGoals=[(0, Outcome(False))])
    goals = [stamped(1)]
    inside = '<RemoveInCollisionGoals input_goals="{goals}" output_goals="{kept}"/>'
    tree = build(robot, inside, goals=goals)
    assert robot.run(tree) == "FAILURE"
    assert tree.blackboard.get("kept") is goals
    assert robot.run(build(robot, inside, goals=[])) == "FAILURE"
    assert robot.log == ["RemoveInCollisionGoals"]


def test_a_costmap_is_cleared_around_a_pose():
    robot = ScriptedRobot()
    pose = stamped(1)
    inside = '<ClearCostmapAroundPose service_name="clear" pose="{pose}" reset_distance="2.5"/>'
    tree = build(robot, inside, pose=pose)
    assert robot.run(tree) == "SUCCESS"
    sent = robot.goals["ClearCostmapAroundPose"]
    assert (sent["pose"], sent["reset_distance"]) == (pose, 2.5)
    assert tree.blackboard.get("number_recoveries") == 1


def test_a_nonblocking_sequence_waits_for_all_at_once():
    robot = ScriptedRobot(Spin=[(1, SUCCESS)])
    tree = build(robot, "<NonblockingSequence><Wait/><Spin/></NonblockingSequence>")
    assert robot.run(tree) == "RUNNING"
    assert robot.run(tree) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Wait"]
    tree = build(robot, "<NonblockingSequence><Spin/><AlwaysFailure/></NonblockingSequence>")
    robot.scripts["Spin"] = [(9, SUCCESS)]
    assert robot.run(tree) == "FAILURE"
    assert robot.log[-1] == "halt Spin"
