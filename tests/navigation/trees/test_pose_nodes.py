"""Nodes that look at poses, paths, goals, time and the battery."""

import math

import numpy as np
import pytest
from sensor_msgs.msg import BatteryState

from daidalos.navigation.trees.errors import TreeError

from .robots import FAILURE, SUCCESS, ScriptedRobot, path_of, stamped
from .test_nodes import build


def xs(poses):
    return [pose.pose.position.x for pose in poses]


def test_goals_that_were_passed_are_removed():
    robot = ScriptedRobot()
    tree = build(
        robot,
        '<RemovePassedGoals input_goals="{goals}" output_goals="{goals}" radius="0.7"/>',
        goals=[stamped(0.5), stamped(0.6), stamped(3.0), stamped(0.0)],
    )
    assert robot.run(tree) == "SUCCESS"
    assert xs(tree.blackboard.get("goals")) == [3.0, 0.0]
    robot.pose = np.array([2.9, 0.0, 0.0])
    robot.run(tree)
    robot.run(tree)
    assert xs(tree.blackboard.get("goals")) == [0.0]
    robot.pose = None
    assert robot.run(build(robot, '<RemovePassedGoals input_goals="{g}"/>', g=[stamped(1), stamped(2)])) == "FAILURE"


def test_the_robots_pose_and_a_pose_of_a_path_are_output():
    robot = ScriptedRobot()
    robot.pose = np.array([2.0, 1.0, 0.0])
    tree = build(robot, '<GetCurrentPose current_pose="{here}"/>')
    assert robot.run(tree) == "SUCCESS"
    assert xs([tree.blackboard.get("here")]) == [2.0]
    robot.pose = None
    assert robot.run(tree) == "FAILURE"
    for index, found in ((0, [1.0]), (-1, [3.0]), (3, None)):
        tree = build(
            robot, f'<GetPoseFromPath path="{{path}}" index="{index}" pose="{{pose}}"/>', path=path_of(1, 2, 3)
        )
        assert robot.run(tree) == ("FAILURE" if found is None else "SUCCESS")
        assert found is None or xs([tree.blackboard.get("pose")]) == found


def test_paths_are_cut_and_put_together():
    robot = ScriptedRobot()
    tree = build(
        robot, '<TruncatePath input_path="{path}" distance="1.0" output_path="{cut}"/>', path=path_of(*range(5))
    )
    assert robot.run(tree) == "SUCCESS"
    assert xs(tree.blackboard.get("cut").poses) == [0, 1, 2, 3]
    robot.pose = np.array([5.2, 0.0, 0.0])
    local = '<TruncatePathLocal input_path="{path}" distance_forward="2" distance_backward="1" output_path="{cut}"/>'
    tree = build(robot, local, path=path_of(*range(10)))
    assert robot.run(tree) == "SUCCESS"
    assert xs(tree.blackboard.get("cut").poses) == [4, 5, 6, 7]
    both = '<ConcatenatePaths input_path1="{a}" input_path2="{b}" output_path="{c}"/>'
    tree = build(robot, both, a=path_of(1, 2), b=path_of(3))
    assert robot.run(tree) == "SUCCESS"
    assert xs(tree.blackboard.get("c").poses) == [1, 2, 3]
    assert robot.run(build(robot, both)) == "FAILURE"


@pytest.mark.parametrize(("x", "end"), [(0.2, "SUCCESS"), (0.3, "FAILURE")])
def test_a_goal_is_reached_within_its_tolerance(x, end):
    robot = ScriptedRobot()
    assert robot.run(build(robot, '<GoalReached goal="{goal}"/>', goal=stamped(x))) == end
    near = '<ArePosesNear ref_pose="{a}" target_pose="{b}" tolerance="0.25"/>'
    assert robot.run(build(robot, near, a=stamped(0), b=stamped(x))) == end


def test_distance_and_time_are_measured_from_the_last_success():
    robot = ScriptedRobot()
    distance, time = build(robot, '<DistanceTraveled distance="1"/>'), build(robot, '<TimeExpired seconds="1"/>')
    ends = []
    for x in (0.0, 0.6, 1.2, 1.8, 2.4):
        robot.pose = np.array([x, 0.0, 0.0])
        robot.time = x
        ends.append((distance.tick().name, time.tick().name))
    assert [one[0] for one in ends] == ["FAILURE", "FAILURE", "SUCCESS", "FAILURE", "SUCCESS"]
    assert [one[1] for one in ends] == ["FAILURE", "FAILURE", "SUCCESS", "FAILURE", "SUCCESS"]


def test_a_path_expires_unless_another_one_comes():
    robot = ScriptedRobot()
    tree = build(robot, '<PathExpiringTimer seconds="1" path="{path}"/>', path=path_of(1))
    ends = []
    for time in (0.0, 0.9, 1.1, 2.0):
        robot.time = time
        if time == 0.9:
            tree.blackboard.set("path", path_of(2))
        ends.append(tree.tick().name)
    assert ends == ["FAILURE", "FAILURE", "FAILURE", "SUCCESS"]


def test_transforms_batteries_and_initial_poses_are_conditions():
    robot = ScriptedRobot()
    there = build(robot, '<TransformAvailable child="odom" parent="map"/>')
    assert there.tick().name == "FAILURE"
    robot.transforms = {("map", "odom")}
    assert there.tick().name == "SUCCESS"
    low, charging = build(robot, '<IsBatteryLow min_battery="0.2"/>'), build(robot, "<IsBatteryCharging/>")
    assert (low.tick().name, charging.tick().name) == ("FAILURE", "FAILURE")
    robot.heard["/battery_status"] = BatteryState(percentage=0.1, power_supply_status=1)
    assert (low.tick().name, charging.tick().name) == ("SUCCESS", "SUCCESS")
    volts = build(robot, '<IsBatteryLow min_battery="11" is_voltage="true"/>')
    robot.heard["/battery_status"] = BatteryState(percentage=0.1, voltage=12.0)
    assert (volts.tick().name, charging.tick().name) == ("FAILURE", "FAILURE")
    assert build(robot, "<InitialPoseReceived/>").tick().name == "FAILURE"
    assert build(robot, "<InitialPoseReceived/>", initial_pose_received=True).tick().name == "SUCCESS"


def test_a_goal_that_is_updated_globally_is_known_over_halts():
    robot = ScriptedRobot()
    tree = build(robot, "<GlobalUpdatedGoal/>", goal=stamped(1))
    assert tree.tick().name == "SUCCESS"
    assert tree.tick().name == "FAILURE"
    tree.halt()
    assert tree.tick().name == "FAILURE"
    tree.blackboard.set("goal", stamped(2))
    assert tree.tick().name == "SUCCESS"


def test_a_single_trigger_ticks_once():
    robot = ScriptedRobot(Wait=[(1, SUCCESS)])
    tree = build(robot, "<SingleTrigger><Wait/></SingleTrigger>")
    assert robot.run(tree, 5) == "SUCCESS"
    assert robot.run(tree, 5) == "FAILURE"
    tree.halt()
    assert robot.run(tree, 5) == "SUCCESS"
    assert robot.log.count("Wait") == 2


def test_a_child_is_ticked_by_the_distance_driven():
    robot = ScriptedRobot()
    tree = build(robot, '<DistanceController distance="1"><Wait/></DistanceController>')
    for x in np.arange(0.0, 2.2, 0.25):
        robot.pose = np.array([x, 0.0, 0.0])
        tree.tick()
    assert robot.log.count("Wait") == 3  # at 0, 1 and 2 m


def test_a_child_is_ticked_by_speed_and_for_a_new_goal():
    robot = ScriptedRobot()
    tree = build(
        robot,
        '<SpeedController min_rate="0.5" max_rate="2" min_speed="0" max_speed="1"><Wait/></SpeedController>',
        goal=stamped(1),
    )
    robot.run(tree)
    for _ in range(19):
        tree.tick()
        robot.time += 0.1
    assert robot.log.count("Wait") == 1
    robot.speed = 1.0
    for _ in range(11):
        tree.tick()
        robot.time += 0.1
    assert robot.log.count("Wait") == 4
    tree.blackboard.set("goal", stamped(2))
    tree.tick()
    assert robot.log.count("Wait") == 5


def test_speeds_that_cannot_be_are_refused():
    with pytest.raises(TreeError, match="above 0"):
        build(ScriptedRobot(), '<SpeedController min_rate="0"><Wait/></SpeedController>')


def test_a_goal_updated_controller_ticks_for_each_goal():
    robot = ScriptedRobot()
    tree = build(robot, "<GoalUpdatedController><Wait/></GoalUpdatedController>", goal=stamped(1))
    assert [tree.tick().name for _ in range(3)] == ["SUCCESS", "RUNNING", "RUNNING"]
    tree.blackboard.set("goal", stamped(2))
    assert tree.tick().name == "SUCCESS"
    assert robot.log == ["Wait", "Wait"]


def test_a_goal_updater_takes_newer_goals_only():
    robot = ScriptedRobot()
    tree = build(
        robot, '<GoalUpdater input_goal="{goal}" output_goal="{new}"><Wait/></GoalUpdater>', goal=stamped(1, sec=5)
    )
    for sec, expected in ((None, 1.0), (4, 1.0), (6, 2.0)):
        if sec is not None:
            robot.heard["goal_update"] = stamped(2, sec=sec)
        assert robot.run(tree) == "SUCCESS"
        assert xs([tree.blackboard.get("new")]) == [expected]


@pytest.mark.parametrize(
    ("first", "second", "waits"),
    [((0, 1, 2), (0, 5, 2), True), ((0, 1, 2), (0, 1, 3), False), ((0, 5), (0, 20, 5), False)],
)
def test_a_detour_shortly_before_the_goal_is_noticed(first, second, waits):
    robot = ScriptedRobot()
    tree = build(robot, '<PathLongerOnApproach path="{path}"><Wait/></PathLongerOnApproach>', path=path_of(*first))
    tree.tick()
    tree.blackboard.set("path", path_of(*second))
    tree.tick()
    assert robot.log == (["Wait"] if waits else [])


def test_children_are_ticked_again():
    robot = ScriptedRobot(Spin=[(0, FAILURE), (0, FAILURE), (0, SUCCESS)])
    tree = build(robot, '<RetryUntilSuccessful num_attempts="3"><Spin/></RetryUntilSuccessful>')
    assert robot.run(tree, 9) == "SUCCESS"
    robot = ScriptedRobot(Spin=[(0, FAILURE)])
    tree = build(robot, '<RetryUntilSuccessful num_attempts="3"><Spin/></RetryUntilSuccessful>')
    assert robot.run(tree, 9) == "FAILURE"
    assert robot.log.count("Spin") == 3
    tree = build(robot, '<Repeat num_cycles="4"><Wait/></Repeat>')
    assert robot.run(tree, 9) == "SUCCESS"
    assert robot.log.count("Wait") == 4
    robot = ScriptedRobot(Spin=[(0, SUCCESS), (0, SUCCESS), (0, FAILURE)])
    assert robot.run(build(robot, "<KeepRunningUntilFailure><Spin/></KeepRunningUntilFailure>"), 9) == "FAILURE"


def test_a_sequence_with_memory_goes_on_with_what_failed():
    robot = ScriptedRobot(Spin=[(0, FAILURE), (0, SUCCESS)])
    tree = build(robot, "<SequenceWithMemory><Wait/><Spin/><BackUp/></SequenceWithMemory>")
    assert robot.run(tree) == "FAILURE"
    assert robot.run(tree, 5) == "SUCCESS"
    assert robot.log == ["Wait", "Spin", "Spin", "BackUp"]
    robot.run(tree)
    assert robot.log[4:] == ["Wait", "Spin", "BackUp"]


def test_a_truncated_path_looks_along_its_last_step():
    path = path_of(0, 1, 2, 3)
    for pose in path.poses:
        pose.pose.orientation.w, pose.pose.orientation.z = 0.0, 1.0
    robot = ScriptedRobot()
    tree = build(robot, '<TruncatePath input_path="{path}" distance="1" output_path="{cut}"/>', path=path)
    robot.run(tree)
    q = tree.blackboard.get("cut").poses[-1].pose.orientation
    assert 2.0 * math.atan2(q.z, q.w) == pytest.approx(0.0)


def test_a_goal_is_nearby_where_little_of_the_path_is_left():
    robot = ScriptedRobot()
    tree = build(robot, '<IsGoalNearby path="{path}" proximity_threshold="1.5"/>', path=path_of(0, 1, 2, 3, 4))
    states = []
    for x in (0.0, 2.4, 2.6, 4.0):
        robot.pose = np.array([x, 0.3, 0.0])
        states.append(robot.run(tree))
    assert states == ["FAILURE", "FAILURE", "SUCCESS", "SUCCESS"]
    robot.pose = None
    assert robot.run(tree) == "FAILURE"
    assert robot.run(build(robot, '<IsGoalNearby path="{path}"/>', path=path_of())) == "FAILURE"


def test_a_path_that_comes_back_to_its_begin_is_searched_from_the_last_pose_on():
    robot = ScriptedRobot()
    inside = '<IsGoalNearby path="{path}" max_robot_pose_search_dist="1.5"/>'
    loop = path_of(0.1, 1, 2, 1, 0)
    tree = build(robot, inside, path=loop)
    states = []
    for x in (0.0, 1.0, 2.0, 1.0, 0.0):
        robot.pose = np.array([x, 0.0, 0.0])
        states.append(robot.run(tree))
    assert states == ["FAILURE", "FAILURE", "FAILURE", "FAILURE", "SUCCESS"]
