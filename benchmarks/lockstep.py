"""Speed of lock-step runs: simulated seconds in a second of processor time by scenario, what a message, a timer and a
switch of threads cost, and the curve over the number of robots.

Each run is a process, which ends at a simulated time; its processor time is that of the child. What a run costs before
its first step is measured by a short one and subtracted, so that figures do not depend on how long a run is.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

FLEET = tuple(int(count) for count in os.environ.get("DAIDALOS_BENCHMARK_ROBOTS", "1,2,10,50").split(","))
"""Numbers of robots; fifty of them take a quarter of an hour of one core."""

SCENARIOS: dict[str, tuple[list[str], float, float]] = {
    "turtlesim": (["turtlesim", "multisim.launch.py"], 1.0, 1000.0),
    "waffle_lidar": (["lidar.launch.py"], 5.0, 60.0),
    "arena": (["daidalos_demo", "demo.launch.py", "studio:=false"], 15.0, 75.0),
}
"""Launch files, with the simulated times [s] of the short and the long run."""

LIDAR = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    arena = PathJoinSubstitution([FindPackageShare("turtlebot3_gazebo"), "launch", "turtlebot3_arena.launch.py"])
    return LaunchDescription([
        IncludeLaunchDescription(arena), ExecuteProcess(cmd=["ros2", "topic", "hz", "/scan"], output="log"),
    ])
"""
MESSAGES = """
import rclpy
from rclpy.clock import Clock, ClockType
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("node")
publisher = node.create_publisher(String, "topic", 10)
message, got = String(data="hello"), []
node.create_subscription(String, "topic", got.append, 10)
while len(got) < {count}:
    publisher.publish(message)
    rclpy.spin_once(node)
"""
TIMERS = """
import rclpy

rclpy.init()
node = rclpy.create_node("node")
ticks = []
node.create_timer(0.001, lambda: ticks.append(1))
while len(ticks) < {count}:
    rclpy.spin_once(node)
"""
SWITCHES = """
import threading

there, back = threading.Semaphore(0), threading.Semaphore(0)

def player():
    for _ in range({count} // 2):
        there.acquire()
        back.release()

threading.Thread(target=player).start()
for _ in range({count} // 2):
    there.release()
    back.acquire()
"""
LOOPS = {"message": MESSAGES, "timer": TIMERS, "switch": SWITCHES}
COUNT = 20_000


def run() -> dict[str, float | str]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "lidar.launch.py").write_text(LIDAR)
        figures: dict[str, float | str] = {}
        for name, text in LOOPS.items():
            figures[f"lockstep.{name}_us"] = 1e6 * _cost_of_loop(folder, text, in_lockstep=True)
            figures[f"lockstep.{name}_in_real_time_us"] = 1e6 * _cost_of_loop(folder, text, in_lockstep=False)
        for name, (words, short_s, long_s) in SCENARIOS.items():
            figures[f"lockstep.{name}_times_real_time"] = _speed(folder, words, short_s, long_s)
        for count in FLEET:
            words = ["daidalos_demo", "fleet.launch.py", f"robots:={count}"]
            figures[f"lockstep.robots_{count:02}_times_real_time"] = _speed(folder, words, 8.0, 18.0)
        figures["lockstep.peak_mb"] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    _print_curve(figures)
    return figures


def _cost_of_loop(folder: Path, text: str, *, in_lockstep: bool) -> float:
    """Return the processor time [s] of one turn of a loop."""
    times = []
    for count in (COUNT, 2 * COUNT):
        path = folder / f"loop_{count}.py"
        path.write_text(text.format(count=count))
        start = [sys.executable, "-m", "daidalos.lockstep.start", "--"] if in_lockstep else []
        times.append(_processor_time([*start, sys.executable, str(path)], folder))
    return (times[1] - times[0]) / COUNT


def _speed(folder: Path, words: list[str], short_s: float, long_s: float) -> float:
    """Return the simulated seconds in a second of processor time between two times of a launch."""
    launch = [sys.executable, "-m", "daidalos.cli.ros2", "launch", "--lockstep"]
    times = [_processor_time([*launch, "--until", str(until), *words], folder) for until in (short_s, long_s)]
    return (long_s - short_s) / (times[1] - times[0])


def _processor_time(command: list[str], folder: Path) -> float:
    environment = os.environ | {"RMW_IMPLEMENTATION": "rmw_daidalos_inprocess", "PYTHONHASHSEED": "0"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _print_curve(figures: dict[str, float | str]) -> None:
    """Print what a simulated second costs over the number of robots, as bars."""
    costs = {count: 1.0 / float(figures[f"lockstep.robots_{count:02}_times_real_time"]) for count in FLEET}
    most = max(costs.values(), default=1.0)
    for count, cost in costs.items():
        print(f"{count:3} robots {cost:8.2f} s a simulated second {'#' * round(40 * cost / most)}")
