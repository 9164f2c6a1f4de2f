"""What the wires carry beneath rclpy: streams and round trips between two sessions' processes, and finding each other.

No executor and no callback take part: the thread that takes decodes at once. The figures of rclpy lie above these.
"""

from __future__ import annotations

import importlib.util
import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from sensor_msgs.msg import Image
from std_msgs.msg import Int64, String

from daidalos.transport.environment import read_environment
from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Qos
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend

MIDDLEWARES = {"zenoh": "rmw_zenoh_cpp", "dds": "rmw_cyclonedds_cpp"}
STREAM_S = 3.0
LARGE_BYTES = 2**20
ROUND_TRIPS = 3000
WARM = 300
DEPTH = 1000
LARGE_DEPTH = 10
TOPICS, NODES = 1000, 200
PUBLISHERS = 3000
LOCALHOST = (
    "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General><Discovery>"
    '<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers>'
    "</Discovery></Domain></CycloneDDS>"
)
"""Configuration that ROS 2 gives DDS where its range is this machine."""
IMAGES, IMAGE_BYTES, IMAGE_DEPTH = 5, 16_000_000, 5
TIMER_S, TIMER_HZ = 8.0, 10
REPEATS = 3
TIMEOUT_S = 30.0


def run() -> dict[str, float]:
    """Measure everything; medians of three."""
    figures = {"transport.copy_1_mib_us": measure_copy()}
    with tempfile.TemporaryDirectory(prefix="dd") as folder:  # nobody else is met
        os.environ |= {"XDG_RUNTIME_DIR": folder, "ROS_DOMAIN_ID": str(60 + os.getpid() % 30)}
        for name, middleware in MIDDLEWARES.items():
            if name == "dds" and importlib.util.find_spec("cyclonedds") is None:
                continue
            os.environ["RMW_IMPLEMENTATION"] = middleware
            measured = [measure_wire() for _ in range(REPEATS)]
            for figure in measured[0]:
                figures[f"transport.{name}_{figure}"] = statistics.median(one[figure] for one in measured)
    return figures


def measure_copy() -> float:
    """Return what one copy of a mebibyte takes: the floor of encoding or decoding it."""
    data = os.urandom(LARGE_BYTES)
    times = []
    for _ in range(200):
        begin = time.perf_counter()
        bytearray(data)
        times.append(time.perf_counter() - begin)
    return statistics.median(times) * 1e6


def measure_wire() -> dict[str, float]:
    figures: dict[str, float] = {}
    sent, received, seconds = stream("small")
    figures |= {"small_received_per_s": received / seconds, "small_lost": sent - received}
    sent, received, seconds = stream("large")
    figures |= {"large_received_per_s": received / seconds, "large_lost": sent - received}
    with other("echo"):
        times = sorted(round_trips())
    figures["round_trip_p50_us"] = times[len(times) // 2]
    figures["round_trip_p99_us"] = times[len(times) * 99 // 100]
    figures |= measure_ends() | measure_timer() | {"3000_publishers_s": measure_publishers()}
    if os.environ["RMW_IMPLEMENTATION"] == MIDDLEWARES["dds"]:
        figures |= measure_images()
    with other("crowd"):
        begin = time.perf_counter()
        with session() as (ours, _):
            ours.backend.settle(TIMEOUT_S)
            figures["graph_of_1000_topics_s"] = time.perf_counter() - begin
            figures["graph_of_1000_topics_missing"] = TOPICS - len(ours.graph.endpoints(EndpointKind.PUBLISHER))
    return figures


def measure_ends() -> dict[str, float]:
    """Return what it takes to open and to close a session, in ms."""
    begin = time.perf_counter()
    made = Session(make_backend(read_environment()))
    opened = time.perf_counter()
    made.close()
    return {"start_ms": (opened - begin) * 1e3, "end_ms": (time.perf_counter() - opened) * 1e3}


def measure_timer() -> dict[str, float]:
    """Return what a publisher at 10 Hz costs while another process listens, in percent of a core."""
    with other("count-small"), session() as (ours, node):
        publisher = ours.create_publisher(node, "/stream", String, Qos())
        ours.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        used, end = time.process_time(), time.perf_counter() + TIMER_S
        while time.perf_counter() < end:
            publisher.publish(String(data="x"))
            time.sleep(1 / TIMER_HZ)
        return {"10_hz_cpu_percent": 100 * (time.process_time() - used) / TIMER_S}


def measure_publishers() -> float:
    """Return how long it takes to create many publishers while another process watches."""
    with other("echo"), session() as (ours, node):
        begin = time.perf_counter()
        kept = [ours.create_publisher(node, f"/topic{number}", String, Qos()) for number in range(PUBLISHERS)]
        seconds = time.perf_counter() - begin
        assert kept
        return seconds


def measure_images() -> dict[str, float]:
    """Send large images, as many as the depth, to a process that behaves as ROS 2's middleware."""
    root = Path(__file__).parents[1]
    peer = subprocess.Popen(
        [sys.executable, "-P", str(root / "tests" / "transport" / "cyclonedds" / "jazzy_peer.py"), "images"],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(root / "tests"), *sys.path]), "CYCLONEDDS_URI": LOCALHOST},
    )
    assert peer.stdout is not None
    try:
        assert peer.stdout.readline() == "ready\n"
        with session() as (ours, node):
            publisher = ours.create_publisher(node, "/image", Image, Qos(depth=IMAGE_DEPTH))
            ours.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
            message, begin = Image(data=bytes(IMAGE_BYTES)), time.perf_counter()
            for _ in range(IMAGES):
                publisher.publish(message)
            timeout = threading.Timer(TIMEOUT_S, peer.terminate)
            timeout.start()
            received = sum(1 for _ in zip(range(IMAGES), peer.stdout, strict=False))
            seconds = time.perf_counter() - begin
            timeout.cancel()
    finally:
        peer.kill()
        peer.wait()
    return {"16_mb_images_s": seconds, "16_mb_images_lost": IMAGES - received}


@contextmanager
def session() -> Iterator[tuple[Session, Any]]:
    """Return a session and a node."""
    made = Session(make_backend(read_environment()))
    node, remove = made.create_node(f"bench{os.getpid()}", "/")
    try:
        yield made, node
    finally:
        remove()
        made.close()


@contextmanager
def other(role: str) -> Iterator[subprocess.Popen[str]]:
    """Run a role of this file in a process of its own."""
    process = subprocess.Popen(
        [sys.executable, "-m", "benchmarks.transport", role], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        yield process
    finally:
        process.kill()
        process.wait()


def stream(size: str) -> tuple[int, int, float]:
    """Send as fast as it goes; return how many were sent and received, and the seconds that it took to receive."""
    message, depth = _message(size)
    with other(f"count-{size}") as process, session() as (ours, node):
        publisher = ours.create_publisher(node, "/stream", type(message), Qos(depth=depth))
        ours.graph.wait_for(lambda: publisher.has_subscribers, TIMEOUT_S)
        sent, end = 0, time.perf_counter() + STREAM_S
        while time.perf_counter() < end:
            publisher.publish(message)
            sent += 1
        received, seconds = json.loads(process.communicate("done\n", timeout=60)[0])
        return sent, received, seconds


def count(size: str) -> None:
    """Receive until nothing has come for a moment after the sender said that it is done."""
    message, depth = _message(size)
    with session() as (ours, node):
        news = threading.Event()
        subscription = ours.create_subscription(node, "/stream", type(message), Qos(depth=depth), news.set)
        done = threading.Thread(target=sys.stdin.readline, daemon=True)
        done.start()
        print("ready", flush=True)
        received, begin, last = 0, 0.0, 0.0
        while news.wait(0.5) or done.is_alive():
            news.clear()
            while subscription.take() is not None:
                last = time.perf_counter()
                begin = begin or last
                received += 1
        print(json.dumps([received, max(last - begin, 1e-9)]), flush=True)


def _message(size: str) -> tuple[Any, int]:
    return (String(data="x" * 64), DEPTH) if size == "small" else (Image(data=bytes(LARGE_BYTES)), LARGE_DEPTH)


def round_trips() -> list[float]:
    """Return how long a number takes to the other process and back, in microseconds."""
    with session() as (ours, node):
        arrived: SimpleQueue[None] = SimpleQueue()
        subscription = ours.create_subscription(node, "/pong", Int64, Qos(), lambda: arrived.put(None))
        publisher = ours.create_publisher(node, "/ping", Int64, Qos())
        ours.graph.wait_for(
            lambda: publisher.has_subscribers and bool(ours.graph.endpoints(EndpointKind.PUBLISHER, name="/pong")),
            TIMEOUT_S,
        )
        time.sleep(0.2)
        times = []
        for number in range(ROUND_TRIPS + WARM):
            begin = time.perf_counter()
            publisher.publish(Int64(data=number))
            arrived.get()
            subscription.take()
            times.append((time.perf_counter() - begin) * 1e6)
        return times[WARM:]


def echo() -> None:
    """Send every number back."""
    with session() as (ours, node):
        publisher = ours.create_publisher(node, "/pong", Int64, Qos())
        arrived: SimpleQueue[None] = SimpleQueue()
        subscription = ours.create_subscription(node, "/ping", Int64, Qos(), lambda: arrived.put(None))
        print("ready", flush=True)
        while True:
            arrived.get()
            while (taken := subscription.take()) is not None:
                publisher.publish(taken[0])


def crowd() -> None:
    """Create many nodes with many topics."""
    with session() as (ours, _):
        nodes = [ours.create_node(f"node{number}", "/") for number in range(NODES)]
        kept = [
            ours.create_publisher(nodes[number % NODES][0], f"/topic{number}", String, Qos())
            for number in range(TOPICS)
        ]
        print("ready", flush=True)
        sys.stdin.read()
        assert kept


ROLES = {
    "count-small": lambda: count("small"),
    "count-large": lambda: count("large"),
    "echo": echo,
    "crowd": crowd,
}

if __name__ == "__main__":
    ROLES[sys.argv[1]]()
