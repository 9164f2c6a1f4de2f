"""The demonstration as a whole: how soon its robot moves, how well it drives, what it costs, how soon it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

DOMAIN = "94"
ENVIRONMENT = os.environ | {"ROS_DOMAIN_ID": DOMAIN}


def run() -> dict[str, float | str]:
    return measure_start() | measure_driving()


def measure_start() -> dict[str, float | str]:
    """Measure the demonstration with the studio but no page: until the robot moves, and until all has ended."""
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "demo", "--no-browser"]
    begun = time.perf_counter()
    process = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_for_motion()
        moving = time.perf_counter() - begun
    finally:
        begun = time.perf_counter()
        process.send_signal(signal.SIGINT)
        process.wait(timeout=30)
    return {"demo.moving_robot_s": moving, "demo.end_s": time.perf_counter() - begun}


def wait_for_motion() -> None:
    """Return when the robot's odometry says that it moves."""
    os.environ["ROS_DOMAIN_ID"] = DOMAIN
    import rclpy
    from nav_msgs.msg import Odometry

    rclpy.init()
    node = rclpy.create_node("watcher")
    moved: list[bool] = []

    def look(message: Any) -> None:
        twist = message.twist.twist
        if abs(twist.linear.x) > 0.05 or abs(twist.angular.z) > 0.2:
            moved.append(True)

    node.create_subscription(Odometry, "/odom", look, 10)
    until(lambda: bool(moved), lambda: rclpy.spin_once(node, timeout_sec=0.1))
    node.destroy_node()
    rclpy.shutdown()


def until(condition: Callable[[], bool], step: Callable[[], None], limit_s: float = 120.0) -> None:
    deadline = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {limit_s} s")
        step()


def measure_driving() -> dict[str, float | str]:
    """Three goals without a page."""
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "demo", "--headless", "--seed", "1", "--json"]
    done = subprocess.run(command, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    report = json.loads(done.stdout)
    goals = report["goals"]
    return {
        "demo.goals_reached": sum(goal["reached"] for goal in goals),
        "demo.contacts": report["contacts"],
        "demo.largest_position_error_m": max(goal["position_error_m"] for goal in goals),
        "demo.localization_rmse_m": report["localization_rmse_m"],
        "demo.map_walls_found": report["map"]["walls_found"],
        "demo.map_walls_true": report["map"]["walls_true"],
        "demo.real_time_factor": report["real_time_factor"],
        "demo.cpu_percent": report["cpu_percent"],
        "demo.peak_rss_mb": report["peak_rss_mb"],
        "demo.processes": report["processes"],
    }


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:<45} {value if isinstance(value, str) else format(value, '.4g')}")
