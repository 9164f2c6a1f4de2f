"""Bags, programs that run behind a terminal, and a node that listens and talks in the same domain."""

import os
import pty
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.writer import BagWriter, WriterOptions

from ..commands import ROS2

TIMEOUT_S = 40.0
SECOND = 1_000_000_000


def write_bag(folder: Path, count: int, *, storage: str = "mcap", period_ns: int = 10_000_000, **options) -> Path:
    """Write a bag with numbers on /chatter, from second 1 on."""
    with BagWriter(folder, WriterOptions(storage, **options)) as bag:
        bag.add_topic(Topic("/chatter", "std_msgs/msg/String", type_hash=String._TYPE_HASH))
        for k in range(count):
            data = serialize_message(String(data=str(k)))
            bag.write(BagMessage("/chatter", data, SECOND + k * period_ns, SECOND + k * period_ns))
    return folder


class Program:
    """`ros2` with these words, at work behind a terminal or a pipe; ended with the test."""

    def __init__(self, *words: str, env: dict[str, str], cwd: Path, terminal: bool = False, prepare=None) -> None:
        self.text = ""
        self._news = threading.Condition()
        ours, theirs = pty.openpty() if terminal else os.pipe()
        self._ours = ours
        self._process = subprocess.Popen(
            [*ROS2, *words],
            stdin=theirs if terminal else subprocess.DEVNULL,
            stdout=theirs,
            stderr=theirs,
            env=env | {"PYTHONUNBUFFERED": "1"},
            cwd=cwd,
            start_new_session=True,
            preexec_fn=prepare,
        )
        os.close(theirs)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        while True:
            try:
                data = os.read(self._ours, 65536)
            except OSError:  # nobody is at the other end any more
                data = b""
            with self._news:
                self.text += data.decode(errors="replace").replace("\r\n", "\n")
                self._news.notify_all()
            if not data:
                return

    def wait_for(self, text: str) -> None:
        """Wait until it has printed a text."""
        with self._news:
            assert self._news.wait_for(lambda: text in self.text, TIMEOUT_S), f"no {text!r} in:\n{self.text}"

    def press(self, keys: str) -> None:
        """Press keys."""
        os.write(self._ours, keys.encode())

    def end(self, number: int = signal.SIGINT) -> int:
        """Send a signal and return the exit status."""
        self._process.send_signal(number)
        return self.finish()

    def finish(self) -> int:
        """Wait for its end and return the exit status."""
        status = self._process.wait(TIMEOUT_S)
        self._reader.join(TIMEOUT_S)
        return status

    def close(self) -> None:
        """Kill it."""
        self._process.kill()
        self._process.wait()
        self._reader.join(TIMEOUT_S)
        os.close(self._ours)


@pytest.fixture
def ros2_bag(env: dict[str, str], tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Start ``ros2 bag`` with some words."""
    running: list[Program] = []

    def start(*words: object, **options: object) -> Program:
        program = Program("bag", *map(str, words), env=env, cwd=tmp_path, **options)
        running.append(program)
        return program

    yield start
    for program in running:
        program.close()


class Partner:
    """A node that hears numbers on /chatter and says some."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.numbers: list[int] = []
        self.times: list[float] = []
        self._news = threading.Condition()

    def listen(self, topic: str = "/chatter") -> None:
        """Hear numbers from now on."""
        self.node.create_subscription(String, topic, self._receive, QoSProfile(depth=1000))

    def _receive(self, message: String) -> None:
        with self._news:
            self.numbers.append(int(message.data))
            self.times.append(time.monotonic())
            self._news.notify_all()

    def wait_for(self, count: int) -> list[int]:
        """Wait until so many numbers were heard, and return them."""
        with self._news:
            assert self._news.wait_for(lambda: len(self.numbers) >= count, TIMEOUT_S), self.numbers
        return self.numbers

    def talk(self, numbers: range) -> None:
        """Publish numbers as soon as somebody listens."""
        publisher = self.node.create_publisher(String, "/chatter", QoSProfile(depth=1000))
        assert self.node.handle.graph.wait_for(lambda: publisher.get_subscription_count() > 0, TIMEOUT_S)
        for number in numbers:
            publisher.publish(String(data=str(number)))


@pytest.fixture
def partner(env: dict[str, str]) -> Iterator[Partner]:
    """A node in the test's domain, whose callbacks run."""
    context = Context()
    rclpy.init(args=[], context=context, domain_id=int(env["ROS_DOMAIN_ID"]))
    node = Node("partner", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    ended = threading.Event()

    def spin() -> None:
        while not ended.is_set():
            executor.spin_once(0.2)

    thread = threading.Thread(target=spin, daemon=True)
    thread.start()
    yield Partner(node)
    ended.set()
    thread.join()
    executor.shutdown()
    node.destroy_node()
    context.destroy()
