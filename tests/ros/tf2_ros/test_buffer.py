"""Waiting for transforms, in threads and in coroutines, by the wall clock and by a simulator's."""

import gc
import threading
import time
import weakref

import pytest
import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock as ClockMessage
from tf2_msgs.srv import FrameGraph
from tf2_ros import Buffer, ExtrapolationException, LookupException

from ros.graph import after, spinning
from ros.transforms import LATEST, SECOND, at, stamp, transform

LONG = Duration(seconds=30)


@pytest.fixture
def buffer() -> Buffer:
    return Buffer()


# Without waiting


def test_what_is_there_is_found_at_once(buffer: Buffer) -> None:
    sent = transform("a", "b", SECOND, (1.0, 0.0, 0.0))
    buffer.set_transform(sent, "me")
    assert buffer.can_transform("a", "b", at(1)) is True
    assert buffer.lookup_transform("a", "b", at(1), LONG) == sent
    assert buffer.lookup_transform_full("a", at(1), "b", at(1), "a", LONG) == sent
    assert buffer.can_transform_full("a", at(1), "b", at(1), "a", LONG) is True


def test_what_is_not_there_is_an_error_at_once(buffer: Buffer) -> None:
    assert buffer.can_transform("a", "b", LATEST) is False
    possible, reason = buffer.can_transform("a", "b", LATEST, return_debug_tuple=True)
    assert (possible, "frame does not exist" in reason) == (False, True)
    possible, reason = buffer.can_transform_full("a", LATEST, "b", LATEST, "c", return_debug_tuple=True)
    assert (possible, "frame does not exist" in reason) == (False, True)
    with pytest.raises(LookupException):
        buffer.lookup_transform("a", "b", LATEST)
    with pytest.raises(LookupException):
        buffer.lookup_transform_full("a", LATEST, "b", LATEST, "c")


# Waiting in a thread


def test_waiting_ends_with_the_transform(buffer: Buffer) -> None:
    sent = transform("a", "b", SECOND)
    after(0.1, lambda: buffer.set_transform(sent, "me"))
    start = time.monotonic()
    assert buffer.lookup_transform("a", "b", at(1), LONG) == sent
    assert 0.09 <= time.monotonic() - start < 5.0
    assert buffer._watchers == ()


def test_waiting_ends_with_a_static_transform(buffer: Buffer) -> None:
    after(0.05, lambda: buffer.set_transform_static(transform("a", "b"), "me"))
    assert buffer.can_transform("a", "b", at(1), LONG) is True


def test_waiting_for_two_times(buffer: Buffer) -> None:
    buffer.set_transform(transform("world", "car", SECOND), "me")
    buffer.set_transform_static(transform("world", "tree"), "me")
    after(0.05, lambda: buffer.set_transform(transform("world", "car", 2 * SECOND, (5.0, 0.0, 0.0)), "me"))
    found = buffer.lookup_transform_full("car", at(2), "tree", at(1), "world", LONG)
    assert found.transform.translation.x == -5.0


@pytest.mark.parametrize("timeout", [Duration(seconds=0.1), Duration(seconds=0.1).to_msg()])
def test_waiting_ends_when_the_time_is_over(buffer: Buffer, timeout: object) -> None:
    start = time.monotonic()
    assert buffer.can_transform("a", "b", LATEST, timeout) is False
    assert 0.1 <= time.monotonic() - start < 5.0
    assert buffer._watchers == ()


def test_data_that_does_not_help_does_not_prolong_the_wait(buffer: Buffer) -> None:
    stop = threading.Event()

    def chatter() -> None:
        count = 0
        while not stop.wait(0.001):
            count += 1
            buffer.set_transform(transform("a", "other", count), "me")

    thread = threading.Thread(target=chatter)
    thread.start()
    start = time.monotonic()
    assert buffer.can_transform("a", "b", LATEST, Duration(seconds=0.2)) is False
    assert 0.2 <= time.monotonic() - start < 5.0
    stop.set()
    thread.join()


@pytest.mark.slow
def test_waiting_costs_no_processor_time(buffer: Buffer) -> None:
    before = time.process_time()
    buffer.can_transform("a", "b", LATEST, Duration(seconds=0.5))
    assert time.process_time() - before < 0.05


def test_waiting_ends_at_the_shutdown(node: Node) -> None:
    buffer = Buffer(node=node)
    after(0.1, rclpy.shutdown)
    start = time.monotonic()
    assert buffer.can_transform("a", "b", LATEST, LONG) is False
    assert time.monotonic() - start < 10.0


def test_many_may_wait_for_different_things(buffer: Buffer) -> None:
    found: dict[int, object] = {}

    def wait(number: int) -> None:
        found[number] = buffer.lookup_transform("a", f"f{number}", LATEST, LONG)

    threads = [threading.Thread(target=wait, args=(number,)) for number in range(10)]
    for thread in threads:
        thread.start()
    for number in reversed(range(10)):
        buffer.set_transform(transform("a", f"f{number}", SECOND), "me")
    for thread in threads:
        thread.join(10.0)
    assert sorted(found) == list(range(10))


# Simulated time


@pytest.fixture
def simulated(node: Node) -> Node:
    node.set_parameters([Parameter("use_sim_time", value=True)])
    return node


class Simulator:
    """Publishes the time, from a node of its own as a simulator does."""

    def __init__(self) -> None:
        self.node = rclpy.create_node("simulator")
        self.publisher = self.node.create_publisher(ClockMessage, "/clock", 10)

    def set(self, seconds: float) -> None:
        self.publisher.publish(ClockMessage(clock=stamp(round(seconds * SECOND))))


def test_a_time_out_is_of_simulated_time(simulated: Node) -> None:
    simulator = Simulator()
    buffer = Buffer(node=simulated)
    simulator.set(100.0)
    results: list[object] = []
    start = time.monotonic()
    thread = threading.Thread(target=lambda: results.append(buffer.can_transform("a", "b", LATEST, LONG)))
    thread.start()
    while not buffer._watchers:
        time.sleep(0.001)
    simulator.set(129.0)
    thread.join(0.1)
    assert thread.is_alive()
    simulator.set(130.0)
    thread.join(10.0)
    assert results == [False]
    assert time.monotonic() - start < 10.0


def test_simulated_time_that_stands_still_does_not_keep_a_transform_away(simulated: Node) -> None:
    buffer = Buffer(node=simulated)
    after(0.1, lambda: buffer.set_transform(transform("a", "b", SECOND), "me"))
    assert buffer.can_transform("a", "b", at(1), Duration(seconds=0.001)) is True


def test_a_jump_back_clears_the_buffer_and_ends_waiting(simulated: Node) -> None:
    simulator = Simulator()
    buffer = Buffer(node=simulated)
    simulator.set(100.0)
    buffer.set_transform(transform("a", "b", 100 * SECOND), "me")
    buffer.set_transform_static(transform("b", "c"), "me")
    results: list[object] = []
    thread = threading.Thread(target=lambda: results.append(buffer.can_transform("a", "b", at(101), LONG)))
    thread.start()
    while not buffer._watchers:
        time.sleep(0.001)
    simulator.set(1.0)
    thread.join(10.0)
    assert results == [False]
    assert not buffer.can_transform("a", "b", at(100))
    assert buffer.can_transform("b", "c", at(100))
    buffer.set_transform(transform("a", "b", SECOND), "me")
    assert buffer.can_transform("a", "b", at(1))


def test_a_small_step_back_and_steps_forward_clear_nothing(simulated: Node) -> None:
    simulator = Simulator()
    buffer = Buffer(node=simulated)
    for now in (100.0, 99.5, 500.0):
        simulator.set(now)
        buffer.set_transform(transform("a", "b", 100 * SECOND), "me")
        assert buffer.can_transform("a", "b", at(100))


def test_turning_simulated_time_on_or_off_clears_the_buffer(node: Node) -> None:
    buffer = Buffer(node=node)
    for use in (True, False):
        buffer.set_transform(transform("a", "b", SECOND), "me")
        node.set_parameters([Parameter("use_sim_time", value=use)])
        assert not buffer.can_transform("a", "b", at(1))


@pytest.mark.slow
def test_a_buffer_does_not_live_as_long_as_the_clock(node: Node) -> None:
    jumps = node.get_clock().handle._jumps
    for _ in range(2):
        buffer = Buffer()
        buffer.follow(node)
        weak = weakref.ref(buffer)
        del buffer
        gc.collect()
        assert weak() is None
    assert len(node.get_clock().handle._jumps) <= len(jumps) + 1
    node.set_parameters([Parameter("use_sim_time", value=True)])


def test_without_a_node_the_system_clock_counts(buffer: Buffer) -> None:
    assert isinstance(buffer.clock, Clock)
    assert buffer.clock.clock_type == ClockType.SYSTEM_TIME
    assert Buffer(Duration(seconds=3)).get_cache_time() == Duration(seconds=3)


# Coroutines and futures


def test_a_coroutine_that_need_not_wait(buffer: Buffer) -> None:
    sent = transform("a", "b", SECOND)
    buffer.set_transform(sent, "me")
    for coroutine in (
        buffer.lookup_transform_async("a", "b", at(1)),
        buffer.lookup_transform_full_async("a", at(1), "b", at(1), "a"),
    ):
        with pytest.raises(StopIteration) as stop:
            coroutine.send(None)
        assert stop.value.value == sent


def test_a_coroutine_that_waits(buffer: Buffer) -> None:
    sent = transform("a", "b", SECOND)
    for coroutine in (
        buffer.lookup_transform_async("a", "b", at(1)),
        buffer.lookup_transform_full_async("a", at(1), "b", at(1), "a"),
    ):
        coroutine.send(None)
        buffer.set_transform(sent, "me")
        with pytest.raises(StopIteration) as stop:
            coroutine.send(None)
        assert stop.value.value == sent
        buffer.clear()


def test_a_future_is_done_by_the_data_that_completes_the_way(buffer: Buffer) -> None:
    buffer.set_transform(transform("a", "b", SECOND), "me")
    future = buffer.wait_for_transform_async("a", "c", at(1.5))
    full = buffer.wait_for_transform_full_async("a", at(1.5), "c", at(1.5), "a")
    buffer.set_transform_static(transform("b", "c"), "me")
    assert not future.done()
    assert not full.done()
    buffer.set_transform(transform("a", "b", 2 * SECOND, (2.0, 0.0, 0.0)), "me")
    assert future.done()
    assert full.done()
    assert future.result().transform.translation.x == 1.0
    assert full.result() == future.result()
    assert buffer._watchers == ()


def test_a_cancelled_future_is_forgotten(buffer: Buffer) -> None:
    future = buffer.wait_for_transform_async("a", "b", LATEST)
    future.cancel()
    assert buffer._watchers == ()
    buffer.set_transform(transform("a", "b", SECOND), "me")
    assert not future.done()


def test_a_future_of_nonsense_is_an_error_at_once(buffer: Buffer) -> None:
    with pytest.raises(TypeError):
        buffer.wait_for_transform_async("a", "b", "now")
    assert buffer._watchers == ()


def test_what_follows_a_future_runs_in_the_executor(node: Node) -> None:
    buffer = Buffer(node=node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threads: list[int] = []
    future = buffer.wait_for_transform_async("a", "b", LATEST)
    future.add_done_callback(lambda _: threads.append(threading.get_ident()))
    after(0.05, lambda: buffer.set_transform(transform("a", "b", SECOND), "me")).join()
    assert threads == []
    executor.spin_once(timeout_sec=5.0)
    assert threads == [threading.get_ident()]


def test_a_coroutine_in_an_executor(node: Node) -> None:
    buffer = Buffer(node=node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    async def look_up() -> tuple[object, int]:
        return await buffer.lookup_transform_async("a", "b", LATEST), threading.get_ident()

    task = executor.create_task(look_up)
    sent = transform("a", "b", SECOND)
    after(0.05, lambda: buffer.set_transform(sent, "me"))
    executor.spin_until_future_complete(task, timeout_sec=10.0)
    assert task.result() == (sent, threading.get_ident())


# The service


def test_a_node_s_buffer_tells_its_frames(node: Node) -> None:
    buffer = Buffer(node=node)
    buffer.set_transform(transform("a", "b", SECOND), "me")
    client = node.create_client(FrameGraph, "tf2_frames")
    with spinning(node):
        assert client.wait_for_service(5.0)
        response = client.call(FrameGraph.Request(), timeout_sec=5.0)
    assert response.frame_yaml == buffer.all_frames_as_yaml()


def test_lookups_of_the_future_say_so_after_waiting(buffer: Buffer) -> None:
    buffer.set_transform(transform("a", "b", SECOND), "me")
    buffer.set_transform(transform("a", "b", 2 * SECOND), "me")
    with pytest.raises(ExtrapolationException, match="into the future"):
        buffer.lookup_transform("a", "b", at(3), Duration(seconds=0.02))
