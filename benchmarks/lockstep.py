"""Speed of lock-step runs: simulated seconds in a second of processor time by scenario, and what a message, a timer and
a switch of threads cost.

Each run is a process, which ends at a simulated time; its processor time is that of the child. What a run costs before
its first step is measured by a short one and subtracted, so that figures do not depend on how long a run is.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from benchmarks.runs import launch_until, measure

SCENARIOS: dict[str, tuple[list[str], float, float]] = {
    "turtlesim": (["turtlesim", "multisim.launch.py"], 1.0, 20_000.0),
    "turtlesim_driven": (["square.launch.py"], 1.0, 200.0),
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
SQUARE = """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    programs = ("turtlesim_node", "draw_square")
    return LaunchDescription([Node(package="turtlesim", executable=name) for name in programs])
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
        (folder / "square.launch.py").write_text(SQUARE)
        figures = _Figures()
        for name, text in LOOPS.items():
            figures[f"lockstep.{name}_us"] = 1e6 * _cost_of_loop(folder, text, in_lockstep=True)
            figures[f"lockstep.{name}_in_real_time_us"] = 1e6 * _cost_of_loop(folder, text, in_lockstep=False)
        for name, (words, short_s, long_s) in SCENARIOS.items():
            short, long = (launch_until(folder, until, *words) for until in (short_s, long_s))
            figures[f"lockstep.{name}_times_real_time"] = (long_s - short_s) / (long.seconds - short.seconds)
            figures[f"lockstep.{name}_peak_mb"] = long.peak_mb
    return figures


class _Figures(dict[str, float | str]):
    """Figures that are printed as they are measured: the last one comes half an hour after the first."""

    def __setitem__(self, name: str, value: float | str) -> None:
        super().__setitem__(name, value)
        text = f"{value:.4g}" if isinstance(value, float) else value
        print(f"  {name}: {text}", file=sys.stderr, flush=True)


def _cost_of_loop(folder: Path, text: str, *, in_lockstep: bool) -> float:
    """Return the processor time [s] of one turn of a loop."""
    times = []
    for count in (COUNT, 2 * COUNT):
        path = folder / f"loop_{count}.py"
        path.write_text(text.format(count=count))
        start = [sys.executable, "-m", "daidalos.lockstep.start", "--"] if in_lockstep else []
        times.append(measure([*start, sys.executable, str(path)], folder).seconds)
    return (times[1] - times[0]) / COUNT
