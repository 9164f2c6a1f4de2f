"""Behaviours with topics, actions and transforms, and trees that show themselves."""

import operator
import threading

import py_trees
import py_trees_ros
import pytest
import rclpy
from geometry_msgs.msg import Transform
from py_trees.blackboard import Blackboard
from py_trees.common import Status
from py_trees_ros.trees import BehaviourTree, SnapshotStream, Watcher, tree_of
from py_trees_ros_interfaces.msg import BehaviourTree as BehaviourTreeMessage
from py_trees_ros_interfaces.srv import OpenBlackboardStream, OpenSnapshotStream
from rclpy.action import ActionServer, GoalResponse
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Empty, Int32, String
from test_msgs.action import Fibonacci

from ros.graph import spinning

PROFILE = py_trees_ros.utilities.qos_profile_unlatched()


def tree_with(root, node, ticks=0):
    tree = BehaviourTree(root)
    tree.setup(node=node)
    for _ in range(ticks):
        tree.tick()
    return tree


def ticked(root, node, until=Status.SUCCESS, timeout_s=10.0):
    """Tick by a timer of the node until a behaviour is in a state; return its state."""
    tree = tree_with(root, node)
    reached = threading.Event()
    tree.tick_tock(10.0, post_tick_handler=lambda _: reached.set() if root.status == until else None)
    with spinning(node):
        reached.wait(timeout_s)
        tree.timer.cancel()
    return until if reached.is_set() else root.status


@pytest.fixture
def latched(node):
    """Publish a message that late subscriptions get."""

    def publish(topic, message):
        node.create_publisher(type(message), topic, py_trees_ros.utilities.qos_profile_latched()).publish(message)
        return py_trees_ros.utilities.qos_profile_latched()

    return publish


def test_messages_are_awaited_compared_and_stored(node, latched):
    profile = latched("/level", Int32(data=7))
    kept = {"clearing_policy": py_trees.common.ClearingPolicy.NEVER}
    wait = py_trees_ros.subscribers.WaitForData("wait", "/level", Int32, profile, **kept)
    assert ticked(wait, node) == Status.SUCCESS
    check = py_trees_ros.subscribers.CheckData("check", "/level", Int32, profile, "data", 5, operator.gt, **kept)
    assert ticked(check, node) == Status.SUCCESS
    wrong = py_trees_ros.subscribers.CheckData("wrong", "/level", Int32, profile, "dta", 5, **kept)
    assert ticked(wrong, node, Status.FAILURE) == Status.FAILURE
    store = py_trees_ros.subscribers.ToBlackboard(
        "store", "/level", Int32, profile, {"level": None, "number": "data"}, {"level": Int32(data=1)}, **kept
    )
    assert Blackboard.get("/level").data == 1
    assert ticked(store, node) == Status.SUCCESS
    assert (Blackboard.get("/level").data, Blackboard.get("/number")) == (7, 7)


def test_an_event_is_stored_once(node):
    event = py_trees_ros.subscribers.EventToBlackboard("event", "/stop", PROFILE, "stop")
    tree = tree_with(event, node, ticks=1)
    assert Blackboard.get("/stop") is False
    event._callback(Empty())
    tree.tick()
    assert Blackboard.get("/stop") is True
    tree.tick()
    assert Blackboard.get("/stop") is False


def test_a_battery_is_low_until_it_is_well_above_the_threshold(node):
    watch = py_trees_ros.battery.ToBlackboard("battery", "/battery", PROFILE, threshold=30.0)
    tree = tree_with(watch, node)
    for charge, low in ((0.5, False), (0.2, True), (0.32, True), (0.36, False)):
        watch._callback(BatteryState(percentage=charge))
        tree.tick()
        assert Blackboard.get("/battery_low_warning") is low


def test_a_variable_is_published(node):
    publish = py_trees_ros.publishers.FromBlackboard("publish", "/words", String, PROFILE, "words")
    tree = tree_with(publish, node, ticks=1)
    assert publish.status == Status.FAILURE
    Blackboard.set("words", String(data="hello"))
    tree.tick()
    assert publish.status == Status.SUCCESS
    Blackboard.set("words", 5)
    with pytest.raises(TypeError, match="not the required type"):
        tree.tick()


def test_a_transform_goes_through_the_blackboard(node):
    Blackboard.set("there", Transform())
    root = py_trees.composites.Sequence("both", memory=False)
    profile = py_trees_ros.utilities.qos_profile_latched()
    root.add_child(py_trees_ros.transforms.FromBlackboard("out", "there", "map", "base", False, profile))
    root.add_child(py_trees_ros.transforms.ToBlackboard("in", "back", "map", "base", profile))
    assert ticked(root, node) == Status.SUCCESS
    assert Blackboard.get("/back").child_frame_id == "base"
    with pytest.raises(TypeError, match="ON_SUCCESS"):
        py_trees_ros.transforms.ToBlackboard(
            "in", "x", "a", "b", PROFILE, clearing_policy=py_trees.common.ClearingPolicy.ON_SUCCESS
        )


def test_an_action_succeeds_is_rejected_and_has_no_goal(node):
    def execute(goal):
        goal.succeed()
        return Fibonacci.Result(sequence=[1])

    server = ActionServer(
        node,
        Fibonacci,
        "/count",
        execute,
        goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order else GoalResponse.REJECT,
    )
    client = py_trees_ros.action_clients
    good = client.FromConstant("good", Fibonacci, "/count", Fibonacci.Goal(order=1))
    assert ticked(good, node) == Status.SUCCESS
    assert (good.result_status_string, list(good.result_message.result.sequence)) == ("STATUS_SUCCEEDED", [1])
    bad = client.FromConstant("bad", Fibonacci, "/count", Fibonacci.Goal())
    assert ticked(bad, node, Status.FAILURE) == Status.FAILURE
    assert bad.feedback_message == "goal rejected"
    none = client.FromBlackboard("none", Fibonacci, "/count", "goal")
    assert ticked(none, node, Status.FAILURE) == Status.FAILURE
    lost = client.FromConstant("lost", Fibonacci, "/nowhere", Fibonacci.Goal(), wait_for_server_timeout_sec=0.05)
    with pytest.raises(py_trees_ros.exceptions.TimedOutError):
        tree_with(lost, node)
    server.destroy()


def tree():
    root = py_trees.composites.Selector("root", memory=False)
    root.add_child(py_trees.decorators.Inverter("not", py_trees.behaviours.Success("yes")))
    root.add_child(py_trees.behaviours.Running("run"))
    return root


def test_a_tree_shows_itself(node):
    shown = []
    node.create_subscription(BehaviourTreeMessage, "/tested/snapshots", shown.append, 10)
    shown_tree = tree_with(tree(), node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    node.set_parameters([Parameter("default_snapshot_stream", value=True)])
    shown_tree.tick()
    while not shown:
        executor.spin_once(timeout_sec=0.1)
    root, visited = tree_of(shown[0])
    assert [one.name for one in root.iterate()] == ["yes", "not", "run", "root"]
    assert root.status == Status.RUNNING
    assert len(visited) == 4
    text = Watcher(statistics=True).text(shown[0])
    assert "run [*]" in text
    assert "Count: 0" in text
    node.set_parameters([Parameter("default_snapshot_stream", value=False)])
    assert shown_tree.snapshot_streams == {}
    executor.shutdown()


def test_streams_are_opened_and_closed_by_services(node):
    owner = tree_with(tree(), node)
    request = OpenSnapshotStream.Request(topic_name="mine")
    request.parameters.blackboard_activity = True
    opened = owner._open_snapshot_stream(request, OpenSnapshotStream.Response())
    assert opened.topic_name == "/tested/snapshot_streams/mine"
    assert Blackboard.activity_stream is not None
    assert owner._close_stream(opened.topic_name)
    assert Blackboard.activity_stream is None
    exchange = owner.blackboard_exchange
    topic = exchange._open(OpenBlackboardStream.Request(variables=["a"]), OpenBlackboardStream.Response()).topic
    (view,) = exchange.views
    Blackboard.set("a", 1)
    view.publish_if_changed(())
    assert view.sub_blackboard.is_changed
    view.publish_if_changed(())
    assert not view.sub_blackboard.is_changed
    assert topic.startswith("/tested/blackboard_streams/")


@pytest.mark.parametrize(("hint", "full"), [("~/a", "/tested/a"), ("a", "/tested/snapshot_streams/a"), ("/a", "/a")])
def test_names_of_streams(node, hint, full):
    assert SnapshotStream.expand_topic_name(node, hint) == full


def test_a_tree_ticks_by_a_timer(graph):
    count = py_trees.behaviours.StatusQueue("count", [Status.RUNNING] * 3, eventually=Status.SUCCESS)
    owner = BehaviourTree(count)
    owner.setup(node_name="ticking")
    owner.tick_tock(period_ms=5.0, number_of_iterations=4)
    executor = SingleThreadedExecutor()
    executor.add_node(owner.node)
    while owner.tick_tock_count < 4:
        executor.spin_once(timeout_sec=0.1)
    assert count.status == Status.SUCCESS
    assert owner.statistics.count == 3
    executor.shutdown()
    owner.shutdown()
    assert rclpy.ok()
    with pytest.raises(TypeError, match="invalid node"):
        BehaviourTree(count).setup(node="tree")
