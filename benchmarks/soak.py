"""What a long life of an rclpy process leaves behind: entities come and go, messages, calls and goals pass.

`DAIDALOS_SOAK_S` says for how long: 600 s by default, 3600 for the hour. `DAIDALOS_SOAK_ROUND_S` is the least time a
round takes: 0 by default, more for a long run beside other work.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import statistics
import threading
import time
from typing import Any

import psutil

SECONDS = float(os.environ.get("DAIDALOS_SOAK_S", "600"))
ROUND_S = float(os.environ.get("DAIDALOS_SOAK_ROUND_S", "0"))
SETTLING = 0.2
"""Part of the time after which memory counts: caches have been filled by then."""
SAMPLES = 100
"""How often memory is read in the whole time."""


def run() -> dict[str, float]:
    """Measure; see `soak`."""
    return {f"soak.{name}": value for name, value in soak(SECONDS).items()}


def soak(seconds: float) -> dict[str, float]:
    """Work for a while.

    Returns
    -------
    dict
        Growth of memory in MB after the settling time and its slope by least squares, threads and endpoints left
        over, calls and messages that went wrong, and how many rounds of work were done.
    """
    import rclpy
    from rclpy.executors import MultiThreadedExecutor

    threads = threading.active_count()
    process, begin = psutil.Process(), time.monotonic()
    rounds, errors = 0, 0
    samples: list[tuple[float, float]] = []
    pace = threading.Event()
    with rclpy.init(args=[]):
        watcher = rclpy.create_node("soak_watcher")
        while (spent := time.monotonic() - begin) < seconds:
            with MultiThreadedExecutor(2) as executor:
                errors += _round(executor, rounds)
            rounds += 1
            if spent > seconds * (SETTLING + (1 - SETTLING) * len(samples) / SAMPLES):
                samples.append((spent, _resident(process) / 2**20))
            pace.wait(ROUND_S - (time.monotonic() - begin - spent))
        samples.append((seconds, _resident(process) / 2**20))
        endpoints = len([one for one in watcher.handle.graph.endpoints() if one.node.name != "soak_watcher"])
    deadline = time.monotonic() + 5
    while threading.active_count() > threads and time.monotonic() < deadline:
        time.sleep(0.01)
    return {
        "memory_growth_mb": samples[-1][1] - samples[0][1],
        "memory_slope_mb_per_h": 3600 * statistics.linear_regression(*zip(*samples, strict=True)).slope,
        "threads_left": threading.active_count() - threads,
        "endpoints_left": endpoints,
        "errors": errors,
        "rounds": rounds,
    }


def _resident(process: psutil.Process) -> int:
    """Return the memory in use [bytes]; what the allocator keeps for later is given up first."""
    gc.collect()
    with contextlib.suppress(AttributeError, OSError, TypeError):  # of glibc alone
        ctypes.CDLL(None).malloc_trim(0)
    return int(process.memory_info().rss)


def _round(executor: Any, number: int) -> int:
    """Make nodes with everything, have them talk, and destroy them; returns what went wrong."""
    import rclpy
    from example_interfaces.srv import AddTwoInts
    from rclpy.action import ActionClient, ActionServer
    from rclpy.callback_groups import ReentrantCallbackGroup
    from std_msgs.msg import String
    from test_msgs.action import Fibonacci

    server, client = (rclpy.create_node(f"soak_{name}") for name in ("server", "client"))
    executor.add_node(server)
    executor.add_node(client)
    received: list[str] = []
    client.create_subscription(String, "soak", lambda message: received.append(message.data), 100)
    publisher = server.create_publisher(String, "soak", 100)
    server.create_timer(0.001, lambda: publisher.publish(String(data="x" * 1000)))

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    def execute(goal: Any) -> Fibonacci.Result:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        goal.succeed()
        return Fibonacci.Result(sequence=[1, 1])

    group = ReentrantCallbackGroup()
    server.create_service(AddTwoInts, "soak_add", add, callback_group=group)
    ActionServer(server, Fibonacci, "soak_action", execute, callback_group=group)
    asker = client.create_client(AddTwoInts, "soak_add")
    actor = ActionClient(client, Fibonacci, "soak_action")
    call = asker.call_async(AddTwoInts.Request(a=number, b=1))
    executor.spin_until_future_complete(call, 10)
    goal = actor.send_goal_async(Fibonacci.Goal(order=2))
    executor.spin_until_future_complete(goal, 10)
    result = goal.result().get_result_async() if goal.done() else goal
    executor.spin_until_future_complete(result, 10)
    deadline = time.monotonic() + 10
    while not received and time.monotonic() < deadline:
        executor.spin_once(timeout_sec=0.1)
    faults = (not call.done() or call.result().sum != number + 1) + (not result.done()) + (not received)
    for node in (server, client):
        node.destroy_node()
    return faults
