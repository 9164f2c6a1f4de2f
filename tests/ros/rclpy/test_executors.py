"""Executors: what they run, when, in which thread, and that nothing they run can lock them up."""

import asyncio
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.exceptions import ROSInterruptException
from rclpy.executors import (
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    ShutdownException,
    SingleThreadedExecutor,
)
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Int32
from std_srvs.srv import Empty

from ros.rclpy.waiting import LONG, run_ready, spin_until

KINDS = [SingleThreadedExecutor, MultiThreadedExecutor, EventsExecutor]


@pytest.fixture(params=KINDS)
def executor(request: pytest.FixtureRequest, node: Node) -> Iterator[Executor]:
    executor = request.param()
    executor.add_node(node)
    yield executor
    executor.shutdown()


def in_thread(function: Callable[[], object]) -> threading.Thread:
    def quietly() -> None:
        with suppress(ExternalShutdownException, ROSInterruptException):
            function()

    thread = threading.Thread(target=quietly, daemon=True)
    thread.start()
    return thread


def test_a_node_belongs_to_one_executor(node: Node) -> None:
    first, second = SingleThreadedExecutor(), SingleThreadedExecutor()
    assert first.add_node(node)
    assert not first.add_node(node)
    assert node.executor is first
    assert second.add_node(node)
    assert node.executor is second
    assert first.get_nodes() == []
    node.executor = None
    assert second.get_nodes() == []


def test_without_a_wait_only_what_is_ready_runs(executor: Executor, node: Node) -> None:
    called: list[int] = []
    guard = node.create_guard_condition(lambda: called.append(1))
    executor.spin_once(timeout_sec=0)
    assert called == []
    guard.trigger()
    guard.trigger()
    spin_until(executor, lambda: called)
    assert called == [1]


def test_one_call_runs_one_callback(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    received: list[int] = []
    node.create_subscription(Int32, "numbers", lambda message: received.append(message.data), 10)
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(3):
        publisher.publish(Int32(data=number))
    for count in range(1, 4):
        executor.spin_once(timeout_sec=1)
        assert received == list(range(count))


def test_what_is_removed_runs_no_more(node: Node) -> None:
    executor = SingleThreadedExecutor()
    called: list[int] = []
    node.create_timer(0.0, lambda: called.append(1))
    executor.add_node(node)
    executor.remove_node(node)
    run_ready(executor)
    assert called == []


def test_a_sleeping_executor_notices_what_is_made(executor: Executor, node: Node) -> None:
    future = Future()
    thread = in_thread(lambda: executor.spin_until_future_complete(future, LONG))
    node.create_timer(0.001, lambda: future.set_result("ticked"))
    thread.join(LONG)
    assert future.result() == "ticked"


def test_a_sleeping_executor_notices_a_node(graph: Context, node: Node) -> None:
    executor = SingleThreadedExecutor()
    called = threading.Event()
    node.create_guard_condition(called.set).trigger()
    thread = in_thread(lambda: executor.spin_once(timeout_sec=LONG))
    executor.add_node(node)
    assert called.wait(LONG)
    thread.join(LONG)


def test_an_exception_of_a_callback_reaches_who_spins(executor: Executor, node: Node) -> None:
    def fail() -> None:
        raise ZeroDivisionError("of a callback")

    node.create_guard_condition(fail).trigger()
    with pytest.raises(ZeroDivisionError, match="of a callback"):
        spin_until(executor, lambda: False)


def test_a_future_ends_the_spinning(executor: Executor) -> None:
    future = Future()
    in_thread(lambda: future.set_result(3))
    executor.spin_until_future_complete(future)
    assert future.result() == 3
    for timeout in (0, 0.01):
        begin = time.monotonic()
        executor.spin_until_future_complete(Future(), timeout)
        assert timeout <= time.monotonic() - begin < LONG


def test_a_cancelled_future_ends_the_spinning(executor: Executor) -> None:
    future = Future()
    in_thread(future.cancel)
    executor.spin_until_future_complete(future)
    assert future.cancelled()


def test_shutting_down_ends_the_spinning_and_forbids_more(graph: Context, node: Node) -> None:
    for kind in KINDS:
        executor = kind()
        executor.add_node(node)
        node.create_timer(0.001, lambda: None)
        thread = in_thread(executor.spin)
        assert executor.shutdown()
        thread.join(LONG)
        assert not thread.is_alive()
        with pytest.raises(ShutdownException):
            executor.wait_for_ready_callbacks()
        with pytest.raises(ShutdownException):
            executor.add_node(node)


def test_a_callback_may_shut_the_executor_down(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    node.create_guard_condition(lambda: executor.shutdown(0)).trigger()
    executor.spin()
    assert executor.get_nodes() == []


def test_the_end_of_the_context_ends_the_spinning(graph: Context, executor: Executor) -> None:
    ended: list[type] = []

    def spin() -> None:
        try:
            executor.spin()
        except ExternalShutdownException as error:
            ended.append(type(error))

    thread = in_thread(spin)
    rclpy.shutdown()
    thread.join(LONG)
    assert not thread.is_alive()
    assert ended in ([], [ExternalShutdownException])


def test_tasks_run_in_the_order_they_were_given(executor: Executor) -> None:
    async def later() -> str:
        return await first + " and second"

    first = Future(executor=executor)
    task = executor.create_task(later())
    in_thread(lambda: first.set_result("first"))
    executor.spin_until_future_complete(task, LONG)
    assert task.result() == "first and second"
    assert executor.create_task(lambda number: number, 3)._args == [3]


def test_tasks_that_follow_each_other_leave_room_for_callbacks(executor: Executor, node: Node) -> None:
    called: list[int] = []
    node.create_timer(0.001, lambda: called.append(1))

    def again() -> None:
        if len(called) < 3:
            executor.create_task(again)

    again()
    spin_until(executor, lambda: len(called) >= 3)


def test_a_coroutine_goes_on_where_it_waited(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    steps: list[int] = []

    async def callback() -> None:
        steps.append(1)
        await asyncio.sleep(0)
        steps.append(2)

    node.create_guard_condition(callback).trigger()
    executor.spin_once(timeout_sec=0)
    assert steps == [1]
    executor.spin_once(timeout_sec=1)
    assert steps == [1, 2]


def test_a_coroutine_may_wait_for_asyncio(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    done: list[int] = []

    async def callback() -> None:
        await asyncio.sleep(0.01)
        done.append(1)

    node.create_guard_condition(callback).trigger()

    async def spin() -> None:
        async with asyncio.timeout(LONG):
            while not done:
                executor.spin_once(timeout_sec=0)
                await asyncio.sleep(0.001)

    asyncio.run(spin())


def test_a_coroutine_that_waits_holds_its_group(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    gate, called = Future(), []

    async def slow() -> None:
        called.append("begin")
        await gate
        called.append("end")

    node.create_guard_condition(slow).trigger()
    node.create_guard_condition(lambda: called.append("other")).trigger()
    run_ready(executor)
    assert called == ["begin"]
    gate.set_result(None)
    spin_until(executor, lambda: len(called) == 3)
    assert called == ["begin", "end", "other"]


def test_groups_say_what_runs_at_the_same_time(node: Node) -> None:
    with MultiThreadedExecutor(4) as executor:
        executor.add_node(node)
        thread = in_thread(executor.spin)
        together = threading.Barrier(2)
        reentrant = ReentrantCallbackGroup()
        met: list[int] = []

        def meet() -> None:
            together.wait(LONG)
            met.append(1)

        for _ in range(2):
            node.create_guard_condition(meet, reentrant).trigger()
        exclusive, running, most, count = MutuallyExclusiveCallbackGroup(), 0, 0, 0

        def alone() -> None:
            nonlocal running, most, count
            running += 1
            most = max(most, running)
            time.sleep(0.001)
            running -= 1
            count += 1

        guards = [node.create_guard_condition(alone, exclusive) for _ in range(20)]
        for guard in guards:
            guard.trigger()
        deadline = time.monotonic() + LONG
        while (count < 20 or len(met) < 2) and time.monotonic() < deadline:
            time.sleep(0.001)
        assert (count, most, len(met)) == (20, 1, 2)
    thread.join(LONG)


def answer(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    response.sum = request.a + request.b
    return response


@pytest.mark.parametrize("same_node", [True, False], ids=["own service", "another node's"])
@pytest.mark.parametrize("depth", [1, 3])
def test_a_callback_may_call_a_service_that_the_same_executor_serves(
    executor: Executor, node: Node, same_node: bool, depth: int
) -> None:
    """As deep as it likes: what would be a deadlock is the answer's only way."""
    server = node if same_node else Node("server")
    executor.add_node(server)
    server.create_service(AddTwoInts, "add0", answer)
    clients = [node.create_client(AddTwoInts, f"add{level}") for level in range(depth)]

    def pass_on(client: object) -> Callable[..., object]:
        return lambda request, response: client.call(request)  # type: ignore[attr-defined]

    for level in range(1, depth):
        server.create_service(AddTwoInts, f"add{level}", pass_on(clients[level - 1]))
    sums: list[int] = []
    node.create_guard_condition(lambda: sums.append(clients[-1].call(AddTwoInts.Request(a=2, b=3)).sum)).trigger()
    spin_until(executor, lambda: sums)
    assert sums == [5]


def test_callbacks_that_wait_leave_their_threads_to_others(node: Node) -> None:
    with MultiThreadedExecutor(2) as executor:
        executor.add_node(node)
        group = ReentrantCallbackGroup()
        node.create_service(AddTwoInts, "add", answer, callback_group=group)
        client = node.create_client(AddTwoInts, "add", callback_group=group)
        sums: list[int] = []

        def ask() -> None:
            sums.append(client.call(AddTwoInts.Request(a=1, b=1)).sum)

        for _ in range(8):
            node.create_guard_condition(ask, group).trigger()
        spin_until(executor, lambda: len(sums) == 8)
        assert sums == [2] * 8


def test_a_callback_may_spin_until_its_call_is_answered(node: Node) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    node.create_service(AddTwoInts, "add", answer, callback_group=ReentrantCallbackGroup())
    client = node.create_client(AddTwoInts, "add")
    sums: list[int] = []

    def ask() -> None:
        future = client.call_async(AddTwoInts.Request(a=4, b=3))
        rclpy.spin_until_future_complete(node, future, executor, LONG)
        sums.append(future.result().sum)

    node.create_guard_condition(ask).trigger()
    spin_until(executor, lambda: sums)
    assert sums == [7]
    assert node.executor is executor, "it is spun as before"


def test_a_call_that_nobody_answers_ends_with_its_timeout(executor: Executor, node: Node) -> None:
    client = node.create_client(Empty, "nobody")
    answers: list[object] = []
    node.create_guard_condition(lambda: answers.append(client.call(Empty.Request(), timeout_sec=0.01))).trigger()
    spin_until(executor, lambda: answers)
    assert answers == [None]


def test_a_call_ends_with_the_context(graph: Context, node: Node) -> None:
    client = node.create_client(Empty, "nobody")
    raised: list[BaseException] = []

    def ask() -> None:
        try:
            client.call(Empty.Request())
        except ROSInterruptException as error:
            raised.append(error)

    thread = in_thread(ask)
    while not client._pending_requests:
        time.sleep(0.001)
    rclpy.shutdown()
    thread.join(LONG)
    assert len(raised) == 1


def test_threads_end_with_the_executor(node: Node) -> None:
    before = threading.active_count()
    for _ in range(3):
        with MultiThreadedExecutor(3) as executor:
            executor.add_node(node)
            done = threading.Event()
            guard = node.create_guard_condition(done.set)
            guard.trigger()
            spin_until(executor, done.is_set)
            node.destroy_guard_condition(guard)
    deadline = time.monotonic() + LONG
    while threading.active_count() > before and time.monotonic() < deadline:
        time.sleep(0.001)
    assert threading.active_count() == before


def test_waiting_takes_no_processor_time(executor: Executor, node: Node) -> None:
    node.create_timer(1000.0, lambda: None)
    before = time.process_time()
    executor.spin_until_future_complete(Future(), 0.3)
    assert time.process_time() - before < 0.1


def test_a_timeout_of_zero_still_runs_what_is_ready(node: Node) -> None:
    ran: list[str] = []
    guards = [node.create_guard_condition(lambda name=name: ran.append(name)) for name in "abc"]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    for guard in guards:
        guard.trigger()
    executor.spin_until_future_complete(Future(), 0)
    assert ran == ["a"]
    executor.shutdown()


def test_the_events_executor_leaves_nothing_that_is_ready(node: Node) -> None:
    ran: list[int] = []
    follow = [node.create_guard_condition(lambda: ran.append(2)), node.create_guard_condition(lambda: ran.append(3))]

    def first() -> None:
        ran.append(1)
        for guard in follow:
            guard.trigger()

    start = node.create_guard_condition(first)
    executor = EventsExecutor()
    executor.add_node(node)
    start.trigger()
    executor.spin_until_future_complete(Future(), 0)
    assert ran == [1, 2, 3]
    executor.shutdown()


def test_several_threads_are_meant_to_be_several() -> None:
    with pytest.warns(UserWarning, match="SingleThreadedExecutor"):
        MultiThreadedExecutor(num_threads=1, context=Context()).shutdown()


class OneByOne(Executor):
    """An executor of a user's: it only says how one callback is run."""

    def __init__(self) -> None:
        super().__init__()
        self.ran: list[str] = []

    def spin_once(self, timeout_sec: float | None = None) -> None:
        task, _, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        self.ran.append(node.get_name() if node is not None else "")
        task()


def test_an_executor_of_ones_own_replaces_spin_once_alone(node: Node) -> None:
    executor = OneByOne()
    executor.add_node(node)
    future: Future = Future()
    node.create_timer(0.001, lambda: future.set_result(7))
    executor.spin_until_future_complete(future, LONG)
    assert future.result() == 7
    node.create_timer(0.001, lambda: rclpy.shutdown())
    with suppress(ExternalShutdownException):
        executor.spin()
    assert not rclpy.ok()
    assert set(executor.ran) == {node.get_name()}
    assert len(executor.ran) >= 2
    executor.shutdown()


def test_threads_have_ended_after_the_shutdown(node: Node) -> None:
    before = set(threading.enumerate())
    executor = MultiThreadedExecutor(2)
    executor.spin_until_future_complete(executor.create_task(lambda: None), 60.0)
    assert executor.shutdown(wait_for_threads=True)
    assert {one for one in threading.enumerate() if one.name == "rclpy"} <= before
