"""How fast and how exact controllers run: cycles, loops in the simulation, wheels and joints against truth."""

from __future__ import annotations

import math
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.parameters import parameters_from
from daidalos.common.pose3 import Pose
from daidalos.control.contracts import ControllerContext, Hardware
from daidalos.control.hardware.generic import GenericSystem
from daidalos.control.manager import ControllerManager
from daidalos.description import sdf, urdf
from daidalos.description.ros2_control import read_hardware
from daidalos.nodes.controller_manager._simulated_system import SimulatedSystem
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import TrajectoryCommand, TrajectoryPoint
from daidalos.simulation import Simulation
from daidalos.simulation.plugins.ros2_control import Ros2Control

SECOND = 1_000_000_000
INERTIA = '<inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/>'
POSITION = '<command_interface name="position"/><state_interface name="position"/><state_interface name="velocity"/>'
WHEEL = '<command_interface name="velocity"/><state_interface name="position"/>'
PLUGIN = '<gazebo><plugin name="p" filename="gz_ros2_control-system">{}</plugin></gazebo>'
GROUND = "<sdf version='1.9'><world name='w'><include><uri>model://ground_plane</uri></include></world></sdf>"
JOINTS = tuple(f"j{number}" for number in range(1, 8))
TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
STATES = "joint_state_broadcaster/JointStateBroadcaster"
DRIVE = "diff_drive_controller/DiffDriveController"


def run() -> dict[str, float | str]:
    """Measure everything; times are medians."""
    loop = loop_in_simulation(1000)
    straight, turns = rover_against_truth()
    return {
        "control.trajectory_cycle_7_joints_us": 1e6 * cycle_of(TRAJECTORY),
        "control.broadcaster_cycle_7_joints_us": 1e6 * cycle_of(STATES),
        "control.manager_cycle_7_joints_us": 1e6 * cycle_of(TRAJECTORY, STATES),
        "control.real_time_factor_arm_1_kHz": loop["factor"],
        "control.cycles_missed_in_10_s_at_1_kHz": loop["missed"],
        "control.latest_cycle_at_1_kHz_ns": loop["late"],
        "control.trajectory_error_beside_one_cycle_mrad": 1e3 * loop["error"],
        "control.real_time_factor_arm_100_Hz": loop_in_simulation(100)["factor"],
        "control.rover_10_m_straight_error_mm": 1e3 * straight,
        "control.rover_ten_turns_error_percent": 100 * turns,
    }


def arm(plugin: str, options: str = "") -> str:
    """Return an arm of seven joints that stands in the world."""
    links, joints, controls = ["<link name='world'/>"], [], []
    parent = "world"
    for number, name in enumerate(JOINTS):
        child = f"l{number}"
        body = f'<inertial><origin xyz="0 0 0.1"/><mass value="{4 - 0.5 * number}"/>{INERTIA.format(0.02)}</inertial>'
        links.append(f'<link name="{child}">{body}</link>')
        axis = "0 0 1" if number % 2 == 0 else "0 1 0"
        joints.append(
            f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="0 0 0.2"/><axis xyz="{axis}"/><limit lower="-3" upper="3" effort="300" velocity="0"/>'
            "</joint>"
        )
        controls.append(f'<joint name="{name}">{POSITION}</joint>')
        parent = child
    hardware = f"<hardware><plugin>{plugin}</plugin></hardware>"
    control = f'<ros2_control name="arm" type="system">{hardware}{"".join(controls)}</ros2_control>'
    return f'<robot name="arm">{"".join((*links, *joints))}{control}{PLUGIN.format(options)}</robot>'


def add(manager: ControllerManager, name: str, type_name: str, robot: Any, **values: Any) -> Any:
    """Start a controller and return it."""
    manager.load(name, type_name, lambda kind: parameters_from(kind, values), ControllerContext(name, robot=robot))
    manager.configure(name)
    manager.switch([name])
    return manager.controllers[name].controller


def add_arm_controller(manager: ControllerManager, type_name: str, robot: Any) -> Any:
    """Start a controller of the arm; one that follows trajectories swings all joints."""
    if type_name != TRAJECTORY:
        return add(manager, type_name.partition("/")[0], type_name, robot)
    values = {"joints": list(JOINTS), "command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
    controller = add(manager, "arm", type_name, robot, **values)
    points = tuple(
        TrajectoryPoint(float(second), np.full(7, 0.4 * (-1) ** second), np.zeros(7)) for second in range(1, 21)
    )
    controller.subscriptions["~/joint_trajectory"].take(TrajectoryCommand(JOINTS, points))
    return controller


def cycle_of(*types: str) -> float:
    """Return how long a cycle of controllers on hardware that is not there takes [s]."""
    robot = urdf.parse(arm("mock_components/GenericSystem"))
    hardware: list[Hardware] = [GenericSystem(info) for info in read_hardware(robot)]
    manager = ControllerManager(hardware, 1000.0)
    for type_name in types:
        add_arm_controller(manager, type_name, robot)
    manager.update(0)

    def cycle() -> None:
        manager.update(manager.time_ns + 1_000_000)

    return median_time(cycle, 3000)


class Rig:
    """A robot in the simulation and its manager, called as the simulator's node calls it."""

    def __init__(self, text: str) -> None:
        self.simulation = Simulation(sdf.parse(GROUND, "ground"))
        self.simulation.spawn(urdf.parse(text), "robot", Pose((0.0, 0.0, 0.04)))
        components = self.simulation.instance("robot").components
        self.plugin = next(one for one in components if isinstance(one, Ros2Control))
        hardware = [SimulatedSystem(info, plugin=self.plugin) for info in self.plugin.hardware]
        self.manager = ControllerManager(hardware, self.plugin.rate)
        self.times: list[int] = []
        self.said: list[Any] = []
        self.plugin.cycle = self._cycle

    def _cycle(self, now_ns: int) -> None:
        self.times.append(now_ns)
        self.said += [sample for _, sample in self.manager.update(now_ns)]


def loop_in_simulation(rate: int, seconds: int = 10) -> dict[str, float]:
    """Simulate the arm swinging for a while."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "parameters.yaml"
        file.write_text(f"controller_manager:\n  ros__parameters:\n    update_rate: {rate}\n", encoding="utf-8")
        rig = Rig(arm("gz_ros2_control/GazeboSimSystem", f"<parameters>{file}</parameters>"))
    for type_name in (STATES, TRAJECTORY):
        add_arm_controller(rig.manager, type_name, rig.plugin.context.model)
    start = time.perf_counter()
    rig.simulation.advance(seconds * SECOND)
    elapsed = time.perf_counter() - start
    exact = np.arange(1, len(rig.times) + 1) * SECOND / rate
    states = [one for one in rig.said if one.topic == "~/controller_state"][rate // 10 :]
    errors = [one.error.positions - one.desired.velocities / rate for one in states]
    return {
        "factor": seconds / elapsed,
        "missed": float(seconds * rate - len(rig.times)),
        "late": float(np.max(np.array(rig.times) - exact)),
        "error": float(np.max(np.abs(errors))),
    }


def rover() -> Rig:
    """Return a robot on two wheels and casters, at rest."""

    def wheel(name: str, y: float) -> str:
        shape = '<origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.033" length="0.018"/></geometry>'
        body = f'<inertial><mass value="0.0285"/>{INERTIA.format("2e-5")}</inertial><collision>{shape}</collision>'
        joint = f'<parent link="base"/><child link="{name}"/><origin xyz="0 {y} 0"/><axis xyz="0 1 0"/>'
        return f'<link name="{name}">{body}</link><joint name="{name}" type="continuous">{joint}</joint>'

    def caster(name: str, x: float) -> str:
        shape = '<collision><geometry><sphere radius="0.013"/></geometry></collision>'
        joint = f'<parent link="base"/><child link="{name}"/><origin xyz="{x} 0 -0.02"/>'
        return f'<link name="{name}">{shape}</link><joint name="{name}" type="fixed">{joint}</joint>'

    base = f'<link name="base"><inertial><mass value="1.37"/>{INERTIA.format("0.01")}</inertial></link>'
    control = "".join(f'<joint name="{name}">{WHEEL}</joint>' for name in ("left", "right"))
    hardware = "<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>"
    rig = Rig(
        f'<robot name="rover">{base}{wheel("left", 0.144)}{wheel("right", -0.144)}{caster("caster_1", -0.12)}'
        f'{caster("caster_2", 0.12)}<ros2_control name="w" type="system">{hardware}{control}</ros2_control>'
        f"{PLUGIN.format('')}</robot>"
    )
    rig.simulation.advance(SECOND)
    limits = {"linear": {"x": {"max_acceleration": 1.0}}, "angular": {"z": {"max_acceleration": 3.0}}}
    add(
        rig.manager,
        "drive",
        DRIVE,
        rig.plugin.context.model,
        left_wheel_names=["left"],
        right_wheel_names=["right"],
        wheel_separation=0.288,
        wheel_radius=0.033,
        use_stamped_vel=False,
        cmd_vel_timeout=0.0,
        publish_rate=100.0,
        **limits,
    )
    return rig


def drive(rig: Rig, speed: float, turn: float, seconds: float) -> tuple[float, float]:
    """Drive and stop; return how far the robot went and turned in truth, less what its odometry says."""
    controller = rig.manager.controllers["drive"].controller
    assert controller is not None
    take = controller.subscriptions["~/cmd_vel_unstamped"].take
    start, turned = rig.simulation.pose("robot"), 0.0
    before = yaw(start)
    for wanted, ticks in (((speed, turn), round(seconds * 10)), ((0.0, 0.0), 20)):
        take(TwistCommand(np.array((wanted[0], 0.0, 0.0)), np.array((0.0, 0.0, wanted[1]))))
        for _ in range(ticks):
            rig.simulation.advance(SECOND // 10)
            now = yaw(rig.simulation.pose("robot"))
            turned += (now - before + math.pi) % (2 * math.pi) - math.pi
            before = now
    end = rig.simulation.pose("robot").position
    odometry = [one for one in rig.said if one.topic == "~/odom"]
    moved = np.array(end[:2]) - np.array(start.position[:2])
    says = odometry[-1].position[:2]
    steps = [2 * math.atan2(one.orientation[2], one.orientation[3]) for one in odometry]
    angle = float(np.unwrap(steps)[-1])
    return float(np.linalg.norm(moved - says)), abs(turned - angle) / max(abs(angle), 1e-9)


def rover_against_truth() -> tuple[float, float]:
    """Return the error after 10 m [m] and of ten turns on the spot."""
    return drive(rover(), 0.25, 0.0, 40.0)[0], drive(rover(), 0.0, 1.0, 20 * math.pi)[1]


def yaw(pose: Pose) -> float:
    """Return the heading of a pose [rad]."""
    x, y, z, w = pose.orientation
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def median_time(work: Callable[[], object], count: int) -> float:
    """Return the median of how long something takes [s]."""
    times = []
    for _ in range(count):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)
