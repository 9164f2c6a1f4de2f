"""Messages put into the order of their stamps."""

import pytest
from message_filters import InputAligner, SimpleFilter, TimeSequencer
from message_filters.input_aligner import QueueStatus
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from std_msgs.msg import String

from ros.message_filters.messages import Made, Output, at, real

# One input


class Stage:
    """A sequencer in simulated time."""

    def __init__(self, node: Node, queue_size: int = 10) -> None:
        node.set_parameters([Parameter("use_sim_time", value=True)])
        self.node = node
        self.source = SimpleFilter()
        self.set(100.0)
        self.sequencer = TimeSequencer(self.source, Duration(seconds=1), Duration(seconds=0.1), queue_size, node)
        self.output = Output(self.sequencer)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(node)

    def set(self, seconds: float) -> None:
        self.node.get_clock().set_ros_time_override(
            Time(nanoseconds=round(seconds * 1e9), clock_type=ClockType.ROS_TIME)
        )

    def run_until(self, seconds: float) -> list[object]:
        self.set(seconds)
        self.executor.spin_once(timeout_sec=0.0)
        return [message.data for (message,) in self.output.calls]


def test_messages_wait_and_are_sorted(node: Node) -> None:
    stage = Stage(node)
    for time in (100.3, 100.1, 100.2):
        stage.source.signalMessage(at(time, time))
    assert stage.run_until(101.05) == []
    assert stage.run_until(101.15) == [100.1]
    assert stage.run_until(101.9) == [100.1, 100.2, 100.3]


def test_what_comes_too_late_is_dropped(node: Node) -> None:
    stage = Stage(node)
    stage.source.signalMessage(at(100.2, "on time"))
    assert stage.run_until(101.5) == ["on time"]
    stage.source.signalMessage(at(100.1, "too late"))
    stage.source.signalMessage(at(100.2, "of the same time"))
    assert stage.run_until(103.0) == ["on time", "of the same time"]


def test_the_oldest_is_dropped_when_there_are_too_many(node: Node) -> None:
    stage = Stage(node, queue_size=2)
    for time in (100.3, 100.1, 100.2):
        stage.source.signalMessage(at(time, time))
    assert stage.run_until(102.0) == [100.2, 100.3]


def test_nothing_is_looked_for_when_nothing_waits(node: Node) -> None:
    stage = Stage(node)
    assert stage.sequencer._timer.is_canceled()
    stage.source.signalMessage(at(100.2))
    assert not stage.sequencer._timer.is_canceled()
    stage.run_until(105.0)
    assert stage.sequencer._timer.is_canceled()


def test_a_sequence_needs_stamps(node: Node) -> None:
    with pytest.raises(ValueError, match="a String has no stamp to sort by"):
        Stage(node).source.signalMessage(String())


# Several inputs


class Aligned:
    """An aligner of two inputs, and what comes out of it."""

    def __init__(self, timeout: float = 10.0) -> None:
        self.inputs = [SimpleFilter(), SimpleFilter()]
        self.aligner = InputAligner(Duration(seconds=timeout), *self.inputs)
        self.seen: list[object] = []
        for index in range(2):
            self.aligner.registerCallback(
                index, lambda message, number: self.seen.append((number, message.data)), index
            )

    def send(self, index: int, *times: float) -> None:
        for time in times:
            self.inputs[index].signalMessage(at(time, time))

    def dispatch(self) -> list[object]:
        self.aligner.dispatchMessages()
        return self.seen


def test_inputs_are_interleaved() -> None:
    aligned = Aligned()
    aligned.send(0, 1, 4, 5)
    aligned.send(1, 3, 2)
    # Input 1 has nothing beyond 3 and is expected to go on there, so what is newer waits.
    assert aligned.dispatch() == [(0, 1), (1, 2), (1, 3)]
    aligned.send(1, 6)
    assert aligned.dispatch() == [(0, 1), (1, 2), (1, 3), (0, 4), (0, 5)]
    assert aligned.aligner.getQueueStatus(0) == QueueStatus(True, 0, 3, 0)
    assert aligned.aligner.getQueueStatus(1) == QueueStatus(True, 1, 2, 0)


def test_a_known_period_saves_waiting() -> None:
    aligned = Aligned()
    aligned.aligner.setInputPeriod(1, Duration(seconds=5))
    aligned.send(0, 1, 2, 6)
    aligned.send(1, 1.5)
    assert aligned.dispatch() == [(0, 1), (1, 1.5), (0, 2), (0, 6)]


def test_an_input_that_never_spoke_is_not_waited_for() -> None:
    aligned = Aligned()
    aligned.send(0, 1, 2)
    assert aligned.dispatch() == [(0, 1), (0, 2)]
    assert not aligned.aligner.getQueueStatus(1).active


def test_an_input_that_fell_silent_is_given_up() -> None:
    aligned = Aligned(timeout=3.0)
    aligned.send(1, 1)
    aligned.send(0, 1.5, 3)
    assert aligned.dispatch() == [(1, 1)]
    aligned.send(0, 4)
    assert aligned.dispatch() == [(1, 1), (0, 1.5), (0, 3), (0, 4)]
    assert not aligned.aligner.getQueueStatus(1).active


def test_what_comes_after_its_turn_is_dropped() -> None:
    aligned = Aligned()
    aligned.send(0, 5)
    assert aligned.dispatch() == [(0, 5)]
    aligned.send(1, 4)
    assert aligned.dispatch() == [(0, 5)]
    assert aligned.aligner.getQueueStatus(1).msgs_dropped == 1


def test_messages_of_the_same_time_keep_their_order() -> None:
    aligned = Aligned()
    for data in ("a", "b", "c"):
        aligned.inputs[0].signalMessage(Made(Time(seconds=1), data))
    assert aligned.dispatch() == [(0, "a"), (0, "b"), (0, "c")]


def test_inputs_can_be_replaced() -> None:
    aligned = Aligned()
    other = SimpleFilter()
    aligned.aligner.connectInput(other)
    aligned.send(0, 1)
    output: list[object] = []
    aligned.aligner.registerCallback(0, output.append)
    other.signalMessage(real(2))
    aligned.aligner.dispatchMessages()
    assert output == [real(2)]
    assert aligned.seen == []
    aligned.aligner.setName("mine")
    assert aligned.aligner.getName() == "mine"
    with pytest.raises(ValueError, match="a String has no stamp to align by"):
        other.signalMessage(String())


def test_a_node_may_dispatch(node: Node) -> None:
    aligned = Aligned()
    aligned.aligner.setupDispatchTimer(node, Duration(seconds=0.001))
    aligned.send(0, 1)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_once(timeout_sec=5.0)
    assert aligned.seen == [(0, 1)]
