"""What an updater publishes, and when."""

import time
from collections.abc import Iterator

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from diagnostic_updater import (
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    FrequencyStatusParam,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatusParam,
    TopicDiagnostic,
    Updater,
)
from diagnostic_updater import example as example
from geometry_msgs.msg import PointStamped
from rclpy.clock_type import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.time import Time

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
OFTEN = FrequencyStatusParam({"min": 1.0})


def warn(status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
    status.summary(WARN, "hot")
    return status


class Listener:
    """Collects what is published."""

    def __init__(self) -> None:
        self.node = rclpy.create_node("listener")
        self.arrays: list[DiagnosticArray] = []
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self.arrays.append, QoSProfile(depth=100))
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)

    def hear(self) -> list[DiagnosticArray]:
        """Everything since the last time."""
        for _ in range(20):
            self.executor.spin_once(timeout_sec=0.0)
        received, self.arrays[:] = list(self.arrays), []
        return received

    def statuses(self) -> list[tuple[str, bytes, str]]:
        """The same in short."""
        return [(one.name, one.level, one.message) for array in self.hear() for one in array.status]


@pytest.fixture
def listener(graph: object) -> Iterator[Listener]:
    listener = Listener()
    yield listener
    listener.node.destroy_node()


def test_a_new_task_is_announced(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    updater.add(Heartbeat())
    updater.add("oven", warn)
    assert listener.statuses() == [
        ("tested: Heartbeat", OK, "Node starting up"),
        ("tested: oven", OK, "Node starting up"),
    ]


def test_an_update_holds_all_tasks(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    updater.setHardwareID("oven 7")
    updater.add(Heartbeat())
    updater.add("oven", warn)
    updater.add("idle", lambda status: status)
    listener.hear()
    before = node.get_clock().now()
    for update in (updater.update, updater.force_update):
        update()
        (array,) = listener.hear()
        assert [(one.name, one.level, one.message) for one in array.status] == [
            ("tested: Heartbeat", OK, "Alive"),
            ("tested: oven", WARN, "hot"),
            ("tested: idle", ERROR, "No message was set"),
        ]
        assert {one.hardware_id for one in array.status} == {"oven 7"}
        assert Time.from_msg(array.header.stamp) >= before
    assert updater.removeByName("oven")
    updater.update()
    assert len(listener.statuses()) == 2


def test_a_broadcast_speaks_for_all_tasks(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    updater.add(Heartbeat())
    updater.add("oven", warn)
    listener.hear()
    updater.broadcast(ERROR, "stopping")
    assert listener.statuses() == [("tested: Heartbeat", ERROR, "stopping"), ("tested: oven", ERROR, "stopping")]


def test_publishing_by_hand_changes_nothing(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    status = DiagnosticStatusWrapper(name="mine")
    updater.publish(status)
    updater.publish([status, status])
    assert [name for name, *_ in listener.statuses()] == ["tested: mine"] * 3
    assert status.name == "mine"


def test_updates_come_by_themselves(node: Node, listener: Listener) -> None:
    updater = Updater(node, period=0.01)
    updater.add(Heartbeat())
    listener.hear()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    for _ in range(3):
        executor.spin_once(timeout_sec=5.0)
    assert listener.statuses() == [("tested: Heartbeat", OK, "Alive")] * 3
    assert updater.period == 0.01


def test_the_period_can_be_changed(node: Node) -> None:
    updater = Updater(node)
    assert updater.period == node.get_parameter("diagnostic_updater.period").value == 1.0
    updater.period = 0.5
    assert updater.timer.timer_period_ns == 500_000_000
    node.set_parameters([Parameter("diagnostic_updater.period", value=0.25)])
    assert updater.period == 0.25
    assert updater.timer.timer_period_ns == 250_000_000
    assert list(node.timers) == [updater.timer]


def test_parameters_of_the_node(graph: object, listener: Listener) -> None:
    overrides = [
        Parameter("diagnostic_updater.period", value=3.0),
        Parameter("diagnostic_updater.use_fqn", value=True),
    ]
    node = rclpy.create_node("oven", namespace="/kitchen", parameter_overrides=overrides)
    for _ in range(2):  # a second one finds the parameters declared
        updater = Updater(node, period=1.0)
        assert updater.period == 3.0
    updater.add(Heartbeat())
    assert [name for name, *_ in listener.statuses()] == ["/kitchen/oven: Heartbeat"]
    node.destroy_node()


def test_a_missing_hardware_id_is_told_once(node: Node, capfd: pytest.CaptureFixture[str]) -> None:
    updater = Updater(node)
    updater.add("oven", warn)
    updater.update()
    assert "hardware ID" not in capfd.readouterr().err
    updater.removeByName("oven")
    updater.add(Heartbeat())
    for _ in range(3):
        updater.update()
    assert capfd.readouterr().err.count("no hardware ID was set") == 1


def test_verbose_updaters_log_what_is_wrong(node: Node, capfd: pytest.CaptureFixture[str]) -> None:
    updater = Updater(node)
    updater.verbose = True
    updater.add("oven", warn)
    updater.add(Heartbeat())
    updater.update()
    shown = capfd.readouterr().err
    assert "Name: oven, status 1: hot" in shown
    assert "Heartbeat" not in shown


def test_a_task_may_add_and_remove_tasks(node: Node, listener: Listener) -> None:
    updater = Updater(node)

    def once(status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        updater.removeByName("once")
        updater.add(Heartbeat())
        return status

    updater.add("once", once)
    updater.update()
    listener.hear()
    updater.update()
    assert listener.statuses() == [("tested: Heartbeat", OK, "Alive")]


# Topics


def test_a_topic_without_stamps(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    topic = HeaderlessTopicDiagnostic("scan", updater, OFTEN)
    listener.hear()
    updater.update()
    assert listener.statuses() == [("tested: scan topic status", ERROR, "No events recorded.")]
    topic.tick()
    updater.update()
    assert listener.statuses() == [("tested: scan topic status", OK, "Desired frequency met")]
    topic.clear_window()
    updater.update()
    assert listener.statuses()[0][1] == ERROR


def test_a_topic_with_stamps(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    topic = TopicDiagnostic("scan", updater, OFTEN, TimeStampStatusParam(-1, 5))
    listener.hear()
    topic.tick(node.get_clock().now())
    updater.update()
    assert listener.statuses()[0][1:] == (OK, "Desired frequency met; Timestamps are reasonable.")
    topic.tick(time.time() - 60.0)
    updater.update()
    assert listener.statuses()[0][1:] == (ERROR, "Timestamps too far in past seen.")


def test_a_publisher_that_is_watched(node: Node, listener: Listener) -> None:
    updater = Updater(node)
    publisher = node.create_publisher(PointStamped, "points", 10)
    received: list[PointStamped] = []
    listener.node.create_subscription(PointStamped, "points", received.append, 10)
    watched = DiagnosedPublisher(publisher, updater, OFTEN, TimeStampStatusParam())
    listener.hear()
    message = PointStamped()
    message.header.stamp = node.get_clock().now().to_msg()
    watched.publish(message)
    updater.update()
    assert listener.statuses() == [
        ("tested: /points topic status", OK, "Desired frequency met; Timestamps are reasonable.")
    ]
    assert received == [message]
    assert watched.publisher is publisher


def test_simulated_time_counts(node: Node, listener: Listener) -> None:
    node.set_parameters([Parameter("use_sim_time", value=True)])
    clock = node.get_clock()

    def set_time(seconds: float) -> None:
        clock.set_ros_time_override(Time(nanoseconds=round(seconds * 1e9), clock_type=ClockType.ROS_TIME))

    set_time(100.0)
    updater = Updater(node)
    topic = TopicDiagnostic("scan", updater, FrequencyStatusParam({"min": 10.0, "max": 10.0}), TimeStampStatusParam())
    listener.hear()
    for _ in range(100):
        topic.tick(clock.now())
    set_time(110.0)
    topic.tick(clock.now())
    updater.update()
    (array,) = listener.hear()
    told = {one.key: one.value for one in array.status[0].values}
    assert told["Actual frequency (Hz)"] == "10.100000"
    assert told["Latest timestamp delay:"] == "0.000000"
    assert array.header.stamp.sec == 110


# The example


def test_the_example_s_tasks() -> None:
    status = DiagnosticStatusWrapper()
    assert example.dummy_diagnostic(status).level == ERROR
    assert example.DummyClass().produce_diagnostics(status).level == WARN
    assert example.DummyTask().run(status).level == WARN
    assert example.check_lower_bound(status).message == "Too low"
    assert example.check_upper_bound(status).message == "Upper-bound OK"
