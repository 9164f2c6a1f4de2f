"""Nodes and attributes of BehaviorTree.CPP, tick by tick."""

import pytest

from daidalos.navigation.trees.behavior_tree import BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError

from .robots import FAILURE, SUCCESS, ScriptedRobot, document


def build(robot, inside, **values):
    board = Blackboard()
    for name, value in values.items():
        board.set(name, value)
    return BehaviorTree.parse(document(inside), robot, board)


def outcome(inside, robot=None, ticks=1, **values):
    """Status and log of a tree after some ticks."""
    robot = robot or ScriptedRobot()
    return robot.run(build(robot, inside, **values), ticks), robot.log


@pytest.mark.parametrize(
    ("conditions", "status", "log"),
    [
        ('_skipIf="n == 1"', "SUCCESS", ["Spin"]),
        ('_skipIf="n == 2"', "SUCCESS", ["Wait", "Spin"]),
        ('_successIf="n == 1"', "SUCCESS", ["Spin"]),
        ('_failureIf="n == 1"', "FAILURE", []),
        ('_while="n == 1"', "SUCCESS", ["Wait", "Spin"]),
        ('_while="n == 2"', "SUCCESS", ["Spin"]),
        ('_failureIf="n == 1" _skipIf="true"', "FAILURE", []),
    ],
)
def test_conditions_of_a_node(conditions, status, log):
    assert outcome(f"<Sequence><Wait {conditions}/><Spin/></Sequence>", n=1) == (status, log)


@pytest.mark.parametrize("node", ["Sequence", "Fallback", "ReactiveSequence", "ReactiveFallback", "PipelineSequence"])
def test_a_node_whose_children_are_all_skipped_is_skipped(node):
    skipped = f'<{node}><Wait _skipIf="true"/><Wait _skipIf="true"/></{node}>'
    assert outcome(f"<Sequence>{skipped}<Spin/></Sequence>") == ("SUCCESS", ["Spin"])
    assert outcome(f"<Fallback>{skipped}<Spin/></Fallback>") == ("SUCCESS", ["Spin"])
    assert outcome(f"<Sequence><ForceFailure>{skipped}</ForceFailure><Spin/></Sequence>") == ("SUCCESS", ["Spin"])


def test_a_tree_that_is_skipped_fails():
    assert outcome('<Wait _skipIf="true"/>') == ("FAILURE", [])


def test_a_skipped_recovery_is_a_failure():
    robot = ScriptedRobot(Wait=[(0, FAILURE)])
    assert outcome('<RecoveryNode><Wait/><Spin _skipIf="true"/></RecoveryNode>', robot) == ("FAILURE", ["Wait"])


def test_while_halts_a_node_that_runs():
    robot = ScriptedRobot(Wait=[(9, SUCCESS)])
    tree = build(robot, '<Sequence><Wait _while="go" _onHalted="halted := 1"/><Spin/></Sequence>', go=True)
    assert robot.run(tree, 2) == "RUNNING"
    tree.blackboard.set("go", False)
    assert robot.run(tree) == "SUCCESS"
    assert robot.log == ["Wait", "halt Wait", "Spin"]
    assert tree.blackboard.get("halted") == 1


def test_conditions_before_a_run_are_not_checked_while_it_runs():
    robot = ScriptedRobot(Wait=[(1, SUCCESS)])
    tree = build(robot, '<Wait _failureIf="stop" _successIf="stop"/>', stop=False)
    robot.run(tree)
    tree.blackboard.set("stop", True)
    assert robot.run(tree) == "SUCCESS"
    assert robot.log == ["Wait"]


@pytest.mark.parametrize(("end", "text"), [(SUCCESS, "sp"), (FAILURE, "fp")])
def test_scripts_of_the_end_of_a_node(end, text):
    robot = ScriptedRobot(Wait=[(1, end)])
    after = """_onSuccess="text += 's'" _onFailure="text += 'f'" _post="text += 'p'" _onHalted="text += 'h'" """
    tree = build(robot, f"<Wait {after}/>", text="")
    robot.run(tree, 9)
    assert tree.blackboard.get("text") == text
    robot.scripts["Wait"] = [(9, SUCCESS)]
    robot.run(tree)
    tree.halt()
    assert tree.blackboard.get("text") == text + "h"


def test_conditions_of_a_subtree_see_the_tree_around_it():
    text = """<root BTCPP_format="4" main_tree_to_execute="Main">
    <BehaviorTree ID="Main"><Sequence>
      <SubTree ID="Inner" _skipIf="n == 1"/><SubTree ID="Inner" n="{n}" _onSuccess="m := n"/>
      <SubTree ID="Inner" _autoremap="true"/>
    </Sequence></BehaviorTree>
    <BehaviorTree ID="Inner"><Script code="n += 1"/></BehaviorTree></root>"""
    board = Blackboard()
    board.set("n", 1)
    robot = ScriptedRobot()
    assert robot.run(BehaviorTree.parse(text, robot, board)) == "SUCCESS"
    assert (board.get("n"), board.get("m")) == (3, 2)


def test_scripts_are_nodes_too():
    inside = """<Sequence><Script code="n := 2"/><ScriptCondition code="n == 2"/>
      <SetBlackboard value="{n}" output_key="copy"/><SetBlackboard value="text" output_key="{other}"/>
      <UnsetBlackboard key="n"/></Sequence>"""
    robot = ScriptedRobot()
    tree = build(robot, inside)
    assert robot.run(tree) == "SUCCESS"
    assert (tree.blackboard.get("copy"), tree.blackboard.get("other"), "n" in tree.blackboard) == (2, "text", False)
    assert outcome('<ScriptCondition code="1 == 2"/>')[0] == "FAILURE"


@pytest.mark.parametrize("inside", ['<Script code="1 +"/>', '<Wait _skipIf="1 +"/>', '<SubTree ID="Main" _post="+"/>'])
def test_mistakes_in_scripts_are_named_when_the_tree_is_read(inside):
    with pytest.raises(TreeError, match=r"tree:1: .*(where it cannot be|contains itself)"):
        build(ScriptedRobot(), inside)


@pytest.mark.parametrize(
    ("attributes", "ends", "status"),
    [
        ("", (SUCCESS, SUCCESS, SUCCESS), "SUCCESS"),
        ("", (SUCCESS, FAILURE, SUCCESS), "FAILURE"),
        ('success_count="2" failure_count="2"', (SUCCESS, FAILURE, SUCCESS), "SUCCESS"),
        ('success_count="1" failure_count="-1"', (FAILURE, FAILURE, FAILURE), "FAILURE"),
        ('success_threshold="1" failure_threshold="3"', (FAILURE, FAILURE, SUCCESS), "SUCCESS"),
    ],
)
def test_parallel_counts_the_ends(attributes, ends, status):
    robot = ScriptedRobot(Wait=[(0, ends[0])], Spin=[(1, ends[1])], BackUp=[(2, ends[2])])
    assert outcome(f"<Parallel {attributes}><Wait/><Spin/><BackUp/></Parallel>", robot, 9)[0] == status
    assert robot.log[:3] == ["Wait", "Spin", "BackUp"]


def test_parallel_halts_what_still_runs_and_passes_over_what_is_skipped():
    robot = ScriptedRobot(Spin=[(9, SUCCESS)])
    inside = '<Parallel success_count="1"><Wait/><Spin/></Parallel>'
    assert outcome(inside, robot) == ("SUCCESS", ["Wait", "Spin", "halt Spin"])
    assert outcome('<Parallel><Wait _skipIf="true"/><Spin/></Parallel>') == ("SUCCESS", ["Spin"])


@pytest.mark.parametrize(("limit", "status"), [(1, "FAILURE"), (2, "SUCCESS")])
def test_parallel_all_waits_for_all(limit, status):
    robot = ScriptedRobot(Wait=[(0, FAILURE)], Spin=[(2, SUCCESS)])
    tree = build(robot, f'<ParallelAll max_failures="{limit}"><Wait/><Spin/></ParallelAll>')
    assert robot.run(tree, 2) == "RUNNING"
    assert robot.run(tree) == status
    assert robot.log == ["Wait", "Spin"]


def test_if_then_else_asks_once():
    robot = ScriptedRobot(Wait=[(1, SUCCESS), (0, FAILURE)], Spin=[(1, FAILURE)])
    tree = build(robot, "<IfThenElse><Wait/><Spin/><BackUp/></IfThenElse>")
    assert robot.run(tree, 9) == "FAILURE"
    assert robot.run(tree, 9) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Wait", "BackUp"]
    robot = ScriptedRobot(Wait=[(0, FAILURE)])
    assert outcome("<IfThenElse><Wait/><Spin/></IfThenElse>", robot) == ("FAILURE", ["Wait"])


def test_while_do_else_asks_each_time_and_halts():
    robot = ScriptedRobot(Wait=[(0, SUCCESS), (0, FAILURE)], Spin=[(9, SUCCESS)], BackUp=[(1, SUCCESS)])
    assert outcome("<WhileDoElse><Wait/><Spin/><BackUp/></WhileDoElse>", robot, 9)[0] == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Wait", "BackUp", "halt Spin", "Wait"]


@pytest.mark.parametrize(("value", "log"), [("go", ["Wait"]), (2, ["Spin"]), ("2.0", ["BackUp"]), (None, ["BackUp"])])
def test_a_switch_ticks_the_child_of_the_case(value, log):
    inside = '<Switch2 variable="{v}" case_1="go" case_2="2"><Wait/><Spin/><BackUp/></Switch2>'
    assert outcome(inside, v=value) == ("SUCCESS", log)


@pytest.mark.parametrize("cases", [2, 3, 4, 5, 6])
def test_switches_have_a_child_for_each_case_and_one_for_none(cases):
    names = "".join(f'case_{number}="{number}" ' for number in range(1, cases + 1))
    inside = "".join(f'<Script code="at := {number}"/>' for number in range(1, cases + 2))
    for value in range(1, cases + 2):
        robot = ScriptedRobot()
        tree = build(robot, f'<Switch{cases} variable="{{v}}" {names}>{inside}</Switch{cases}>', v=str(value))
        robot.run(tree)
        assert tree.blackboard.get("at") == value


def test_a_switch_halts_the_child_of_another_case():
    robot = ScriptedRobot(Wait=[(9, SUCCESS)])
    tree = build(robot, '<Switch2 variable="{v}" case_1="1" case_2="2"><Wait/><Spin/><BackUp/></Switch2>', v=1)
    robot.run(tree)
    tree.blackboard.set("v", 2)
    assert robot.run(tree) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "halt Wait"]


def test_timeouts_delays_and_sleeps_are_in_milliseconds():
    robot = ScriptedRobot(Wait=[(99, SUCCESS)])
    tree = build(robot, '<Timeout msec="250"><Wait/></Timeout>')
    assert robot.run(tree, 3) == "RUNNING"
    assert robot.run(tree) == "FAILURE"
    assert robot.log == ["Wait", "halt Wait"]
    for inside in ('<Delay delay_msec="250"><Wait/></Delay>', '<Sleep msec="250"/>'):
        robot = ScriptedRobot()
        tree = build(robot, inside)
        for _ in range(2):
            assert robot.run(tree, 3) == "RUNNING"
            assert robot.run(tree) == "SUCCESS"


def test_asynchronous_nodes_tick_one_child_at_a_time():
    robot = ScriptedRobot()
    tree = build(robot, "<AsyncSequence><Wait/><Spin/></AsyncSequence>")
    assert [robot.run(tree), robot.run(tree)] == ["RUNNING", "SUCCESS"]
    robot = ScriptedRobot(Wait=[(0, FAILURE)])
    tree = build(robot, "<AsyncFallback><Wait/><Spin/></AsyncFallback>")
    assert [robot.run(tree), robot.run(tree)] == ["RUNNING", "SUCCESS"]


def test_run_once_is_skipped_afterwards_or_repeats_itself():
    robot = ScriptedRobot(Wait=[(0, FAILURE)])
    tree = build(robot, "<Fallback><RunOnce><Wait/></RunOnce><Spin/></Fallback>")
    robot.run(tree)
    robot.run(tree)
    assert robot.log == ["Wait", "Spin", "Spin"]
    tree = build(robot, '<RunOnce then_skip="false"><Wait/></RunOnce>')
    assert [robot.run(tree), robot.run(tree)] == ["FAILURE", "FAILURE"]


@pytest.mark.parametrize(("more", "status"), [("", "FAILURE"), ('else="SUCCESS"', "SUCCESS")])
def test_a_precondition_is_a_script(more, status):
    assert outcome(f'<Precondition if="n == 1" {more}><Wait/></Precondition>', n=2) == (status, [])
    assert outcome(f'<Precondition if="n == 1" {more}><Wait/></Precondition>', n=1) == ("SUCCESS", ["Wait"])
    with pytest.raises(TreeError, match="else must be one of SUCCESS, FAILURE"):
        build(ScriptedRobot(), '<Precondition if="1" else="MAYBE"><Wait/></Precondition>')


@pytest.mark.parametrize(
    ("node", "queue", "values"),
    [
        ("LoopInt", "1;2", [1, 2]),
        ("LoopDouble", "0.5; 2", [0.5, 2.0]),
        ("LoopString", "a;b", ["a", "b"]),
        ("LoopBool", "true;false", [True, False]),
    ],
)
def test_a_loop_ticks_its_child_for_each_value(node, queue, values):
    robot = ScriptedRobot(Wait=[(1, SUCCESS)])
    inside = f'<{node} queue="{queue}" value="{{v}}" if_empty="FAILURE"><Wait/></{node}>'
    tree = build(robot, inside)
    for _ in range(2):
        seen = []
        while robot.run(tree) == "RUNNING":
            seen.append(tree.blackboard.get("v"))
        assert seen == [value for value in values for _ in range(2)]
        assert tree.status.name == "FAILURE"


def test_a_loop_empties_a_list_of_the_blackboard_and_fails_with_its_child():
    queue = [1, 2, 3]
    inside = '<LoopInt queue="{queue}" value="{v}"><ScriptCondition code="v &lt; 2"/></LoopInt>'
    assert outcome(inside, ticks=9, queue=queue)[0] == "FAILURE"
    assert queue == [3]
    assert outcome(inside, queue=[])[0] == "SUCCESS"
    with pytest.raises(TreeError, match="the port 'queue' must be a queue, not '1;b'"):
        build(ScriptedRobot(), '<LoopInt queue="1;b" value="{v}"><Wait/></LoopInt>')
    with pytest.raises(TreeError, match="if_empty must be one of SUCCESS, FAILURE, SKIPPED, not 'NONE'"):
        build(ScriptedRobot(), '<LoopInt queue="1" if_empty="NONE" value="{v}"><Wait/></LoopInt>')


@pytest.mark.parametrize(
    ("inside", "states"),
    [
        ('<WasEntryUpdated entry="{n}"/>', ["SUCCESS", "FAILURE", "SUCCESS"]),
        ('<SkipUnlessUpdated entry="n"><Wait/></SkipUnlessUpdated>', ["SUCCESS", "FAILURE", "SUCCESS"]),
        ('<WaitValueUpdate entry="{n}"><Wait/></WaitValueUpdate>', ["SUCCESS", "RUNNING", "SUCCESS"]),
    ],
)
def test_writes_to_an_entry_are_noticed_once(inside, states):
    robot = ScriptedRobot()
    tree = build(robot, inside, n=1)
    assert [robot.run(tree), robot.run(tree)] == states[:2]
    tree.blackboard.set("n", 1)
    assert robot.run(tree) == states[2]
