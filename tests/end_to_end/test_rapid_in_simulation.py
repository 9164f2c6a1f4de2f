"""`daidalos rapid run --sim`: a program moves the arm of `bringup.launch.py` along its path."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState

from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots import ARMS
from end_to_end.processes import DAIDALOS, ROS2, Command, finished

pytestmark = [pytest.mark.slow, pytest.mark.timeout(180)]

PROGRAM = """MODULE square
  PROC main()
    ConfL \\Off;
    ConfJ \\Off;
    MoveJ [[350,-100,320],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tool0;
    MoveL [[350,100,320],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, z20, tool0;
    MoveL [[400,100,320],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0;
    TPWrite "there";
  ENDPROC
ENDMODULE
"""


def test_program_moves_the_simulated_arm(tmp_path: Path, domain: int) -> None:
    (tmp_path / "square.mod").write_text(PROGRAM)
    seen: list[Any] = []
    bringup = (*ROS2, "launch", "irb120_description", "bringup.launch.py", "gui:=false")
    program = (*DAIDALOS, "rapid", "run", str(tmp_path / "square.mod"), "--robot", "irb120", "--sim")
    with Command(*bringup, domain=domain) as simulator:
        simulator.wait_for_line("activated joint_trajectory_controller")
        rclpy.init(domain_id=domain)
        node = Node("watcher")
        node.create_subscription(JointState, "/joint_states", lambda message: seen.append(message.position), 10)
        try:
            with Command(*program, domain=domain) as run:
                end = time.monotonic() + 60.0
                while not any("main ended" in line for line in run.lines) and time.monotonic() < end:
                    rclpy.spin_once(node, timeout_sec=0.05)
                run.wait_for_line("main ended")
        finally:
            rclpy.shutdown()
        drawn = draw_a_letter(tmp_path, domain)
        simulator.interrupt()
    arm = ARMS["irb120"]
    positions = forward(arm, np.array(seen))[:, :3, 3]
    on_line = positions[(np.abs(positions[:, 2] - 0.32) < 0.004) & (np.abs(positions[:, 1]) < 0.07)]
    assert len(on_line) > 20
    assert np.abs(on_line[:, 0] - 0.35).max() < 0.004
    assert positions[:, 1].max() == pytest.approx(0.1, abs=0.004)
    assert np.linalg.norm(positions - np.array([0.35, 0.1, 0.32]), axis=1).min() > 0.004
    assert {"sheet", "ink_0"} <= drawn


def draw_a_letter(folder: Path, domain: int) -> set[str]:
    """Draw a letter on a sheet in the simulator, compare it, and return the models that are there then."""
    letter, picture = folder / "letter.mod", folder / "letter.svg"
    written = finished(*DAIDALOS, "rapid", "write", "L", "-o", str(letter), domain=domain)
    assert written.returncode == 0, written.stderr
    options = ("--sim", "--text", "L", "-o", str(picture))
    drawn = finished(*DAIDALOS, "rapid", "draw", str(letter), *options, domain=domain)
    assert drawn.returncode == 0, drawn.stderr
    assert float(drawn.stderr.split("worst deviation")[1].split()[0]) <= 0.2
    assert picture.read_text().count("<polyline") == 1
    asked = (*ROS2, "service", "call", "/get_model_list", "gazebo_msgs/srv/GetModelList")
    models = finished(*asked, domain=domain).stdout
    return set(models.split("model_names=[")[1].split("]")[0].replace("'", "").split(", "))
