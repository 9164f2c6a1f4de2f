"""Nodes that find and track routes, and turn them into goals."""

from geometry_msgs.msg import Point
from nav2_msgs.msg import Route, RouteNode

from daidalos.navigation.trees.action.dock import DockRobot
from daidalos.navigation.trees.action.route import ComputeAndTrackRoute, ComputeRoute

from .robots import FAILURE, SUCCESS, ScriptedRobot, stamped
from .test_nodes import build
from .test_pose_nodes import xs

ROUTE = Route(nodes=[RouteNode(nodeid=i, position=Point(x=float(i))) for i in range(4)])


def test_nodes_of_a_route_become_goals_of_which_the_next_are_taken():
    robot = ScriptedRobot()
    tree = build(
        robot,
        """<Sequence>
            <ExtractRouteNodesAsGoals route="{route}" goals="{goals}"/>
            <AppendGoalPoseToGoals input_goals="{goals}" output_goals="{goals}" goal_pose="{goal}"/>
            <GetNextFewGoals input_goals="{goals}" num_goals="2" output_goals="{next}"/>
        </Sequence>""",
        route=ROUTE,
        goal=stamped(9.0),
    )
    assert robot.run(tree) == "SUCCESS"
    assert xs(tree.blackboard.get("goals")) == [0.0, 1.0, 2.0, 3.0, 9.0]
    assert xs(tree.blackboard.get("next")) == [0.0, 1.0]
    assert robot.run(build(robot, '<ExtractRouteNodesAsGoals route="{route}"/>', route=Route())) == "FAILURE"
    assert robot.run(build(robot, '<GetNextFewGoals input_goals="{goals}" num_goals="2"/>', goals=[])) == "FAILURE"


def test_errors_of_routes_that_a_recovery_may_resolve():
    robot = ScriptedRobot()
    for code, helps in (("NO_VALID_ROUTE", "SUCCESS"), ("NO_VALID_GRAPH", "FAILURE"), ("TIMEOUT", "SUCCESS")):
        assert robot.run(build(robot, f'<WouldARouteRecoveryHelp error_code="{code}"/>')) == helps


def test_requests_for_routes_and_docks():
    robot = ScriptedRobot(ComputeRoute=[(0, SUCCESS)], DockRobot=[(0, FAILURE)])
    assert robot.run(build(robot, '<ComputeRoute start_id="3" goal_id="4"/>')) == "SUCCESS"
    assert ComputeRoute.goal(robot.goals["ComputeRoute"]) == {
        "start_id": 3, "goal_id": 4, "use_start": False, "use_poses": False
    }  # fmt: skip
    assert robot.run(build(robot, '<DockRobot dock_id="home"/>')) == "FAILURE"
    assert DockRobot.goal(robot.goals["DockRobot"])["dock_id"] == "home"


def test_feedback_of_tracking_is_output_while_it_runs():
    robot = ScriptedRobot(ComputeAndTrackRoute=[(1, SUCCESS)])
    robot.feedback = {"current_edge_id": 12, "route": ROUTE}
    tree = build(robot, '<ComputeAndTrackRoute start_id="0" goal_id="3" current_edge_id="{edge}" route="{route}"/>')
    tree.tick()
    assert tree.blackboard.get("edge") == 12
    assert tree.blackboard.get("route") is ROUTE
    assert ComputeAndTrackRoute.outputs(ROUTE) == {}
