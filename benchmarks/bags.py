"""What bags cost: writing and reading files, recording and playing through processes, and what a kill -9 loses."""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil

from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.reader import BagReader
from daidalos.bags.storage import StorageOptions
from daidalos.bags.writer import BagWriter, WriterOptions

ROS2 = [sys.executable, "-m", "daidalos.cli.ros2"]
DOMAIN = 20 + os.getpid() % 80
TOPIC = Topic("/data", "std_msgs/msg/UInt8MultiArray")
SMALL, SMALL_COUNT = 100, 200_000
LARGE, LARGE_COUNT = 1_000_000, 200
STREAM_S = 4.0
PLAY_HZ, PLAY_S = 500, 4.0
SECOND = 1_000_000_000
SENDER = """
import sys, time
from array import array
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import UInt8MultiArray

rate, size, seconds = float(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
rclpy.init()
node = rclpy.create_node("sender")
publisher = node.create_publisher(UInt8MultiArray, "/data", QoSProfile(depth=1000))
node.handle.graph.wait_for(lambda: publisher.get_subscription_count() > 0)
message = UInt8MultiArray(data=array("B", bytes(size)))
begin, count = time.monotonic(), 0
while count < rate * seconds:
    due = (time.monotonic() - begin) * rate
    while count < min(due, rate * seconds):
        publisher.publish(message)
        count += 1
    time.sleep(0.001)
print(count, time.time_ns(), flush=True)
sys.stdin.readline()
"""


def run() -> dict[str, float]:
    """Measure everything."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        return measure_files(place) | measure_recording(place) | measure_playing(place)


def measure_files(place: Path) -> dict[str, float]:
    """Write and read bags in this process."""
    small = [BagMessage("/data", bytes(SMALL), SECOND + k, SECOND + k) for k in range(SMALL_COUNT)]
    noise = os.urandom(LARGE)
    large = [BagMessage("/data", noise, SECOND + k, SECOND + k) for k in range(LARGE_COUNT)]
    results = {}
    for name, options in (
        ("mcap", WriterOptions()),
        ("mcap_zstd", WriterOptions(storage=StorageOptions("zstd_fast"))),
        ("sqlite3", WriterOptions("sqlite3")),
    ):
        write_s, read_s = _write_and_read(place / f"small_{name}", options, small)
        results[f"bags.write_{name}_messages_per_s"] = SMALL_COUNT / write_s
        results[f"bags.read_{name}_messages_per_s"] = SMALL_COUNT / read_s
        write_s, read_s = _write_and_read(place / f"large_{name}", options, large)
        results[f"bags.write_{name}_mb_per_s"] = LARGE * LARGE_COUNT / write_s / 1e6
        results[f"bags.read_{name}_mb_per_s"] = LARGE * LARGE_COUNT / read_s / 1e6
    return results


def _write_and_read(folder: Path, options: WriterOptions, messages: list[BagMessage]) -> tuple[float, float]:
    begin = time.perf_counter()
    with BagWriter(folder, options) as writer:
        writer.add_topic(TOPIC)
        for message in messages:
            writer.write(message)
    written = time.perf_counter()
    with BagReader(folder) as bag:
        assert sum(1 for _ in bag.messages()) == len(messages)
    return written - begin, time.perf_counter() - written


def measure_recording(place: Path) -> dict[str, float]:
    """Record what another process sends: what is lost, and what it costs."""
    results = {}
    for name, rate, size in (("1_khz", 1000, SMALL), ("10_khz", 10_000, SMALL), ("100_mb_per_s", 100, LARGE)):
        with _recorder(place / name) as recorder:
            before = sum(recorder.cpu_times()[:2])
            sent, _ = _send(rate, size)
            results[f"bags.record_{name}_cpu_percent"] = 100 * (sum(recorder.cpu_times()[:2]) - before) / STREAM_S
        with BagReader(place / name) as bag:
            results[f"bags.record_{name}_lost"] = float(sent - bag.metadata.message_count)
    with _recorder(place / "killed", signal.SIGKILL):
        _, end_ns = _send(1000, SMALL, settle=False)
    with BagReader(place / "killed") as bag:
        results["bags.kill_9_lost_s"] = max(end_ns - bag.metadata.end_ns, 0) / 1e9
    begin = time.perf_counter()
    subprocess.run([*ROS2, "bag", "info", str(place / "10_khz")], check=True, stdout=subprocess.DEVNULL)
    results["bags.info_s"] = time.perf_counter() - begin
    return results


@contextmanager
def _recorder(folder: Path, end: int = signal.SIGINT) -> Iterator[psutil.Process]:
    """Record /data meanwhile."""
    process = subprocess.Popen(
        [*ROS2, "bag", "record", "-o", str(folder), "--topics", "/data"],
        env=_environment(),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        assert process.stderr is not None
        while "Recording..." not in process.stderr.readline():
            assert process.poll() is None
        yield psutil.Process(process.pid)
        process.send_signal(end)
        process.communicate()
    finally:
        process.kill()
        process.wait()


def _send(rate: float, size: int, *, settle: bool = True) -> tuple[int, int]:
    """Send messages; returns how many, and when the last one was sent (Unix time in nanoseconds)."""
    words = [sys.executable, "-c", SENDER, str(rate), str(size), str(STREAM_S)]
    with subprocess.Popen(
        words, env=_environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as sender:
        assert sender.stdout is not None
        count, end_ns = map(int, sender.stdout.readline().split())
        if settle:
            time.sleep(1.0)
            sender.communicate("\n")
        else:
            sender.kill()
    return count, end_ns


def measure_playing(place: Path) -> dict[str, float]:
    """Play to this process: how late messages come, and how fast at most."""
    import rclpy
    from rclpy.qos import QoSProfile
    from rclpy.serialization import serialize_message
    from std_msgs.msg import UInt8MultiArray

    count = int(PLAY_HZ * PLAY_S)
    data = serialize_message(UInt8MultiArray(data=bytes(SMALL)))
    with BagWriter(place / "play") as writer:
        writer.add_topic(Topic("/data", "std_msgs/msg/UInt8MultiArray", type_hash=UInt8MultiArray._TYPE_HASH))
        for k in range(count):
            writer.write(BagMessage("/data", data, SECOND + k * SECOND // PLAY_HZ, SECOND))
    context = rclpy.Context()
    rclpy.init(args=[], context=context, domain_id=DOMAIN)
    node = rclpy.create_node("listener", context=context)
    times: list[float] = []
    node.create_subscription(
        UInt8MultiArray, "/data", lambda message: times.append(time.monotonic()), QoSProfile(depth=5000)
    )
    executor = rclpy.executors.SingleThreadedExecutor(context=context)
    executor.add_node(node)
    ended = threading.Event()

    def spin() -> None:
        while not ended.is_set():
            executor.spin_once(0.1)

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        _play(place / "play")
        lost = count - len(times)
        offsets = sorted(at - k / PLAY_HZ for k, at in enumerate(times))
        late_ms = [1000 * (offset - offsets[0]) for offset in offsets]
        times.clear()
        _play(place / "play", "--rate", "1000")
        fastest = (len(times) - 1) / (times[-1] - times[0])
    finally:
        ended.set()
        thread.join()
        node.destroy_node()
        context.destroy()
    return {
        "bags.play_lost": float(lost),
        "bags.play_late_median_ms": statistics.median(late_ms),
        "bags.play_late_99_percent_ms": late_ms[int(len(late_ms) * 0.99)],
        "bags.play_fastest_messages_per_s": fastest,
    }


def _play(folder: Path, *words: str) -> None:
    done = subprocess.run(
        [*ROS2, "bag", "play", str(folder), *words], env=_environment(), stdin=subprocess.DEVNULL, capture_output=True
    )
    assert done.returncode == 0, done.stderr.decode()
    time.sleep(0.5)


def _environment() -> dict[str, str]:
    return os.environ | {"ROS_DOMAIN_ID": str(DOMAIN)}


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:40} {value:.4g}")
