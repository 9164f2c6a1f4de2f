"""What transforms cost: inserting, looking up, transforming messages, waiting, and listening to another process."""

from __future__ import annotations

import math
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import psutil
import rclpy
import tf2_geometry_msgs
from geometry_msgs.msg import PoseStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.time import Time
from tf2_msgs.msg import TFMessage
from tf2_py import BufferCore
from tf2_ros import Buffer, TransformListener

SECOND = 1_000_000_000
START = 1_700_000_000 * SECOND
CHAIN = 5
SAMPLES = 1000
RATE_HZ = 100
FRAMES = 20
LISTEN_S = 4.0
SENDER = """
import sys, time
from benchmarks.tf import FRAMES, RATE_HZ, sample
import rclpy
from tf2_msgs.msg import TFMessage

rclpy.init()
node = rclpy.create_node("sender")
publisher = node.create_publisher(TFMessage, "/tf", 100)
message = TFMessage(transforms=[sample("map", f"frame{number}", 0) for number in range(FRAMES)])
print("ready", flush=True)
begin, count = time.monotonic(), 0
while True:
    count += 1
    for transform in message.transforms:
        transform.header.stamp.sec, transform.header.stamp.nanosec = divmod(count * 10_000_000, 1_000_000_000)
    publisher.publish(message)
    time.sleep(max(begin + count / RATE_HZ - time.monotonic(), 0.0))
"""


def run() -> dict[str, float | str]:
    """Measure everything; times are medians."""
    return measure_buffer() | measure_messages() | measure_waiting() | measure_listening()


def sample(parent: str, child: str, stamp: int, yaw: float = 0.1) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    message.transform.translation.x = 1.0
    message.transform.rotation.z, message.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def microseconds(work: Callable[[], object], count: int) -> float:
    rounds = []
    for _ in range(9):
        begin = time.perf_counter()
        for _ in range(count):
            work()
        rounds.append((time.perf_counter() - begin) / count * 1e6)
    return statistics.median(rounds)


def measure_buffer() -> dict[str, float | str]:
    """Insert into, and look up in, a chain of frames that hold ten seconds at 100 Hz."""
    buffer = BufferCore()
    for step in range(SAMPLES):
        for level in range(CHAIN):
            message = sample(f"f{level}", f"f{level + 1}", START + step * SECOND // 100, 0.1 + 1e-4 * step)
            buffer.set_transform(message, "benchmark")
    between = Time(nanoseconds=START + 5 * SECOND + 3_000_000)
    last = f"f{CHAIN}"
    results: dict[str, float | str] = {
        "tf.lookup_chain_of_5_us": microseconds(lambda: buffer.lookup_transform_core("f0", last, between), 1000),
        "tf.lookup_chain_of_5_latest_us": microseconds(lambda: buffer.lookup_transform_core("f0", last, Time()), 1000),
        "tf.can_transform_us": microseconds(lambda: buffer.can_transform_core("f0", last, Time()), 1000),
    }
    messages = iter([sample("f0", "f1", START + (SAMPLES + step) * SECOND // 100) for step in range(9 * 2000)])
    results["tf.insert_us"] = microseconds(lambda: buffer.set_transform(next(messages), "benchmark"), 2000)
    return results


def measure_messages() -> dict[str, float | str]:
    """Transform a pose."""
    transform, pose = sample("a", "b", START), PoseStamped()
    work = lambda: tf2_geometry_msgs.do_transform_pose_stamped(pose, transform)  # noqa: E731
    return {"tf.transform_pose_us": microseconds(work, 1000)}


def measure_waiting() -> dict[str, float | str]:
    """Measure how long after the transform a waiting caller goes on, and what waiting costs."""
    buffer = Buffer()
    delays = []
    for step in range(1, 31):
        inserted: list[float] = []

        def insert(stamp: int = step, inserted: list[float] = inserted) -> None:
            while not buffer._watchers:
                time.sleep(0.0005)
            time.sleep(0.002)
            inserted.append(time.perf_counter())
            buffer.set_transform(sample("a", "b", stamp * SECOND), "benchmark")

        thread = threading.Thread(target=insert)
        thread.start()
        buffer.lookup_transform("a", "b", Time(seconds=step), Duration(seconds=10))
        delays.append((time.perf_counter() - inserted[0]) * 1e6)
        thread.join()
    before = time.process_time()
    buffer.can_transform("a", "nowhere", Time(), Duration(seconds=1))
    return {
        "tf.wake_after_insert_us": statistics.median(delays),
        "tf.waiting_cpu_percent": 100 * (time.process_time() - before),
    }


def measure_listening() -> dict[str, float | str]:
    """Listen to 20 transforms a message at 100 Hz from another process: our share of a core, executor spinning."""
    sender = subprocess.Popen([sys.executable, "-c", SENDER], stdout=subprocess.PIPE, text=True)
    try:
        assert sender.stdout is not None
        sender.stdout.readline()
        return {
            "tf.listener_cpu_percent": _share(lambda node: TransformListener(Buffer(), node)),
            "tf.plain_subscription_cpu_percent": _share(
                lambda node: node.create_subscription(TFMessage, "/tf", lambda message: None, 100)
            ),
            "tf.idle_node_cpu_percent": _share(lambda node: None),
        }
    finally:
        sender.kill()
        sender.wait()


def _share(prepare: Callable[[rclpy.node.Node], object]) -> float:
    rclpy.init(args=[])
    node = rclpy.create_node("receiver")
    kept = prepare(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def spin() -> None:
        try:
            executor.spin()
        except ExternalShutdownException:
            return

    thread = threading.Thread(target=spin)
    thread.start()
    time.sleep(1.0)
    process = psutil.Process()
    before = sum(process.cpu_times()[:2])
    time.sleep(LISTEN_S)
    share = 100 * (sum(process.cpu_times()[:2]) - before) / LISTEN_S
    executor.shutdown()
    thread.join()
    del kept
    node.destroy_node()
    rclpy.shutdown()
    return share


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:40} {value:.2f}" if isinstance(value, float) else f"{name:40} {value}")
