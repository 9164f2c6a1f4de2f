"""Waitables of programs' own making, and wait sets."""

import threading
import time
from typing import Any

import pytest
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.waitable import NumberOfEntities, Waitable
from std_msgs.msg import Int32
from std_srvs.srv import SetBool

from ros.rclpy.waiting import LONG, run_ready, spin_until

QOS = QoSProfile(depth=10).get_c_qos_profile()
KINDS = ["client", "service", "timer", "subscription", "guard_condition"]
MS = 1_000_000


class OneEntity(Waitable):
    """Waits for one entity, as the programs do that use `Waitable`."""

    def __init__(self, node: Node, kind: str, group: Any = None) -> None:
        super().__init__(group or ReentrantCallbackGroup())
        self.kind, self.index, self.is_on, self.got = kind, None, False, []
        self.clock = Clock(clock_type=ClockType.STEADY_TIME)
        with node.handle:
            self.entity = {
                "client": lambda: _rclpy.Client(node.handle, SetBool, "asked", QOS),
                "service": lambda: _rclpy.Service(node.handle, SetBool, "served", QOS),
                "timer": lambda: _rclpy.Timer(self.clock.handle, node.context.handle, MS, True),
                "subscription": lambda: _rclpy.Subscription(node.handle, Int32, "numbers", QOS),
                "guard_condition": lambda: _rclpy.GuardCondition(node.context.handle),
            }[kind]()

    def __enter__(self) -> None:
        self.entity.__enter__()

    def __exit__(self, *error: object) -> None:
        self.entity.__exit__(*error)

    def is_ready(self, wait_set: Any) -> bool:
        self.is_on = self.is_on or wait_set.is_ready(self.kind, self.index)
        return self.is_on

    def take_data(self) -> Any:
        if not self.is_on:
            return None
        self.is_on = False
        return {
            "client": lambda: self.entity.take_response(SetBool.Response)[1].message,
            "service": lambda: self.entity.service_take_request(SetBool.Request)[0].data,
            "timer": lambda: self.entity.call_timer() and "tick",
            "subscription": lambda: self.entity.take_message(Int32, False)[0].data,
            "guard_condition": lambda: "triggered",
        }[self.kind]()

    async def execute(self, taken_data: Any) -> None:
        self.got.append(taken_data)

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(*(int(self.kind == kind) for kind in reversed(KINDS)))

    def add_to_wait_set(self, wait_set: Any) -> None:
        self.index = getattr(wait_set, f"add_{self.kind}")(self.entity)


def provoke(node: Node, waitable: OneEntity) -> object:
    """Make the entity ready; returns what the waitable will get."""
    if waitable.kind == "client":
        node.create_service(SetBool, "asked", lambda request, response: SetBool.Response(message="yes"))
        assert waitable.entity.service_server_is_available()
        waitable.entity.send_request(SetBool.Request())
        return "yes"
    if waitable.kind == "service":
        node.create_client(SetBool, "served").call_async(SetBool.Request(data=True))
        return True
    if waitable.kind == "timer":
        return "tick"
    if waitable.kind == "subscription":
        node.create_publisher(Int32, "numbers", 10).publish(Int32(data=7))
        return 7
    waitable.entity.trigger_guard_condition()
    return "triggered"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("executor_class", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_waitable_gets_what_its_entity_has(node: Node, kind: str, executor_class: type) -> None:
    with executor_class() as executor:
        executor.add_node(node)
        waitable = OneEntity(node, kind)
        node.add_waitable(waitable)
        if kind != "timer":
            executor.spin_once(timeout_sec=0)
            assert waitable.got == []
        expected = provoke(node, waitable)
        spin_until(executor, lambda: waitable.got)
        assert waitable.got[0] == expected
        node.remove_waitable(waitable)
        executor.remove_node(node)


def test_nothing_is_missed_though_the_group_lets_only_one_run(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    waitable = OneEntity(node, "subscription", MutuallyExclusiveCallbackGroup())
    node.add_waitable(waitable)
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(8):
        publisher.publish(Int32(data=number))
    spin_until(executor, lambda: len(waitable.got) == 8)
    assert waitable.got == list(range(8))


def test_a_waitable_that_is_removed_gets_nothing(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    waitable = OneEntity(node, "guard_condition")
    node.add_waitable(waitable)
    node.remove_waitable(waitable)
    waitable.entity.trigger_guard_condition()
    run_ready(executor)
    assert waitable.got == []


def test_a_wait_ends_when_something_is_ready(graph: Context, node: Node) -> None:
    wait_set = _rclpy.WaitSet(1, 1, 1, 0, 0, 0, graph.handle)
    guard = _rclpy.GuardCondition(graph.handle)
    subscription = _rclpy.Subscription(node.handle, Int32, "numbers", QOS)
    guard_index, subscription_index = wait_set.add_guard_condition(guard), wait_set.add_subscription(subscription)

    def ready() -> tuple[bool, bool]:
        return wait_set.is_ready("guard_condition", guard_index), wait_set.is_ready("subscription", subscription_index)

    wait_set.wait(MS)
    assert ready() == (False, False)
    threading.Timer(0.01, guard.trigger_guard_condition).start()
    wait_set.wait(int(LONG * 1e9))
    assert ready() == (True, False)
    node.create_publisher(Int32, "numbers", 10).publish(Int32())
    wait_set.wait(-1)
    assert ready() == (False, True)
    assert wait_set.get_ready_entities("subscription") == [subscription.pointer]
    wait_set.wait(0)
    assert ready() == (False, True), "until it is taken"
    assert subscription.take_message(Int32) is not None
    wait_set.wait(0)
    assert ready() == (False, False)
    with pytest.raises(RuntimeError, match="known"):
        wait_set.is_ready("no kind", 0)
    wait_set.clear_entities()
    wait_set.wait(0)


def test_a_wait_ends_when_a_timer_is_due(graph: Context) -> None:
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    timer = _rclpy.Timer(clock.handle, graph.handle, 10 * MS, True)
    wait_set = _rclpy.WaitSet(0, 0, 1, 0, 0, 0, graph.handle)
    index = wait_set.add_timer(timer)
    begin = time.monotonic_ns()
    wait_set.wait(-1)
    assert wait_set.is_ready("timer", index)
    assert time.monotonic_ns() - begin < LONG * 1e9
    called = timer.call_timer_with_info()
    assert begin < called["expected_call_time"] <= called["actual_call_time"]
    wait_set.wait(0)
    assert not wait_set.is_ready("timer", index)


def test_numbers_of_entities_add_up() -> None:
    total = NumberOfEntities(1, 2, 3, 4, 5, 6) + NumberOfEntities(10, 20, 30, 40, 50, 60)
    assert total == NumberOfEntities(11, 22, 33, 44, 55, 66)
    total += NumberOfEntities(num_events=1)
    assert total.num_events == 67
    assert "67" in repr(total)
