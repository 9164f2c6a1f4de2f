"""What each node does, tick by tick."""

import numpy as np
import pytest
from std_msgs.msg import String

from daidalos.navigation.trees.behavior_tree import BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard

from .robots import FAILURE, SUCCESS, ScriptedRobot, document

CLEAR = '<ClearEntireCostmap service_name="clear"/>'


def build(robot, inside, **values):
    board = Blackboard()
    for name, value in values.items():
        board.set(name, value)
    return BehaviorTree.parse(document(inside), robot, board)


def test_a_sequence_goes_on_where_it_was_and_ends_with_the_first_failure():
    robot = ScriptedRobot(Spin=[(2, SUCCESS)], BackUp=[(0, FAILURE)])
    tree = build(robot, "<Sequence><Wait/><Spin/><BackUp/><Wait/></Sequence>")
    assert robot.run(tree) == "RUNNING"
    assert robot.run(tree, 9) == "FAILURE"
    assert robot.log == ["Wait", "Spin", "BackUp"]
    robot.run(tree)
    assert robot.log[3:] == ["Wait", "Spin"]


def test_a_reactive_sequence_begins_anew_and_halts_what_runs():
    robot = ScriptedRobot(Wait=[(0, SUCCESS), (0, SUCCESS), (0, FAILURE)], Spin=[(9, SUCCESS)])
    tree = build(robot, "<ReactiveSequence><Wait/><Spin/></ReactiveSequence>")
    assert robot.run(tree, 2) == "RUNNING"
    assert robot.run(tree) == "FAILURE"
    assert robot.log == ["Wait", "Spin", "Wait", "Wait", "halt Spin"]


def test_a_fallback_tries_until_one_succeeds():
    robot = ScriptedRobot(Wait=[(0, FAILURE)], Spin=[(1, SUCCESS)])
    tree = build(robot, "<Fallback><Wait/><Spin/><BackUp/></Fallback>")
    assert robot.run(tree, 9) == "SUCCESS"
    assert robot.log == ["Wait", "Spin"]


def test_a_reactive_fallback_halts_what_runs_when_the_first_succeeds():
    robot = ScriptedRobot(Wait=[(0, FAILURE), (0, FAILURE), (0, SUCCESS)], Spin=[(9, SUCCESS)])
    tree = build(robot, "<ReactiveFallback><Wait/><Spin/></ReactiveFallback>")
    assert robot.run(tree, 9) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Wait", "Wait", "halt Spin"]


def test_a_pipeline_ticks_all_up_to_the_farthest_and_ends_with_a_failure():
    robot = ScriptedRobot(Wait=[(0, SUCCESS), (0, SUCCESS), (1, SUCCESS), (0, FAILURE)], Spin=[(9, SUCCESS)])
    tree = build(robot, "<PipelineSequence><Wait/><Spin/><BackUp/></PipelineSequence>")
    assert robot.run(tree, 4) == "RUNNING"
    assert robot.log == ["Wait", "Spin", "Wait", "Wait"]
    assert robot.run(tree) == "FAILURE"
    assert robot.log[-2:] == ["Wait", "halt Spin"]


def test_a_pipeline_that_is_filled_succeeds():
    robot = ScriptedRobot(Spin=[(1, SUCCESS)])
    tree = build(robot, "<PipelineSequence><Wait/><Spin/></PipelineSequence>")
    assert robot.run(tree, 9) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Wait"]


@pytest.mark.parametrize(("failures", "end"), [(2, "SUCCESS"), (3, "FAILURE")])
def test_recovery_retries_as_often_as_told(failures, end):
    robot = ScriptedRobot(Spin=[(0, FAILURE)] * failures + [(0, SUCCESS)])
    tree = build(robot, '<RecoveryNode number_of_retries="2"><Spin/><Wait/></RecoveryNode>')
    assert robot.run(tree, 9) == end
    assert robot.log.count("Spin") == 3
    assert robot.log.count("Wait") == 2


def test_recovery_fails_with_its_recovery():
    robot = ScriptedRobot(Spin=[(0, FAILURE)], Wait=[(2, FAILURE)])
    tree = build(robot, '<RecoveryNode number_of_retries="5"><Spin/><Wait/></RecoveryNode>')
    assert robot.run(tree) == "RUNNING"
    assert robot.run(tree, 9) == "FAILURE"
    assert robot.log == ["Spin", "Wait"]


def test_retries_are_counted_anew_each_time():
    robot = ScriptedRobot(Spin=[(0, FAILURE), (0, SUCCESS), (0, FAILURE), (0, SUCCESS)])
    tree = build(robot, '<RecoveryNode number_of_retries="1"><Spin/><Wait/></RecoveryNode>')
    assert [robot.run(tree), robot.run(tree)] == ["SUCCESS", "SUCCESS"]


def test_round_robin_takes_turns_and_skips_failures():
    robot = ScriptedRobot(Spin=[(0, FAILURE), (0, SUCCESS)])
    tree = build(robot, "<RoundRobin><Wait/><Spin/><BackUp/></RoundRobin>")
    assert [robot.run(tree) for _ in range(3)] == ["SUCCESS"] * 3
    assert robot.log == ["Wait", "Spin", "BackUp", "Wait"]


def test_round_robin_fails_when_all_fail_and_begins_anew_after_a_halt():
    robot = ScriptedRobot(Wait=[(0, FAILURE)], Spin=[(0, FAILURE)])
    tree = build(robot, "<RoundRobin><Wait/><Spin/></RoundRobin>")
    assert robot.run(tree) == "FAILURE"
    robot = ScriptedRobot(Spin=[(5, SUCCESS)])
    tree = build(robot, "<RoundRobin><Wait/><Spin/></RoundRobin>")
    robot.run(tree)
    robot.run(tree)
    tree.halt()
    robot.run(tree)
    assert robot.log == ["Wait", "Spin", "halt Spin", "Wait"]


def test_a_rate_controller_ticks_at_its_rate_and_repeats_itself():
    robot = ScriptedRobot()
    tree = build(robot, '<RateController hz="2.0"><Wait/></RateController>')
    states = [robot.run(tree) for _ in range(11)]
    assert states == ["SUCCESS"] * 11
    assert robot.log == ["Wait"] * 3


def test_a_rate_controller_ticks_a_child_that_runs_every_time():
    robot = ScriptedRobot(Spin=[(3, SUCCESS)])
    tree = build(robot, '<RateController hz="0.1"><Spin/></RateController>')
    assert [robot.run(tree) for _ in range(4)] == ["RUNNING"] * 3 + ["SUCCESS"]


@pytest.mark.parametrize(
    ("node", "outcome", "end"),
    [
        ("Inverter", SUCCESS, "FAILURE"),
        ("Inverter", FAILURE, "SUCCESS"),
        ("ForceSuccess", FAILURE, "SUCCESS"),
        ("ForceFailure", SUCCESS, "FAILURE"),
    ],
)
def test_decorators_of_the_result(node, outcome, end):
    robot = ScriptedRobot(Spin=[(1, outcome)])
    tree = build(robot, f"<{node}><Spin/></{node}>")
    assert robot.run(tree) == "RUNNING"
    assert robot.run(tree) == end


def test_a_new_goal_is_noticed_once_and_forgotten_after_a_halt():
    robot = ScriptedRobot()
    tree = build(robot, "<GoalUpdated/>", goal=np.zeros(3))
    assert robot.run(tree) == "FAILURE"
    tree.blackboard.set("goal", np.zeros(3))
    assert robot.run(tree) == "FAILURE"
    tree.blackboard.set("goal", np.ones(3))
    assert [robot.run(tree), robot.run(tree)] == ["SUCCESS", "FAILURE"]
    tree.blackboard.set("goal", np.zeros(3))
    tree.halt()
    assert robot.run(tree) == "FAILURE"


@pytest.mark.parametrize(
    ("node", "code", "end"),
    [
        ("WouldAPlannerRecoveryHelp", "NO_VALID_PATH", "SUCCESS"),
        ("WouldAPlannerRecoveryHelp", "GOAL_OCCUPIED", "FAILURE"),
        ("WouldAPlannerRecoveryHelp", "NONE", "FAILURE"),
        ("WouldAControllerRecoveryHelp", "FAILED_TO_MAKE_PROGRESS", "SUCCESS"),
        ("WouldAControllerRecoveryHelp", "INVALID_PATH", "FAILURE"),
    ],
)
def test_only_some_errors_can_be_helped(node, code, end):
    robot = ScriptedRobot()
    assert robot.run(build(robot, f'<{node} error_code="{{code}}"/>', code=code)) == end


def test_an_action_gets_its_inputs_with_their_types_and_writes_its_outputs():
    path = object()
    robot = ScriptedRobot(ComputePathToPose=[(1, type(SUCCESS)(True, {"path": path}))])
    tree = build(
        robot,
        '<ComputePathToPose goal="{target}" planner_id="GridBased" path="{way}" error_code_id="{code}"/>',
        target="there",
    )
    assert robot.run(tree) == "RUNNING"
    assert robot.run(tree) == "SUCCESS"
    assert robot.goals["ComputePathToPose"] == {"goal": "there", "planner_id": "GridBased"}
    assert tree.blackboard.get("way") is path
    assert tree.blackboard.get("code") == "NONE"


def test_defaults_and_literals_have_the_ports_types():
    robot = ScriptedRobot()
    robot.run(build(robot, '<Spin spin_dist="3.5" is_recovery="false"/>'))
    assert robot.goals["Spin"] == {
        "spin_dist": 3.5,
        "time_allowance": 10.0,
        "is_recovery": False,
        "disable_collision_checks": False,
    }


def test_errors_reach_the_blackboard():
    robot = ScriptedRobot(FollowPath=[(0, FAILURE)])
    tree = build(robot, '<FollowPath path="{path}" error_code_id="{code}" error_msg="{words}"/>', path=[1])
    assert robot.run(tree) == "FAILURE"
    assert (tree.blackboard.get("code"), tree.blackboard.get("words")) == ("UNKNOWN", "scripted")


def test_a_new_path_is_handed_on_while_following():
    robot = ScriptedRobot(FollowPath=[(9, SUCCESS)])
    first, second = np.zeros((2, 3)), np.ones((2, 3))
    tree = build(robot, '<FollowPath path="{path}"/>', path=first)
    robot.run(tree, 3)
    tree.blackboard.set("path", second)
    robot.run(tree, 3)
    assert robot.log == ["FollowPath", "update FollowPath"]
    assert robot.goals["FollowPath"]["path"] is second


def test_recoveries_are_counted():
    robot = ScriptedRobot()
    tree = build(
        robot, f'<Sequence><Wait/><Spin/><Spin is_recovery="false"/><BackUp/>{CLEAR}<DriveOnHeading/></Sequence>'
    )
    robot.run(tree)
    assert tree.blackboard.get("number_recoveries") == 4


@pytest.mark.parametrize(
    "kind", ["planner", "controller", "smoother", "goal_checker", "progress_checker", "path_handler"]
)
def test_selectors_take_what_was_chosen_or_the_default(kind):
    robot = ScriptedRobot()
    name = "".join(word.capitalize() for word in kind.split("_"))
    tree = build(robot, f'<{name}Selector default_{kind}="First" selected_{kind}="{{chosen}}"/>')
    robot.run(tree)
    assert tree.blackboard.get("chosen") == "First"
    robot.heard[f"{kind}_selector"] = String(data="Second")
    robot.run(tree)
    assert tree.blackboard.get("chosen") == "Second"
