"""Nodes for asyncio."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.srv import GetParameters
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.exceptions import TimeSourceChangedError
from rclpy.experimental import AsyncNode, AsyncTimer
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.timer import TimerInfo
from std_msgs.msg import String

from ros.rclpy.waiting import LONG

SIM = [Parameter("use_sim_time", value=True)]


def run(program: Callable[[], Coroutine[Any, Any, None]]) -> None:
    async def limited() -> None:
        async with asyncio.timeout(LONG):
            await program()

    asyncio.run(limited())


async def idle(message: Any) -> None:
    """Do nothing with a message."""


@pytest.mark.parametrize("early", [True, False], ids=["made before", "made within"])
def test_messages_arrive_in_functions_and_coroutines(graph: Context, early: bool) -> None:
    async def program() -> None:
        received: list[tuple[str, bool]] = []
        both = asyncio.Event()

        def note(message: String) -> None:
            received.append((message.data, False))

        async def note_later(message: String, info: dict[str, Any]) -> None:
            await asyncio.sleep(0)
            received.append((message.data, info["source_timestamp"] > 0))
            both.set()

        node = AsyncNode("listener")

        def furnish() -> Any:
            node.create_subscription(String, "chatter", note, 10)
            node.create_subscription(String, "chatter", note_later, 10)
            return node.create_publisher(String, "chatter", 10)

        publisher = furnish() if early else None
        async with node:
            publisher = publisher or furnish()
            publisher.publish(String(data="hello"))
            await both.wait()
        assert sorted(received) == [("hello", False), ("hello", True)]

    run(program)


@pytest.mark.parametrize("concurrent", [True, False])
def test_callbacks_overlap_only_where_they_are_meant_to(graph: Context, concurrent: bool) -> None:
    async def program() -> None:
        running, most, ended, done = 0, 0, 0, asyncio.Event()

        async def callback(message: String) -> None:
            nonlocal running, most, ended
            running += 1
            most = max(most, running)
            await asyncio.sleep(0.005)
            running -= 1
            ended += 1
            if ended == 3:
                done.set()

        async with AsyncNode("listener") as node:
            node.create_subscription(String, "chatter", callback, 10, concurrent=concurrent)
            publisher = node.create_publisher(String, "chatter", 10)
            for _ in range(3):
                publisher.publish(String())
            await done.wait()
        assert most == (3 if concurrent else 1)

    run(program)


@pytest.mark.parametrize("concurrent", [True, False])
def test_an_exception_of_a_callback_ends_the_node(graph: Context, concurrent: bool) -> None:
    async def fail(message: String) -> None:
        raise ZeroDivisionError("of a callback")

    async def program() -> None:
        node = AsyncNode("listener")
        node.create_subscription(String, "chatter", fail, 10, concurrent=concurrent)
        node.create_publisher(String, "chatter", 10).publish(String())
        with pytest.raises(ExceptionGroup) as raised:
            await node.run()
        assert raised.value.subgroup(ZeroDivisionError)
        with pytest.raises(RuntimeError, match="destroyed"):
            node.create_publisher(String, "chatter", 10)

    run(program)


def test_an_exception_in_the_block_ends_the_node(graph: Context) -> None:
    async def program() -> None:
        node = AsyncNode("listener")
        with pytest.raises(ExceptionGroup) as raised:
            async with node:
                raise RuntimeError("of the block")
        assert raised.value.subgroup(RuntimeError)
        node.destroy_node()

    run(program)


def test_a_node_runs_until_a_callback_destroys_it(graph: Context) -> None:
    async def program() -> None:
        node = AsyncNode("listener")

        async def stop(message: String) -> None:
            node.destroy_node()

        node.create_subscription(String, "chatter", stop, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        asyncio.get_running_loop().call_later(0.01, publisher.publish, String())
        await node.run()
        with pytest.raises(RuntimeError):
            publisher.publish(String())

    run(program)


def test_a_node_runs_once(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("listener") as node:
            with pytest.raises(RuntimeError, match="already"):
                await node.run()

    run(program)


def test_a_node_runs_until_its_context_ends(graph: Context) -> None:
    async def program() -> None:
        asyncio.get_running_loop().call_later(0.01, rclpy.shutdown)
        await AsyncNode("listener").run()

    run(program)


def test_calls_are_answered_each_with_its_own_response(graph: Context) -> None:
    async def program() -> None:
        together = asyncio.Barrier(3)

        async def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
            await together.wait()
            response.sum = request.a + request.b
            return response

        async with AsyncNode("server") as server, AsyncNode("client") as asker:
            server.create_service(AddTwoInts, "add", add, concurrent=True)
            client = asker.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            requests = (client.call(AddTwoInts.Request(a=number, b=1)) for number in range(3))
            assert [one.sum for one in await asyncio.gather(*requests)] == [1, 2, 3]

    run(program)


def test_calls_and_waits_end_with_their_timeouts(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("client") as node:
            client = node.create_client(AddTwoInts, "nobody")
            assert not await client.wait_for_service(timeout_sec=0.01)
            for wait in (client.wait_for_service, lambda: client.call(AddTwoInts.Request())):
                with pytest.raises(TimeoutError):
                    async with asyncio.timeout(0.01):
                        await wait()
            with pytest.raises(TimeoutError):
                await client.call(AddTwoInts.Request(), timeout_sec=0.01)
            assert not client._pending_requests
            assert not await node.wait_for_node("nobody", 0.01)
            assert await node.wait_for_node("client")

    run(program)


def test_a_destroyed_client_cancels_its_calls(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("client") as node:
            client = node.create_client(AddTwoInts, "nobody")
            asyncio.get_running_loop().call_soon(client.destroy)
            with pytest.raises(asyncio.CancelledError):
                await client.call(AddTwoInts.Request())
            with pytest.raises(RuntimeError):
                await client.call(AddTwoInts.Request())

    run(program)


def test_destroying_a_server_cancels_what_it_was_about_to_answer(graph: Context) -> None:
    async def program() -> None:
        begun, cancelled = asyncio.Event(), asyncio.Event()

        async def hang(request: Any, response: Any) -> Any:
            begun.set()
            try:
                await asyncio.Event().wait()
            finally:
                cancelled.set()

        async with AsyncNode("server") as server, AsyncNode("client") as asker:
            server.create_service(AddTwoInts, "add", hang)
            client = asker.create_client(AddTwoInts, "add")
            call = asyncio.create_task(client.call(AddTwoInts.Request()))
            await begun.wait()
            server.destroy_node()
            await cancelled.wait()
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.05):
                    await call

    run(program)


def test_others_get_its_parameters(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("server") as server, AsyncNode("client") as asker:
            server.declare_parameter("speed", 42)
            client = asker.create_client(GetParameters, "/server/get_parameters")
            await client.wait_for_service()
            response = await client.call(GetParameters.Request(names=["speed"]))
            assert response.values[0].integer_value == 42

    run(program)


def test_timers_tick_and_can_be_stopped(graph: Context) -> None:
    async def program() -> None:
        ticks: list[TimerInfo] = []
        ticked = asyncio.Event()

        async def tick(info: TimerInfo) -> None:
            ticks.append(info)
            if len(ticks) % 3 == 0:
                ticked.set()

        async with AsyncNode("ticker") as node:
            timer = node.create_timer(0.001, tick)
            assert isinstance(timer, AsyncTimer)
            await ticked.wait()
            timer.cancel()
            assert timer.is_canceled()
            count = len(ticks)
            await asyncio.sleep(0.01)
            assert len(ticks) == count
            ticked.clear()
            timer.reset()
            await ticked.wait()
            assert ticks[0].actual_call_time >= ticks[0].expected_call_time
            with pytest.raises(RuntimeError):
                node.create_timer(1.0, lambda one, two: None)

    run(program)


def test_a_timer_that_is_always_due_lets_others_run(graph: Context) -> None:
    async def program() -> None:
        ticked = asyncio.Event()

        async def tick() -> None:
            ticked.set()

        async with AsyncNode("ticker") as node:
            node.create_timer(0.0, tick)
            await ticked.wait()

    run(program)


def test_simulated_time_moves_timers_and_sleepers(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("sleeper", parameter_overrides=SIM) as node:
            clock = node.get_clock()
            clock.set_ros_time_override(Time(seconds=10, clock_type=ClockType.ROS_TIME))
            ticked = asyncio.Event()
            node.create_timer(2.0, ticked.set)
            short, long = (asyncio.create_task(clock.sleep(span)) for span in (1.0, 5.0))
            await asyncio.sleep(0.01)
            assert not short.done()
            clock.set_ros_time_override(Time(seconds=12, clock_type=ClockType.ROS_TIME))
            await short
            await ticked.wait()
            await asyncio.sleep(0.01)
            assert not long.done()
            clock.set_ros_time_override(Time(seconds=15, clock_type=ClockType.ROS_TIME))
            await long

    run(program)


async def _become_simulated(node: AsyncNode) -> None:
    node.set_parameters(SIM)


async def _destroy(node: AsyncNode) -> None:
    node.destroy_node()


@pytest.mark.parametrize(
    ("event", "error"), [(_become_simulated, TimeSourceChangedError), (_destroy, asyncio.CancelledError)]
)
def test_sleep_ends_when_it_has_lost_its_meaning(
    graph: Context, event: Callable[[AsyncNode], Awaitable[None]], error: type[BaseException]
) -> None:
    async def program() -> None:
        async with AsyncNode("sleeper") as node:
            sleep = asyncio.create_task(node.get_clock().sleep(999))
            await asyncio.sleep(0)
            await event(node)
            with pytest.raises(error):
                await sleep

    run(program)


def test_sleep_takes_its_time(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("sleeper") as node:
            clock, begin = node.get_clock(), time.monotonic()
            await asyncio.gather(clock.sleep(0.02), clock.sleep(0.03), clock.sleep(0), clock.sleep(-1))
            assert 0.03 <= time.monotonic() - begin < LONG
        with pytest.raises(RuntimeError):
            await clock.sleep(1.0)

    run(program)


def test_the_graph_can_be_asked(graph: Context) -> None:
    async def program() -> None:
        async with AsyncNode("asker", namespace="/here") as node:
            node.create_publisher(String, "chatter", 10)
            node.create_subscription(String, "chatter", idle, 10)
            assert node.count_publishers("chatter") == node.count_subscribers("chatter") == 1
            assert node.get_publishers_info_by_topic("/here/chatter")[0].node_name == "asker"
            assert ("/here/chatter", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
            assert node.get_action_names_and_types() == []
            assert node.get_fully_qualified_node_names() == ["/here/asker"]

    run(program)
