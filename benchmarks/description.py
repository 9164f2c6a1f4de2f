"""How many public robots and worlds load, and what the transforms of a large robot cost.

The public ones are those that some packages bring, which anybody can install into a folder:

    uv pip install --no-deps --target FOLDER pybullet drake example-robot-data icub-models gym-ignition-models \\
        mani-skill robosuite rtb-data

`DAIDALOS_PUBLIC_MODELS` names the folder (or several, with a colon between); without it they are left out.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psutil
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState

RATE_HZ = 100
SECONDS = 5.0
DOMAIN = 97
GENERATED = "random_urdfs"
"""A folder of a thousand generated things to grasp; they all load, and would make the share look better."""
NO_ROBOTS = {
    "ur3.urdf": "macros that another file includes",
    "finger_macro.urdf": "macros that another file includes",
    "trifinger_stage.urdf": "a part that another file includes",
    "trifingeredu_stage.urdf": "a part that another file includes",
    "torus_deform.urdf": "a soft body for Bullet, without any link",
    "test.urdf": "words, no XML",
}


def run() -> dict[str, float | str]:
    """Measure everything; a share is in percent."""
    figures: dict[str, float | str] = {"description.state_publisher_1000_joints_cpu_percent": state_publisher_cpu()}
    folders = [Path(word) for word in os.environ.get("DAIDALOS_PUBLIC_MODELS", "").split(os.pathsep) if word]
    if not folders:
        print("DAIDALOS_PUBLIC_MODELS names no folder: no public robots", file=sys.stderr)
        return figures
    for kind, endings in (("urdf", (".urdf",)), ("sdf", (".sdf", ".world"))):
        files = sorted(file for folder in folders for file in public_files(folder, endings))
        figures[f"description.public_{kind}_files"] = len(files)
        figures[f"description.public_{kind}_load_percent"] = loading_percent(files)
    return figures


def public_files(folder: Path, endings: tuple[str, ...]) -> Iterator[Path]:
    """Find the robots or worlds below a folder."""
    for path in folder.rglob("*"):
        if path.suffix in endings and path.name not in NO_ROBOTS and GENERATED not in path.parts and path.is_file():
            yield path


def loading_percent(files: list[Path]) -> float:
    """Load each file into the simulator, tell of those that do not, and return the share that does."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        outcomes = list(pool.map(trouble_with, files))
    for file, trouble in zip(files, outcomes, strict=True):
        if trouble:
            print(f"{file}\n    {trouble}", file=sys.stderr)
    return 100 * outcomes.count("") / len(files) if files else 0.0


def trouble_with(file: Path) -> str:
    """Return why a world cannot be run, or a robot or a model not be put into one; empty when it can."""
    is_world = b"<world" in file.read_bytes()
    words = ["sim", "--duration", "0.02", str(file)] if is_world else ["urdf", "--check", str(file)]
    command = [sys.executable, "-m", "daidalos.cli.daidalos", *words]
    done = subprocess.run(command, capture_output=True, text=True)
    return "" if done.returncode == 0 else (done.stderr.strip().splitlines() or [f"ended with {done.returncode}"])[-1]


def state_publisher_cpu() -> float:
    """Return the share of a core that a robot of 1,000 joints takes of robot_state_publisher, told of at 100 Hz."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "chain.urdf"
        file.write_text(chain(1000))
        command = [sys.executable, "-m", "daidalos.nodes.robot_state_publisher.robot_state_publisher", str(file)]
        command += ["--ros-args", "-p", f"publish_frequency:={RATE_HZ:.1f}"]
        environment = os.environ | {"ROS_DOMAIN_ID": str(DOMAIN)}
        with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as process:
            try:
                return _share_while_told(psutil.Process(process.pid))
            finally:
                process.terminate()


def _share_while_told(process: psutil.Process) -> float:
    with rclpy.init(domain_id=DOMAIN):
        node = Node("joints")
        publisher = node.create_publisher(JointState, "joint_states", 10)
        message = JointState(name=[f"j{i}" for i in range(1000)], position=[0.1] * 1000)

        def tell() -> None:
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)

        node.create_timer(1 / RATE_HZ, tell)
        while not publisher.get_subscription_count():
            rclpy.spin_once(node)
        _spin(node, 1.0)  # both start up
        before = sum(process.cpu_times()[:2])
        took = _spin(node, SECONDS)
        return 100 * (sum(process.cpu_times()[:2]) - before) / took


def _spin(node: Node, seconds: float) -> float:
    """Work for a node for a while; returns how long it was."""
    begin = time.monotonic()
    while time.monotonic() < begin + seconds:
        rclpy.spin_once(node)
    return time.monotonic() - begin


def chain(count: int) -> str:
    """Return a robot of so many turning joints in a row."""
    links = "".join(f'<link name="l{i}"/>' for i in range(count + 1))
    joints = "".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/>'
        '<origin xyz="0 0 0.1"/><axis xyz="0 0 1"/></joint>'
        for i in range(count)
    )
    return f'<robot name="chain">{links}{joints}</robot>'
