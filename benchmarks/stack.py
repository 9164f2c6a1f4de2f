"""Navigation's servers in one process while a TurtleBot3 drives: processor time of a second, and memory."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROS2 = (sys.executable, "-m", "daidalos.cli.ros2")
INITIAL = "{header: {frame_id: map}, pose: {pose: {position: {x: -2.0, y: -0.5}, orientation: {w: 1.0}}}}"
GOAL = "{pose: {header: {frame_id: map}, pose: {position: {x: 1.8, y: 0.5}, orientation: {w: 1.0}}}}"
START_S = 300.0
SETTLE_S = 4.0
MEASURE_S = 6.0
TICKS = os.sysconf("SC_CLK_TCK")


def run() -> dict[str, float | str]:
    """Drive across the hexagon, and look at the process of the container meanwhile."""
    environment = os.environ | {"ROS_DOMAIN_ID": str(50 + os.getpid() % 50)}
    with tempfile.TemporaryDirectory() as folder, (Path(folder) / "output.txt").open("w+") as output:
        words = ["launch", "nav2_bringup", "tb3_simulation_launch.py", "use_rviz:=False"]
        launch = subprocess.Popen(
            [*ROS2, *words], env=environment, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        )
        try:
            wait_for(Path(output.name), "lifecycle_manager_navigation\\S*: Managed nodes are active")
            ros2(
                environment,
                "topic",
                "pub",
                "--once",
                "/initialpose",
                "geometry_msgs/msg/PoseWithCovarianceStamped",
                INITIAL,
            )
            goal = subprocess.Popen(
                [*ROS2, "action", "send_goal", "/navigate_to_pose", "nav2_msgs/action/NavigateToPose", GOAL],
                env=environment,
                stdout=subprocess.DEVNULL,
            )
            time.sleep(SETTLE_S)
            process = container(launch.pid)
            begun, used = simulated(environment), processor_time(process)
            time.sleep(MEASURE_S)
            share = (processor_time(process) - used) / (simulated(environment) - begun)
            memory = resident_mb(process)
            goal.terminate()
            goal.wait()
        finally:
            os.killpg(launch.pid, signal.SIGINT)
            launch.wait(timeout=20.0)
    return {"stack.cores": share, "stack.mb": memory}


def wait_for(path: Path, pattern: str) -> None:
    """Wait until a file has some text."""
    until = time.monotonic() + START_S
    while not re.search(pattern, path.read_text(errors="replace")):
        if time.monotonic() > until:
            raise RuntimeError(f"navigation has not come up:\n{path.read_text(errors='replace')[-2000:]}")
        time.sleep(0.5)


def ros2(environment: dict[str, str], *words: str) -> str:
    """Return what a command prints."""
    done = subprocess.run([*ROS2, *words], env=environment, capture_output=True, text=True, timeout=60.0, check=True)
    return done.stdout


def simulated(environment: dict[str, str]) -> float:
    """Return the simulated time [s]."""
    text = ros2(environment, "topic", "echo", "--once", "/clock")
    seconds, nanoseconds = (int(re.search(rf"{name}: (\d+)", text)[1]) for name in ("sec", "nanosec"))
    return seconds + 1e-9 * nanoseconds


def container(launch: int) -> int:
    """Return the process that has loaded the servers, among those that a launch has started."""
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words, parent = path.read_bytes().split(b"\0"), stat(int(path.parent.name))[1]
        except OSError:  # it has ended
            continue
        if int(parent) == launch and b"component_container_isolated" in words:
            return int(path.parent.name)
    raise RuntimeError("there is no container")


def processor_time(process: int) -> float:
    """Return the processor time [s] that a process has used."""
    fields = stat(process)
    return (int(fields[11]) + int(fields[12])) / TICKS


def stat(process: int) -> list[str]:
    """Return the state of a process, its parent and what follows."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


def resident_mb(process: int) -> float:
    """Return the memory [MB] of a process."""
    text = Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024.0


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:<50} {value if isinstance(value, str) else format(value, '.4g')}")
