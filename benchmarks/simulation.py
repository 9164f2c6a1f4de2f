"""How fast and how true the simulator is: steps, scans, start-up, and wheels against truth."""

from __future__ import annotations

import gc
import math
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import daidalos
from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.robot import Robot
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import LaserScanSample, OdometrySample
from daidalos.simulation import Simulation

SHARE = Path(daidalos.__file__).parent / "share"
SECOND = 1_000_000_000
GROUND = "<sdf version='1.9'><world name='w'><include><uri>model://ground_plane</uri></include></world></sdf>"
RGBD = """<sdf version="1.9"><model name="eye"><static>true</static><link name="l"><pose>0 0 0 0 0.3 0.5</pose>
<sensor name="s" type="rgbd_camera"><update_rate>30</update_rate><camera><horizontal_fov>1.047</horizontal_fov><image>
<width>640</width><height>480</height></image></camera></sensor></link></model></sdf>"""
SCANNER = """<sdf version="1.9"><model name="scanner"><static>true</static><link name="l"><sensor name="s" type="ray">
<update_rate>10</update_rate><ray><scan><horizontal><samples>720</samples><min_angle>-3.14159</min_angle>
<max_angle>3.14159</max_angle></horizontal></scan><range><min>0.1</min><max>30</max></range></ray></sensor></link></model>
</sdf>"""
FIRST_SCAN = """
import time
start = time.perf_counter()
from benchmarks.simulation import first_scan
first_scan()
print(time.perf_counter() - start)
"""


def run() -> dict[str, float | str]:
    """Measure everything; times are medians."""
    simulation = arena()
    lidar = next(c for c in simulation.instance("robot").components if type(c).__name__ == "Lidar")
    straight, turns = wheels_against_truth()
    return {
        "simulation.steps_per_second": steps_per_second(simulation),
        "simulation.real_time_factor_waffle_in_arena": real_time_factor(arena()),
        "simulation.real_time_factor_with_50_boxes": real_time_factor(with_boxes(arena(), 50)),
        "simulation.scan_820_rays_ms": 1e3 * median_time(lambda: list(lidar.measure(simulation.time_ns)), 200),
        "simulation.scan_720_rays_ms": 1e3 * median_time(scan_720_rays(), 200),
        "simulation.rgbd_frame_ms": 1e3 * median_time(rgbd_frame(), 60),
        "simulation.real_time_factor_workshop": real_time_factor(workshop(), 3),
        "simulation.spawn_and_delete_ms": 1e3 * median_time(lambda: spawn_and_delete(simulation), 20),
        "simulation.leak_of_200_spawned_and_deleted_mb": leaked_megabytes(200),
        "simulation.first_scan_s": first_scan_seconds(),
        "simulation.straight_10_m_error_mm": 1e3 * straight,
        "simulation.ten_turns_error_percent": 100 * turns,
        "simulation.rest_60_s_drift_mm": 1e3 * drift_at_rest(),
    }


def waffle() -> Robot:
    """Return the waffle without noise."""
    path = SHARE / "turtlebot3_description/urdf/turtlebot3_waffle.urdf.xacro"
    return urdf.load(path, {"laser_noise": "0", "odometry_noise": "0", "camera": "false"}, lambda name: SHARE / name)


def arena() -> Simulation:
    """Return the arena with a robot that drives an arc."""
    simulation = Simulation(sdf.load(SHARE / "turtlebot3_gazebo/worlds/arena.world"))
    simulation.spawn(waffle(), "robot")
    simulation.command("/cmd_vel", twist(0.1, 0.3))
    return simulation


def with_boxes(simulation: Simulation, count: int) -> Simulation:
    """Place a wall of boxes in the room, where cameras see it."""
    box = "<geometry><box><size>0.1 0.1 0.1</size></box></geometry>"
    shape = f"<collision name='c'>{box}</collision><visual name='v'>{box}</visual>"
    inertia = "<inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia>"
    link = f"<link name='l'><inertial><mass>0.5</mass>{inertia}</inertial>{shape}</link>"
    model = sdf.parse_model(f"<sdf version='1.9'><model name='box'>{link}</model></sdf>")
    for number in range(count):
        simulation.spawn(model, f"box{number}", Pose((1.7, -0.7 + 0.15 * (number % 10), 0.05 + 0.1 * (number // 10))))
    return simulation


def steps_per_second(simulation: Simulation) -> float:
    """Return the speed of the physics alone."""
    import mujoco

    model, data = simulation.instance("robot").physics.model, simulation.instance("robot").physics.data
    return 5000 / median_time(lambda: mujoco.mj_step(model, data, 5000), 7)


def real_time_factor(simulation: Simulation, times: int = 7) -> float:
    """Return simulated time over that of one core, unthrottled, with all sensors heard."""

    def second() -> None:
        for _ in range(100):  # as the simulator's node does it
            simulation.advance(SECOND // 100)

    second()
    return 1 / median_time(second, times)


def workshop() -> Simulation:
    """Return the whole scene: robot, 50 obstacles, lidar at 15 Hz, RGB-D camera 640x480 at 30 Hz."""
    simulation = with_boxes(arena(), 50)
    simulation.spawn(sdf.parse_model(RGBD), "eye", Pose((-1.5, -1.0, 0.8)))
    return simulation


def rgbd_frame() -> Callable[[], object]:
    """Return what takes one RGB-D frame, with its depth image, as images alone."""
    simulation = workshop()
    simulation.has_subscribers = lambda topic: topic.endswith(("image", "depth_image"))
    camera = next(c for c in simulation.instance("eye").components if type(c).__name__ == "Camera")
    simulation.advance(SECOND // 10)
    return lambda: list(camera.update(simulation.time_ns))


def scan_720_rays() -> Callable[[], object]:
    """Return what takes one scan of 720 rays in the arena."""
    simulation = arena()
    simulation.spawn(sdf.parse_model(SCANNER), "scanner", Pose((-1.0, -1.0, 0.3)))
    lidar = next(c for c in simulation.instance("scanner").components if type(c).__name__ == "Lidar")
    simulation.advance(SECOND // 10)
    return lambda: list(lidar.measure(simulation.time_ns))


def spawn_and_delete(simulation: Simulation) -> None:
    """Put a second robot into the world and take it out."""
    simulation.spawn(ROBOT, "second", Pose((1, 1, 0)), namespace="second")
    simulation.delete("second")


def leaked_megabytes(count: int) -> float:
    """Return what memory a process has more after models came and went, once the first ones did."""
    simulation = arena()
    for _ in range(count // 10):
        spawn_and_delete(simulation)
    before = resident_bytes()
    for _ in range(count):
        spawn_and_delete(simulation)
    gc.collect()
    return (resident_bytes() - before) / 1e6


def resident_bytes() -> int:
    """Return the memory that this process holds."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")


def first_scan() -> None:
    """Load everything and run until the first scan."""
    simulation = arena()
    while not any(isinstance(sample, LaserScanSample) for sample in simulation.advance(SECOND // 100)):
        pass


def first_scan_seconds() -> float:
    """Return the time from a fresh interpreter to the first scan."""
    root = Path(__file__).parent.parent
    begun = time.perf_counter()
    subprocess.run([sys.executable, "-c", FIRST_SCAN], cwd=root, check=True, capture_output=True)
    return time.perf_counter() - begun


def wheels_against_truth() -> tuple[float, float]:
    """Return the error of wheel odometry after 10 m [m] and, relative, after ten turns."""
    odometry, pose, _, _ = drive(0.25, 0.0, 41)
    straight = math.dist(odometry.position[:2], pose.position[:2])
    _, _, measured, true = drive(0.0, 1.0, 63)
    return straight, abs(measured / true - 1)


def drift_at_rest() -> float:
    """Return how far robot or odometry go in a minute without command [m]."""
    odometry, pose, _, _ = drive(0.0, 0.0, 60)
    return max(float(np.abs(odometry.position).max()), *map(abs, pose.position))


def drive(speed: float, turn: float, seconds: int) -> tuple[OdometrySample, Pose, float, float]:
    """Return the last odometry, the true pose, and the turns that wheels and truth tell [rad]."""
    simulation = Simulation(sdf.parse(GROUND))
    simulation.spawn(ROBOT, "robot")
    simulation.advance(SECOND // 2)
    start = simulation.pose("robot")
    simulation.command("/cmd_vel", twist(speed, turn))
    measured, true = [0.0], [start.yaw]
    for _ in range(4 * seconds):
        samples = simulation.advance(SECOND // 4)
        odometry = [sample for sample in samples if isinstance(sample, OdometrySample)][-1]
        measured.append(2 * math.atan2(odometry.orientation[2], odometry.orientation[3]))
        true.append(simulation.pose("robot").yaw)
    turns = [float(np.ptp(np.unwrap(yaws))) for yaws in (measured, true)]
    return odometry, start.inverse @ simulation.pose("robot"), *turns


def twist(speed: float, turn: float) -> TwistCommand:
    """Return a command for a base that drives ahead and turns."""
    return TwistCommand(np.array([speed, 0.0, 0.0]), np.array([0.0, 0.0, turn]))


def median_time(call: Callable[[], object], times: int) -> float:
    """Return the median duration of a call [s]: of its thread on a processor, which others do not change by theirs."""
    durations = []
    for _ in range(times):
        begun = time.thread_time()
        call()
        durations.append(time.thread_time() - begun)
    return statistics.median(durations)


ROBOT = waffle()

if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name:50} {value:12.4f}")
