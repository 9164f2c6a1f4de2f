"""Speed of the simulator's node beside bare MuJoCo of the same model in the same run: one robot, and twenty.

Each scenario runs in a process of its own, and those who listen to the robots in another. Speeds are simulated seconds
in a second of processor time of the whole process, bare ones those of `mj_step` on a copy of the world; they alternate.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

import daidalos

SHARE = Path(daidalos.__file__).parent / "share"
ARENA = SHARE / "turtlebot3_gazebo/worlds/arena.world"
ENVIRONMENT = os.environ | {"ROS_DOMAIN_ID": "95"}
ROUNDS = 5
SCENARIOS = {
    "one": (1, ""),
    "one_lidar": (1, "scan"),
    "one_camera": (1, "camera/image_raw"),
    "twenty": (20, ""),
    "twenty_lidars": (20, "scan"),
    "twenty_cameras": (20, "camera/image_raw"),
}
BOXES = 200


def run() -> dict[str, float | str]:
    """Measure all scenarios, and how long boxes take to be spawned."""
    figures: dict[str, float | str] = {}
    for name, (count, topic) in SCENARIOS.items():
        for figure, value in _in_process(f"measure({count}, {topic!r})").items():
            figures[f"fleet.{name}_{figure}"] = value
    return figures | {f"fleet.{name}": value for name, value in _in_process("measure_boxes()").items()}


def _in_process(call: str) -> dict[str, float]:
    code = f"import json; from benchmarks.fleet import *; print('\\n' + json.dumps({call}))"
    root = Path(__file__).parent.parent
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, env=ENVIRONMENT, check=True, stdout=subprocess.PIPE, text=True
    )
    return json.loads(done.stdout.splitlines()[-1])  # type: ignore[no-any-return]


def measure(count: int, topic: str) -> dict[str, float]:
    """Return the speeds of a world with robots, whose `topic` is heard, and the memory of its process."""
    with Simulator() as simulator:
        simulator.add_waffles(count)
        names = [f"/{name}/{topic}" for name in simulator.names] if topic else []
        listener = subprocess.Popen([sys.executable, "-c", LISTENER, *names]) if names else None
        try:
            simulator.wait_for_listeners(names)
            simulator.run(0.3)
            pairs = [(simulator.run(1.0), simulator.bare_speed(0.3)) for _ in range(ROUNDS)]
        finally:
            if listener is not None:
                listener.kill()
                listener.wait()
        ours, bare = (statistics.median(speeds) for speeds in zip(*pairs, strict=True))
        share = statistics.median(one / other for one, other in pairs)
        return {"speed": ours, "bare_speed": bare, "share_of_bare": share, "memory_mb": resident_bytes() / 1e6}


def measure_boxes() -> dict[str, float]:
    """Return the processor time of spawning boxes, one request each [s]."""
    from daidalos.common.pose3 import Pose
    from daidalos.description import sdf

    with Simulator() as simulator:
        box = "<geometry><box><size>0.1 0.1 0.1</size></box></geometry>"
        model = sdf.parse_model(
            f"<sdf version='1.9'><model name='box'><link name='l'><collision name='c'>{box}</collision>"
            f"<visual name='v'>{box}</visual></link></model></sdf>"
        )
        begun = time.process_time()
        for number in range(BOXES):
            place = Pose((-1.0 + 0.2 * (number % 10), -1.0 + 0.2 * (number // 10 % 10), 0.05 + 0.2 * (number // 100)))
            simulator.host.insert(model, f"box{number}", place)
        simulator.host.paced.call(lambda simulation: simulation.pose("box0"))  # compiled by now
        return {f"spawn_{BOXES}_boxes_s": time.process_time() - begun}


class Simulator:
    """Simulator's node in the arena, as fast as it can, standing still between two measurements."""

    def __init__(self) -> None:
        import rclpy
        from rclpy.executors import MultiThreadedExecutor
        from rclpy.parameter import Parameter

        from daidalos.nodes.gazebo_ros.gzserver import GzServer, Start

        rclpy.init()
        self.names: list[str] = []
        speed: Parameter[float] = Parameter("real_time_factor", value=0.0)
        self.node = GzServer(Start(ARENA, paused=True), lambda: None, parameter_overrides=[speed])
        self.host = self.node._host
        self._executor = MultiThreadedExecutor(2)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._executor.spin)

    def __enter__(self) -> Simulator:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        import rclpy

        self._executor.shutdown()
        self._thread.join()
        self.node.destroy_node()
        rclpy.shutdown()

    def add_waffles(self, count: int) -> None:
        """Add robots, each of which drives an arc."""
        import numpy as np

        from daidalos.common.pose3 import Pose
        from daidalos.description import urdf
        from daidalos.samples.commands import TwistCommand

        path = SHARE / "turtlebot3_description/urdf/turtlebot3_waffle.urdf.xacro"
        waffle = urdf.load(path, {}, lambda name: SHARE / name)
        arc = TwistCommand(np.array([0.05, 0.0, 0.0]), np.array([0.0, 0.0, 0.3]))
        for number in range(count):
            name = f"robot{number}"
            self.names.append(name)
            self.host.insert(
                waffle, name, Pose((-1.2 + 0.6 * (number % 5), -1.0 + 0.6 * (number // 5), 0.01)), "", name
            )
            self.host.paced.call(lambda simulation, name=name: simulation.command(f"/{name}/cmd_vel", arc))

    def wait_for_listeners(self, topics: list[str]) -> None:
        """Wait until somebody listens to all topics."""
        deadline = time.monotonic() + 60.0
        while not all(self.node._connections.has_subscribers(topic) for topic in topics):
            if time.monotonic() > deadline:
                raise TimeoutError("nobody listens")
            time.sleep(0.05)

    def run(self, seconds: float) -> float:
        """Run for a time of the wall clock; return the simulated seconds in a second of processor time."""
        paced = self.host.paced
        before, begun = paced.simulation.time_ns, time.process_time()
        paced.set_paused(False)
        time.sleep(seconds)
        paced.set_paused(True)
        paced.call(lambda simulation: None)  # the step that was being made is over
        return (paced.simulation.time_ns - before) * 1e-9 / (time.process_time() - begun)

    def bare_speed(self, seconds: float) -> float:
        """Return the speed of `mj_step` alone from here on."""
        import mujoco

        physics = self.host.paced.simulation.instance(self.names[0]).physics
        data = mujoco.MjData(physics.model)
        mujoco.mj_copyData(data, physics.model, physics.data)
        begun, count = time.thread_time(), 0
        while time.thread_time() - begun < seconds:
            mujoco.mj_step(physics.model, data, 10)
            count += 10
        return count * float(physics.model.opt.timestep) / (time.thread_time() - begun)


def resident_bytes() -> int:
    """Return the memory that this process holds."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")


LISTENER = """
import sys
import rclpy
from sensor_msgs.msg import Image, LaserScan
rclpy.init()
node = rclpy.create_node("listener")
for topic in sys.argv[1:]:
    kind = LaserScan if topic.endswith("scan") else Image
    node.create_subscription(kind, topic, lambda message: None, 10, raw=True)
rclpy.spin(node)
"""

if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:50} {value:12.4f}")
