"""Measurements during the test drive: true motion, estimates and system load."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import psutil
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.pose2 import between
from daidalos.nodes.conversions import pose2_of, pose2_of_transform
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import nanoseconds


class TruthRecorder:
    """Recorder of the robot's true pose and of the error of its estimate.

    Parameters
    ----------
    node
        The node to listen with.
    buffer
        Transforms.
    robot
        The robot's name in the simulation.
    map_frame, base_frame
        The world's frame is taken to be the map's: the robot begins at the origin.
    """

    def __init__(self, node: Node, buffer: Buffer, robot: str, map_frame: str, base_frame: str) -> None:
        from gazebo_msgs.msg import ContactsState, ModelStates
        from rosgraph_msgs.msg import Clock

        self._buffer = buffer
        self._robot = robot
        self._frames = (map_frame, base_frame)
        self._now_ns = 0
        self._waiting: list[tuple[int, Any]] = []
        self._squares: list[float] = []
        self.pose: Any = None
        self.travelled = 0.0
        self.contacts: list[str] = []
        node.create_subscription(Clock, "/clock", self._on_clock, 10)
        node.create_subscription(ModelStates, "/gazebo/model_states", self._on_states, 10)
        node.create_subscription(ContactsState, "/gazebo/contacts", self._on_contacts, LATCHED)

    @property
    def localization_rmse(self) -> float:
        """Root mean square of the distance [m] between the believed and the true position."""
        return math.sqrt(sum(self._squares) / len(self._squares)) if self._squares else math.nan

    @property
    def now_s(self) -> float:
        """Simulated time."""
        return self._now_ns * 1e-9

    def _on_clock(self, message: Any) -> None:
        self._now_ns = nanoseconds(message.clock)

    def _on_states(self, message: Any) -> None:
        if self._robot not in message.name:
            return
        pose = pose2_of(message.pose[message.name.index(self._robot)])
        if self.pose is not None:
            self.travelled += float(np.hypot(*(pose[:2] - self.pose[:2])))
        self.pose = pose
        # The states carry no stamp; the clock that came before them does.
        self._waiting.append((self._now_ns, pose))
        self._compare()

    def _compare(self) -> None:
        """Compare the true poses for which transforms have come by now."""
        for _ in range(len(self._waiting)):
            stamp, pose = self._waiting[0]
            try:
                found = self._buffer.lookup_transform(*self._frames, Time(nanoseconds=stamp))
            except TransformException:
                if self._now_ns - stamp < 500_000_000:
                    return  # it may still come
                self._waiting.pop(0)
                continue
            self._waiting.pop(0)
            gap = between(pose2_of_transform(found.transform), pose)
            self._squares.append(float(gap[0] ** 2 + gap[1] ** 2))

    def _on_contacts(self, message: Any) -> None:
        self.contacts = [f"{state.collision1_name} - {state.collision2_name}" for state in message.states]


@dataclass
class Load:
    """Resources used by a tree of processes.

    Attributes
    ----------
    cpu_percent : float
        Of one core, on average.
    peak_rss_mb : float
        Largest sum of the processes' resident memory.
    processes : int
        Largest number of processes at one time.
    """

    cpu_percent: float = 0.0
    peak_rss_mb: float = 0.0
    processes: int = 0


@dataclass
class LoadRecorder:
    """Samples a process with all that it started, until `stop`."""

    root: int
    period_s: float = 0.5
    _load: Load = field(default_factory=Load)
    _ended: threading.Event = field(default_factory=threading.Event)
    _cpu: dict[int, tuple[float, float]] = field(default_factory=dict)

    def start(self) -> None:
        """Start to measure."""
        self._begun = time.monotonic()
        self._thread = threading.Thread(target=self._run, name="load", daemon=True)
        self._thread.start()

    def stop(self) -> Load:
        """Return what was used since `start`."""
        self._ended.set()
        self._thread.join()
        spent = sum(last - first for first, last in self._cpu.values())
        self._load.cpu_percent = 100.0 * spent / max(time.monotonic() - self._begun, 1e-9)
        return self._load

    def _run(self) -> None:
        while not self._ended.wait(self.period_s):
            self._sample()

    def _sample(self) -> None:
        resident, count = 0, 0
        for process in _family(self.root):
            try:
                with process.oneshot():
                    times = process.cpu_times()
                    resident += process.memory_info().rss
            except psutil.Error:
                continue  # it has just ended
            count += 1
            used = times.user + times.system
            self._cpu[process.pid] = (self._cpu.get(process.pid, (used, used))[0], used)
        self._load.peak_rss_mb = max(self._load.peak_rss_mb, resident / 2**20)
        self._load.processes = max(self._load.processes, count)


def _family(root: int) -> list[psutil.Process]:
    try:
        process = psutil.Process(root)
        return [process, *process.children(recursive=True)]
    except psutil.Error:
        return []
