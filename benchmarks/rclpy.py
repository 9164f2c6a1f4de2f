"""What rclpy costs: messages as bytes, streams, round trips and calls between processes, timers, starting, memory.

Set-ups are those by which the figures of ROS 2's own rclpy were taken: two processes, a single-threaded executor each.
What crosses the machine is measured in turns with its floor (`benchmarks.floors`), and figures are medians of these.
"""

from __future__ import annotations

import os
import resource
import statistics
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from benchmarks import floors
from benchmarks.messages import MESSAGES
from benchmarks.processes import middle_and_tail_us, report, result, running, say_ready, start

STREAM_S = 3.0
TIMER_S = 4.0
ROUND_TRIPS = 2000
CALLS = 1500
WARM = 300
STARTS = 7
TURNS = 3
DEPTHS = {"String": 1000, "Image": 10, "PointCloud2": 10}
LARGE = ("Image", "PointCloud2")
LATENCIES = {"round_trip": ("echo", "ping", "zenoh_ping"), "service_call": ("serve", "call", "zenoh_call")}
"""Who answers, who asks, and what is the floor over zenoh."""
DDS = "rmw_cyclonedds_cpp"


def run() -> dict[str, float]:
    """Measure everything; times are medians."""
    figures = measure_codecs() | measure_streams() | measure_latencies() | measure_timer() | measure_start()
    figures |= measure_memory()
    if _has_dds():
        os.environ["RMW_IMPLEMENTATION"] = DDS
        figures |= measure_dds_latencies()
    return {f"rclpy.{name}": value for name, value in figures.items()}


def measure_codecs() -> dict[str, float]:
    from rclpy.serialization import deserialize_message, serialize_message

    figures = {}
    for name in MESSAGES:
        message = MESSAGES[name]()
        data, kind = serialize_message(message), type(message)
        figures |= _medians_us(
            {
                f"serialize_{name}_us": lambda message=message: serialize_message(message),
                f"deserialize_{name}_us": lambda data=data, kind=kind: deserialize_message(data, kind),
                **({f"floor_copy_{name}_us": lambda data=data: bytearray(data)} if name in LARGE else {}),
            }
        )
    return figures


def _medians_us(functions: dict[str, Callable[[], Any]], batches: int = 9) -> dict[str, float]:
    """Time functions in turns."""
    counts, times = {}, {name: [] for name in functions}
    for name, function in functions.items():
        function()
        begin = time.perf_counter()
        function()
        counts[name] = max(int(0.02 / max(time.perf_counter() - begin, 1e-7)), 5)
    for _ in range(batches):
        for name, function in functions.items():
            begin = time.perf_counter()
            for _ in range(counts[name]):
                function()
            times[name].append((time.perf_counter() - begin) / counts[name] * 1e6)
    return {name: statistics.median(values) for name, values in times.items()}


def measure_streams() -> dict[str, float]:
    from rclpy.serialization import serialize_message

    figures = {}
    for name in DEPTHS:
        size = len(serialize_message(MESSAGES[name]()))
        rates, bare, lost = [], [], 0
        for _ in range(TURNS):
            with running("rclpy", "receive_stream", name) as receiver:
                sent = result(start("rclpy", "send_stream", name))
                received = result(receiver)
            rates.append(received["count"] / received["seconds"])
            lost += sent["count"] - received["count"]
            bare.append(floors.zenoh_stream(size))
        figures[f"{name}_received_per_s"] = statistics.median(rates)
        figures[f"{name}_lost"] = lost
        figures[f"floor_{name}_received_per_s"] = statistics.median(bare)
    return figures


def measure_latencies() -> dict[str, float]:
    """Measure over zenoh."""
    figures = {}
    for name, (answers, asks, floor) in LATENCIES.items():
        ways = {
            name: lambda pair=(answers, asks): _latency(*pair),
            f"floor_{name}": lambda f=floor: floors.zenoh_latency(f),
        }
        ways[f"floor_{name}_attached"] = lambda f=floor: floors.zenoh_latency(f.replace("zenoh", "rmw"))
        figures |= _latencies_in_turns(ways)
        figures[f"{name}_times_floor"] = figures[f"{name}_p50_us"] / figures[f"floor_{name}_attached_p50_us"]
    return figures


def measure_dds_latencies() -> dict[str, float]:
    """Measure over DDS, where a call is a message each way as well, and so has the same floor."""
    ways: dict[str, Callable[[], tuple[float, float]]] = {
        f"dds_{name}": lambda pair=(answers, asks): _latency(*pair) for name, (answers, asks, _) in LATENCIES.items()
    }
    figures = _latencies_in_turns({**ways, "floor_dds": floors.dds_latency})
    for name in LATENCIES:
        figures[f"dds_{name}_times_floor"] = figures[f"dds_{name}_p50_us"] / figures["floor_dds_p50_us"]
    return figures


def _latencies_in_turns(ways: dict[str, Callable[[], tuple[float, float]]]) -> dict[str, float]:
    measured: dict[str, list[tuple[float, float]]] = {name: [] for name in ways}
    for _ in range(TURNS):
        for name, way in ways.items():
            measured[name].append(way())
    return {
        f"{name}_{part}_us": statistics.median(values)
        for name, pairs in measured.items()
        for part, values in zip(("p50", "p99"), zip(*pairs, strict=True), strict=True)
    }


def _latency(answers: str, asks: str) -> tuple[float, float]:
    with running("rclpy", answers):
        return middle_and_tail_us(result(start("rclpy", asks))["times"])


def measure_timer() -> dict[str, float]:
    """Measure a timer in turns with a bare thread that wakes as often."""
    ours, bare = zip(
        *((floors.share_and_jitter(result(start("rclpy", "tick"))), floors.wakes_1khz()) for _ in range(TURNS)),
        strict=True,
    )
    figures = {}
    for index, name in enumerate(("cpu_percent", "jitter_p99_us")):
        figures[f"timer_1khz_{name}"] = statistics.median(pair[index] for pair in ours)
        figures[f"floor_timer_1khz_{name}"] = statistics.median(pair[index] for pair in bare)
    return figures


def measure_start() -> dict[str, float]:
    return {"start_ms": statistics.median(result(start("rclpy", "begin"))["seconds"] for _ in range(STARTS)) * 1e3}


def measure_memory() -> dict[str, float]:
    return {"one_publisher_mb": result(start("rclpy", "publish_slowly"))["peak_kb"] / 1024}


def _cpu_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def _has_dds() -> bool:
    from daidalos.transport.shared import MIDDLEWARES

    with suppress(ImportError):
        import cyclonedds  # noqa: F401

        return DDS in MIDDLEWARES
    return False


# Roles.


def _node(name: str) -> tuple[Any, Any]:
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    rclpy.init()
    node = rclpy.create_node(name)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    return node, executor


def _spin_while_input_lasts(executor: Any) -> None:
    """Serve until who started this process closes its input."""
    import threading

    from rclpy.executors import ExternalShutdownException

    def wait() -> None:
        sys.stdin.read()
        executor.shutdown()

    threading.Thread(target=wait, daemon=True).start()
    say_ready()
    with suppress(ExternalShutdownException):
        executor.spin()


def _until(condition: Callable[[], Any]) -> None:
    deadline = time.monotonic() + 20
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("nobody came")
        time.sleep(0.01)
    time.sleep(0.5)  # so that discovery's last steps are not measured


def receive_stream(name: str) -> None:
    node, executor = _node("receiver")
    count, first, last = 0, 0.0, 0.0

    def receive(message: Any) -> None:
        nonlocal count, first, last
        last = time.perf_counter()
        first = first or last
        count += 1

    node.create_subscription(type(MESSAGES[name]()), "stream", receive, DEPTHS[name])
    _spin_while_input_lasts(executor)
    report(count=count, seconds=max(last - first, 1e-9))


def send_stream(name: str) -> None:
    node, _ = _node("sender")
    message = MESSAGES[name]()
    publisher = node.create_publisher(type(message), "stream", DEPTHS[name])
    _until(publisher.get_subscription_count)
    count, end = 0, time.perf_counter() + STREAM_S
    while time.perf_counter() < end:
        publisher.publish(message)
        count += 1
    time.sleep(1.0)
    report(count=count)


def echo() -> None:
    from std_msgs.msg import String

    node, executor = _node("echo")
    publisher = node.create_publisher(String, "pong", 10)
    node.create_subscription(String, "ping", publisher.publish, 10)
    _spin_while_input_lasts(executor)


def ping() -> None:
    from rclpy.task import Future
    from std_msgs.msg import String

    node, executor = _node("ping")
    publisher = node.create_publisher(String, "ping", 10)
    message, times, begin, done = MESSAGES["String"](), [], 0.0, Future()

    def answer(echoed: String) -> None:
        nonlocal begin
        now = time.perf_counter()
        times.append(now - begin)
        if len(times) == ROUND_TRIPS + WARM:
            done.set_result(None)
            return
        begin = time.perf_counter()
        publisher.publish(message)

    node.create_subscription(String, "pong", answer, 10)
    _until(publisher.get_subscription_count)
    begin = time.perf_counter()
    publisher.publish(message)
    executor.spin_until_future_complete(done, 120)
    report(times=times[WARM:])


def serve() -> None:
    from example_interfaces.srv import AddTwoInts

    node, executor = _node("server")

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    node.create_service(AddTwoInts, "add", add)
    _spin_while_input_lasts(executor)


def call() -> None:
    from example_interfaces.srv import AddTwoInts

    node, executor = _node("client")
    client = node.create_client(AddTwoInts, "add")
    _until(client.service_is_ready)
    times = []
    for number in range(CALLS + WARM):
        begin = time.perf_counter()
        future = client.call_async(AddTwoInts.Request(a=number, b=1))
        while not future.done():
            executor.spin_once(timeout_sec=10)
        times.append(time.perf_counter() - begin)
        assert future.result().sum == number + 1
    report(times=times[WARM:])


def tick() -> None:
    node, executor = _node("ticker")
    ticks: list[float] = []
    node.create_timer(0.001, lambda: ticks.append(time.perf_counter()))

    def spin(seconds: float) -> None:
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            executor.spin_once(timeout_sec=0.1)

    spin(0.5)
    ticks.clear()
    before = _cpu_s()
    spin(TIMER_S)
    report(ticks=ticks, cpu=_cpu_s() - before, seconds=TIMER_S)


def begin() -> None:
    started = time.perf_counter()
    import rclpy

    rclpy.init()
    node = rclpy.create_node("started")
    node.destroy_node()
    rclpy.shutdown()
    report(seconds=time.perf_counter() - started)


def publish_slowly() -> None:
    from std_msgs.msg import String

    node, executor = _node("publisher")
    publisher = node.create_publisher(String, "slowly", 10)
    node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
    end = time.monotonic() + 2
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.2)
    report(peak_kb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


ROLES: dict[str, Callable[..., None]] = {
    role.__name__: role
    for role in (receive_stream, send_stream, echo, ping, serve, call, tick, begin, publish_slowly)
}  # fmt: skip

if __name__ == "__main__":
    ROLES[sys.argv[1]](*sys.argv[2:])
