"""Files: what is read, what is refused and with which words, and the default tree as a whole."""

import numpy as np
import pytest

from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.services import Outcome

from .robots import FAILURE, SUCCESS, ScriptedRobot, document

ROBOT = ScriptedRobot()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<root><BehaviorTree>", r"tree:1: not well-formed"),
        ("<tree/>", r"tree:1: the outermost element must be <root>, not <tree>"),
        ("<root/>", r"tree:1: there is no <BehaviorTree>"),
        (document("<Wiat/>"), r"tree:1: '<Wiat>': there is no tree node 'Wiat'; did you mean 'Wait'\?"),
        (document('\n\n<Wait duration="3"/>'), r"tree:3: <Wait>: there is no port 'duration'; the ports are: wait_dur"),
        (document('<Wait wait_duration="long"/>'), r"'wait_duration' must be a float, not 'long'"),
        (document('<Spin is_recovery="maybe"/>'), r"'is_recovery' must be a flag, not 'maybe'"),
        (document('<FollowPath path="here"/>'), r"'path' must be a name in braces, not 'here'"),
        (document('<FollowPath path="{p}" error_msg="words"/>'), r"output 'error_msg' must be a name in braces"),
        (document("<FollowPath/>"), r"<FollowPath>: the port 'path' is missing"),
        (document("<RecoveryNode><Wait/></RecoveryNode>"), r"<RecoveryNode>: it must have 2 children, not 1"),
        (document("<Sequence/>"), r"<Sequence>: it must have at least 1 children, not 0"),
        (document("<Wait/><Wait/>"), r"the tree 'Main' must have one root, not 2"),
        (document('<SubTree ID="Maine"/>'), r"there is no tree 'Maine'; did you mean 'Main'\?"),
        (document('<SubTree ID="Main"/>'), r"the tree 'Main' contains itself"),
        (document("<Wait/>", main_tree_to_execute="Other"), r"there is no tree 'Other'; the trees are: Main"),
        (document('<RateController hz="0"><Wait/></RateController>'), r"hz must be greater than 0, not 0\.0"),
    ],
)
def test_mistakes_are_named_with_their_place(text, words):
    with pytest.raises(TreeError, match=words):
        BehaviorTree.parse(text, ROBOT)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(TreeError, match=r"none\.xml: cannot be read"):
        BehaviorTree.load(tmp_path / "none.xml", ROBOT)


def test_explicit_elements_of_version_3():
    robot = ScriptedRobot()
    inside = '<Control ID="RecoveryNode" name="try"><Action ID="Wait" wait_duration="2"/><Action ID="Spin"/></Control>'
    tree = BehaviorTree.parse(
        f'<root main_tree_to_execute="A"><BehaviorTree ID="A">{inside}</BehaviorTree></root>', robot
    )
    assert robot.run(tree) == "SUCCESS"
    assert robot.goals["Wait"] == {"wait_duration": 2.0}
    assert tree.root.name == "try"


def test_a_subtree_sees_only_what_it_is_given():
    inner = '<BehaviorTree ID="Inner"><Wait wait_duration="{time}"/></BehaviorTree>'
    for given, seen in (('time="{outer}"', 7.0), ('time="3"', 3.0), ("", 1.0), ('_autoremap="true"', 5.0)):
        robot = ScriptedRobot()
        text = document(f'<SubTree ID="Inner" {given}/>', main_tree_to_execute="Main").replace(
            "</root>", inner + "</root>"
        )
        board = Blackboard()
        board.set("outer", 7.0)
        board.set("time", 5.0)
        robot.run(BehaviorTree.parse(text, robot, board))
        assert robot.goals["Wait"] == {"wait_duration": seen}


def test_a_subtree_writes_through_its_remapped_names():
    inner = '<BehaviorTree ID="Inner"><ComputePathToPose goal="{goal}" path="{way}"/></BehaviorTree>'
    robot = ScriptedRobot(ComputePathToPose=[(0, Outcome(True, {"path": "found"}))])
    text = document('<SubTree ID="Inner" goal="{goal}" way="{path}"/>', main_tree_to_execute="Main")
    board = Blackboard()
    board.set("goal", "there")
    robot.run(BehaviorTree.parse(text.replace("</root>", inner + "</root>"), robot, board))
    assert board.get("path") == "found"
    assert "way" not in board


def test_trees_of_included_files(tmp_path):
    (tmp_path / "inner.xml").write_text('<root><BehaviorTree ID="Inner"><Wait/></BehaviorTree></root>')
    outer = tmp_path / "outer.xml"
    outer.write_text(
        '<root main_tree_to_execute="Main"><include path="inner.xml"/>'
        '<BehaviorTree ID="Main"><SubTree ID="Inner"/></BehaviorTree></root>'
    )
    robot = ScriptedRobot()
    assert robot.run(BehaviorTree.load(outer, robot)) == "SUCCESS"
    outer.write_text('<root><include path="nowhere.xml"/><BehaviorTree><Wait/></BehaviorTree></root>')
    with pytest.raises(TreeError, match=r"outer\.xml:1: the included file .*nowhere\.xml does not exist"):
        BehaviorTree.load(outer, robot)


def test_a_tree_draws_itself():
    tree = BehaviorTree.parse(document('<Sequence name="all"><Wait name="rest"/></Sequence>'), ROBOT)
    assert "all" in tree.to_text()
    assert "rest" in tree.to_text()


class TestDefaultTree:
    """The tree that drives to a pose."""

    def tree(self, robot):
        board = Blackboard()
        board.set("goal", np.zeros(3))
        return BehaviorTree.load(DEFAULT_TREE, robot, board)

    def robot(self, **scripts):
        planned = Outcome(True, {"path": np.zeros((2, 3))})
        return ScriptedRobot(**{"ComputePathToPose": [(0, planned)], **scripts})

    def test_it_plans_once_a_second_and_succeeds_with_following(self):
        robot = self.robot(FollowPath=[(34, SUCCESS)])
        assert robot.run(self.tree(robot), 99) == "SUCCESS"
        assert robot.log == ["ComputePathToPose", "FollowPath", *["ComputePathToPose"] * 3]

    def test_a_goal_in_a_wall_ends_it_at_once(self):
        occupied = Outcome(False, {}, "GOAL_OCCUPIED", "the goal is in an obstacle")
        robot = self.robot(ComputePathToPose=[(0, occupied)])
        tree = self.tree(robot)
        assert robot.run(tree, 99) == "FAILURE"
        assert robot.log == ["ComputePathToPose"]
        assert tree.blackboard.get("compute_path_error_msg") == "the goal is in an obstacle"

    def test_what_fails_is_tried_again_after_clearing(self):
        robot = self.robot(FollowPath=[(0, FAILURE), (0, SUCCESS)])
        assert robot.run(self.tree(robot), 99) == "SUCCESS"
        assert robot.log == ["ComputePathToPose", "FollowPath", "ClearEntireCostmap", "FollowPath"]
        assert robot.goals["ClearEntireCostmap"]["service_name"] == "local_costmap/clear_entirely_local_costmap"

    def test_recoveries_take_turns_six_times(self):
        robot = self.robot(FollowPath=[(0, FAILURE)], Wait=[(3, SUCCESS)])
        assert robot.run(self.tree(robot), 999) == "FAILURE"
        motions = [name for name in robot.log if name in ("Spin", "Wait", "BackUp")]
        assert motions == ["Spin", "Wait", "BackUp", "Spin"]
        assert robot.log.count("FollowPath") == 2 * 7

    def test_a_new_goal_ends_a_recovery(self):
        robot = self.robot(FollowPath=[(0, FAILURE)] * 4 + [(500, SUCCESS)], Spin=[(500, SUCCESS)])
        tree = self.tree(robot)
        robot.run(tree, 20)
        assert robot.log[-1] == "Spin"
        tree.blackboard.set("goal", np.ones(3))
        assert robot.run(tree, 2) == "RUNNING"
        assert robot.log[-3:] == ["halt Spin", "ComputePathToPose", "FollowPath"]

    def test_halting_stops_the_robot(self):
        robot = self.robot(FollowPath=[(500, SUCCESS)])
        tree = self.tree(robot)
        robot.run(tree, 5)
        tree.halt()
        assert robot.log[-1] == "halt FollowPath"
