"""What is kept of a failure's world, and how it is shown beside the bag."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.common.pose3 import Pose
from daidalos.testing.kept_world import read_world
from daidalos.testing.replay import attachments

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")

FAILING = """
import pytest

@pytest.mark.scenario(timeout=60, seed=1, world="arena")
def test_fails(world, robot, clock):
    world.box("crate", x=-1.2, y=0.5).remove()
    robot.move(1.0, 0.0, yaw=1.5707963)
    clock.sleep(0.5)
    robot.drive(0.2)
    clock.sleep(2.0)
    assert not robot.position
"""
REPLAY = """
import sys
import pytest

@pytest.mark.scenario(timeout=20)
def test_replay(scenario, topic, transform, clock):
    folder = "scenario-results/test_failing.py-test_fails"
    scenario.start_program(["ros2", "bag", "play", folder + "/bag", "--disable-keyboard-controls", "--loop"])
    scenario.start_program([sys.executable, "-m", "daidalos.testing.replay", folder])
    shapes = topic("/world").eventually(lambda message: True, within=2.0).markers
    assert {"walls", "waffle", "crate"} <= {marker.ns for marker in shapes}
    transform("world", "walls::link").eventually(x=0.0, y=0.0, tolerance=0.01, within=2.0)
    true = transform("world", "waffle::base_footprint")
    true.eventually(x=1.0, y=0.3, tolerance=0.02, within=5.0)
    transform("world", "base_footprint").eventually(x=1.0, y=0.3, tolerance=0.05, within=0.5)
    transform("world", "base_scan").eventually(x=1.0, y=0.24, tolerance=0.05, within=0.5)
"""


def run(folder: Path, text: str, name: str) -> str:
    (folder / name).write_text(text)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", name]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stdout


@pytest.mark.slow
def test_the_world_and_the_robot_of_a_failure_are_shown(tmp_path: Path) -> None:
    output = run(tmp_path, FAILING, "test_failing.py")
    assert "1 failed" in output, output
    folder = tmp_path / "scenario-results" / "test_failing.py-test_fails"
    shapes = read_world(folder)
    assert shapes is not None
    assert {marker.header.frame_id for marker in shapes.markers} >= {"walls::link", "waffle::base_link", "crate::link"}
    assert read_world(tmp_path) is None
    frames = {(above, below): pose for above, below, pose in attachments(folder / "bag")}
    assert frames["waffle::base_scan", "base_scan"] == Pose()
    x, y, _ = frames["world", "odom"].position
    assert (x, y) == pytest.approx((1.0, 0.0), abs=0.01)  # where the robot was at first
    output = run(tmp_path, REPLAY, "test_replay.py")
    assert "1 passed" in output, output
