"""Navigation without physics, as its launch file is typed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("termios")
from nodes.terminal import Terminal

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]

ROS2 = str(Path(sys.executable).with_name("ros2"))
INITIAL = "{header: {frame_id: map}, pose: {pose: {position: {x: -2.0, y: -0.5}, orientation: {w: 1.0}}}}"
GOAL = "{pose: {header: {frame_id: map}, pose: {position: {x: -0.5, y: -0.5}, orientation: {w: 1.0}}}}"


def test_a_goal_is_reached(domain: int) -> None:
    environment = os.environ | {"ROS_DOMAIN_ID": str(domain)}

    def ros2(*words: str) -> str:
        done = subprocess.run([ROS2, *words], env=environment, capture_output=True, text=True, timeout=200, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    with Terminal(
        "launch", "nav2_bringup", "tb3_loopback_simulation.launch.py", "use_rviz:=False", domain=domain
    ) as launched:
        launched.wait_for(r"lifecycle_manager_navigation\]: Managed nodes are active")
        ros2("topic", "pub", "--once", "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", INITIAL)
        told = ros2("action", "send_goal", "/navigate_to_pose", "nav2_msgs/action/NavigateToPose", GOAL)
        assert "Goal finished with status: SUCCEEDED" in told
        assert launched.interrupt() == 0
