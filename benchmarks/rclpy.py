"""What rclpy costs: messages as bytes, streams, round trips and calls between processes, timers, starting, memory.

Set-ups are those by which the figures of ROS 2's own rclpy were taken: two processes, a single-threaded executor each.
"""

from __future__ import annotations

import array
import itertools
import json
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

STREAM_S = 5.0
TIMER_S = 8.0
ROUND_TRIPS = 5000
CALLS = 3000
WARM = 300
STARTS = 7
DEPTHS = {"String": 1000, "Image": 10, "PointCloud2": 10}
DDS = "rmw_cyclonedds_cpp"


def run() -> dict[str, float]:
    """Measure everything; times are medians."""
    figures = measure_codecs() | measure_streams() | measure_latencies("") | measure_timer() | measure_start()
    figures |= measure_memory()
    if _has_dds():
        os.environ["RMW_IMPLEMENTATION"] = DDS
        figures |= measure_latencies("dds_")
    return {f"rclpy.{name}": value for name, value in figures.items()}


def measure_codecs() -> dict[str, float]:
    from rclpy.serialization import deserialize_message, serialize_message

    figures = {}
    for name in MESSAGES:
        message = MESSAGES[name]()
        data, kind = serialize_message(message), type(message)
        figures[f"serialize_{name}_us"] = _median_us(lambda message=message: serialize_message(message))
        figures[f"deserialize_{name}_us"] = _median_us(lambda data=data, kind=kind: deserialize_message(data, kind))
    return figures


def _median_us(function: Callable[[], Any], batches: int = 9) -> float:
    function()
    begin = time.perf_counter()
    function()
    count = max(int(0.02 / max(time.perf_counter() - begin, 1e-7)), 5)
    times = []
    for _ in range(batches):
        begin = time.perf_counter()
        for _ in range(count):
            function()
        times.append((time.perf_counter() - begin) / count * 1e6)
    return statistics.median(times)


def measure_streams() -> dict[str, float]:
    figures = {}
    for name in DEPTHS:
        with _role("receive_stream", name) as receiver:
            sent = _result(_start("send_stream", name))
            received = _result(receiver)
        figures[f"{name}_received_per_s"] = received["count"] / received["seconds"]
        figures[f"{name}_lost"] = sent["count"] - received["count"]
    return figures


def measure_latencies(prefix: str) -> dict[str, float]:
    figures = {}
    for server, client, name in (("echo", "ping", "round_trip"), ("serve", "call", "service_call")):
        with _role(server):
            times = sorted(_result(_start(client))["times"])
        figures[f"{prefix}{name}_p50_us"] = times[len(times) // 2] * 1e6
        figures[f"{prefix}{name}_p99_us"] = times[len(times) * 99 // 100] * 1e6
    return figures


def measure_timer() -> dict[str, float]:
    result = _result(_start("tick"))
    jitter = sorted(abs(after - before - 0.001) for before, after in itertools.pairwise(result["ticks"]))
    return {
        "timer_1khz_cpu_percent": 100 * result["cpu"] / result["seconds"],
        "timer_1khz_jitter_p99_us": jitter[len(jitter) * 99 // 100] * 1e6,
    }


def measure_start() -> dict[str, float]:
    return {"start_ms": statistics.median(_result(_start("begin"))["seconds"] for _ in range(STARTS)) * 1e3}


def measure_memory() -> dict[str, float]:
    return {"one_publisher_mb": _result(_start("publish_slowly"))["peak_kb"] / 1024}


# Processes.


def _start(role: str, *arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "benchmarks.rclpy", role, *arguments]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@contextmanager
def _role(role: str, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Have a process meanwhile that has said that it is ready; it ends when its input does."""
    process = _start(role, *arguments)
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        yield process
    finally:
        with suppress(BrokenPipeError):
            process.communicate(timeout=20)
        process.kill()


def _result(process: subprocess.Popen[str]) -> dict[str, Any]:
    output, _ = process.communicate(timeout=180)
    return dict(json.loads(output.splitlines()[-1]))


def _report(**values: Any) -> None:
    print(json.dumps(values), flush=True)


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
    print("ready", flush=True)
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
    _report(count=count, seconds=max(last - first, 1e-9))


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
    _report(count=count)


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
    _report(times=times[WARM:])


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
    _report(times=times[WARM:])


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
    _report(ticks=ticks, cpu=_cpu_s() - before, seconds=TIMER_S)


def begin() -> None:
    started = time.perf_counter()
    import rclpy

    rclpy.init()
    node = rclpy.create_node("started")
    node.destroy_node()
    rclpy.shutdown()
    _report(seconds=time.perf_counter() - started)


def publish_slowly() -> None:
    from std_msgs.msg import String

    node, executor = _node("publisher")
    publisher = node.create_publisher(String, "slowly", 10)
    node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
    end = time.monotonic() + 2
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.2)
    _report(peak_kb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


# Messages.


def _string() -> Any:
    from std_msgs.msg import String

    return String(data="x" * 64)


def _joint_state() -> Any:
    from sensor_msgs.msg import JointState

    values = [0.1 * number for number in range(20)]
    names = [f"joint_{number}" for number in range(20)]
    return JointState(name=names, position=values, velocity=values, effort=values)


def _laser_scan() -> Any:
    from sensor_msgs.msg import LaserScan

    return LaserScan(range_max=30.0, ranges=[0.01 * number for number in range(720)])


def _image() -> Any:
    from sensor_msgs.msg import Image

    return Image(height=480, width=640, encoding="rgb8", step=1920, data=array.array("B", bytes(921600)))


def _odometry() -> Any:
    from nav_msgs.msg import Odometry

    message = Odometry(child_frame_id="base_link")
    message.header.frame_id = "odom"
    return message


def _tf_message() -> Any:
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    return TFMessage(transforms=[TransformStamped(child_frame_id=f"link_{number}") for number in range(20)])


def _point_cloud() -> Any:
    from sensor_msgs.msg import PointCloud2, PointField

    fields = [PointField(name=name, offset=4 * place, datatype=7, count=1) for place, name in enumerate("xyzi")]
    data = array.array("B", bytes(1048576))
    return PointCloud2(height=1, width=65536, point_step=16, row_step=1048576, fields=fields, data=data)


MESSAGES: dict[str, Callable[[], Any]] = {
    "String": _string,
    "JointState": _joint_state,
    "LaserScan": _laser_scan,
    "Image": _image,
    "Odometry": _odometry,
    "TFMessage": _tf_message,
    "PointCloud2": _point_cloud,
}
ROLES: dict[str, Callable[..., None]] = {
    role.__name__: role
    for role in (receive_stream, send_stream, echo, ping, serve, call, tick, begin, publish_slowly)
}  # fmt: skip

if __name__ == "__main__":
    ROLES[sys.argv[1]](*sys.argv[2:])
