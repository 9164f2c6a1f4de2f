"""Controllers on joints in the simulation, without any middleware."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daidalos.control.contracts import ControllerContext, HardwareContext
from daidalos.control.errors import HardwareError, SwitchError
from daidalos.control.manager import ControllerManager
from daidalos.description import sdf, urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.ros2_control import read_hardware
from daidalos.nodes.controller_manager._simulated_system import SimulatedSystem
from daidalos.samples.controllers import TrajectoryCommand, TrajectoryPoint, ValuesCommand
from daidalos.simulation import Simulation
from daidalos.simulation.plugins.ros2_control import Ros2Control
from ros2_control.control_robots import from_values

INERTIA = '<inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/>'
INTERFACES = "".join(f'<command_interface name="{one}"/>' for one in ("position", "velocity", "effort")) + "".join(
    f'<state_interface name="{one}"/>' for one in ("position", "velocity", "effort")
)
PLUGIN = '<gazebo><plugin name="gz_ros2_control" filename="gz_ros2_control-system">{}</plugin></gazebo>'


def pendulum(effort: float = 1000.0, options: str = "", joints: str = "", gazebo: str = "") -> str:
    """Return a robot that hangs in the world: a horizontal beam of 2 kg on a joint, and a finger that slides."""
    body = f'<inertial><origin xyz="0.5 0 0"/><mass value="2"/>{INERTIA.format(0.1)}</inertial>'
    tip = f'<inertial><mass value="0.1"/>{INERTIA.format(0.001)}</inertial>'
    return f"""<robot name="arm"><link name="world"/><link name="beam">{body}</link><link name="tip">{tip}</link>
      <link name="twin">{tip}</link>
      <joint name="swing" type="revolute"><parent link="world"/><child link="beam"/><origin xyz="0 0 3"/>
        <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="{effort}" velocity="0"/></joint>
      <joint name="slide" type="prismatic"><parent link="beam"/><child link="tip"/><origin xyz="1 0 0"/>
        <axis xyz="1 0 0"/><limit lower="0" upper="0.1" effort="50" velocity="0"/></joint>
      <joint name="other" type="prismatic"><parent link="beam"/><child link="twin"/><origin xyz="1 0.1 0"/>
        <axis xyz="1 0 0"/><limit lower="-0.1" upper="0" effort="50" velocity="0"/>
        <mimic joint="slide" multiplier="-1"/></joint>
      <ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
      <joint name="swing">{INTERFACES}</joint>
      {joints or f'<joint name="slide">{INTERFACES}</joint>'}
      <joint name="other"><state_interface name="position"/></joint>
      </ros2_control>{gazebo}{PLUGIN.format(options)}</robot>"""


class Rig:
    """A simulation of one robot and a manager that it steps."""

    def __init__(self, text: str, ground: bool = False, rate: float | None = None) -> None:
        self.warnings: list[str] = []
        model = "<include><uri>model://ground_plane</uri></include>" if ground else ""
        world = sdf.parse(f'<sdf version="1.6"><world name="w">{model}</world></sdf>')
        self.simulation = Simulation(world, warn=self.warnings.append)
        self.simulation.spawn(urdf.parse(text), "robot")
        instance = self.simulation.instance("robot")
        self.plugin = next(one for one in instance.components if isinstance(one, Ros2Control))
        hardware = [SimulatedSystem(info, plugin=self.plugin) for info in self.plugin.hardware]
        self.hardware = hardware[0]
        self.manager = ControllerManager(hardware, self.plugin.rate, log=self.warnings.append)
        self.times: list[int] = []
        self.said: list[tuple[str, Any]] = []
        self.plugin.cycle = self._cycle

    def _cycle(self, now_ns: int) -> None:
        self.times.append(now_ns)
        self.said += self.manager.update(now_ns)

    def add(self, name: str, type_name: str, start: bool = True, **values: Any) -> Any:
        self.manager.load(
            name, type_name, from_values(**values), ControllerContext(name, robot=self.plugin.context.model)
        )
        self.manager.configure(name)
        if start:
            self.manager.switch([name])
        return self.manager.controllers[name].controller

    def group(self, kind: str, *joints: str) -> Callable[..., None]:
        """Start a group controller and return what commands it."""
        controller = self.add(kind, f"{kind}_controllers/JointGroup{kind.title()}Controller", joints=list(joints))
        return lambda *values: controller.subscriptions["~/commands"].take(ValuesCommand(np.array(values, dtype=float)))

    def run(self, seconds: float) -> None:
        self.simulation.advance(round(seconds * 1e9))

    def position(self, joint: str) -> float:
        return self.simulation.joint("robot", joint).position

    def velocity(self, joint: str) -> float:
        return self.simulation.joint("robot", joint).velocity


def test_joints_hold_against_gravity_while_nobody_commands() -> None:
    rig = Rig(pendulum())
    rig.run(2.0)
    assert rig.position("swing") == pytest.approx(0.0, abs=1e-3)


def test_joints_fall_where_they_are_not_to_be_held() -> None:
    rig = Rig(pendulum(options="<hold_joints>false</hold_joints>"))
    rig.run(0.2)
    # Mass 2 at 0.5 m and two of 0.1 at 1 m, about the joint: alpha = (9.8 * (1 + 0.2)) / (0.1 + 0.5 + 0.2 + 0.002)
    alpha = 9.8 * (2 * 0.5 + 0.2) / (0.1 + 2 * 0.25 + 0.2 + 0.002)
    assert rig.position("swing") == pytest.approx(0.5 * alpha * 0.2**2, rel=0.02)


def test_positions_are_reached_one_cycle_later() -> None:
    rig = Rig(pendulum())
    move = rig.group("position", "swing", "slide")
    errors = []
    for step in range(200):
        wanted = 0.5 * math.sin(0.02 * step)
        move(wanted, 0.05)
        before = rig.position("swing")
        rig.run(0.01)
        if step > 20:
            errors.append(before - 0.5 * math.sin(0.02 * (step - 2)))
    assert np.max(np.abs(errors)) < 1e-3
    assert rig.position("slide") == pytest.approx(0.05, abs=1e-3)
    assert rig.position("other") == pytest.approx(-0.05, abs=2e-3)


def test_speeds_are_held_against_gravity() -> None:
    rig = Rig(pendulum())
    rig.group("velocity", "swing")(0.5)
    rig.run(0.5)
    start = rig.position("swing")
    rig.run(1.0)
    assert rig.position("swing") - start == pytest.approx(0.5, abs=2e-3)
    assert rig.velocity("swing") == pytest.approx(0.5, abs=5e-3)


def test_efforts_move_masses_as_newton_says() -> None:
    rig = Rig(pendulum(options="<hold_joints>false</hold_joints>"))
    rig.group("effort", "swing")(-30.0)
    rig.run(0.01)  # the first cycle writes the first command
    before = rig.velocity("swing")
    rig.run(0.1)
    alpha = (9.8 * 1.2 - 30.0) / 0.802
    assert rig.velocity("swing") - before == pytest.approx(alpha * 0.1, rel=0.02)


def test_a_held_speed_does_not_wind_up_against_a_stop() -> None:
    rig = Rig(pendulum())
    move = rig.group("velocity", "slide")
    move(0.5)
    rig.run(3.0)
    assert rig.position("slide") == pytest.approx(0.1, abs=0.01)
    move(-0.5)
    rig.run(0.3)
    assert rig.position("slide") < 0.06


def test_the_motor_is_as_strong_as_its_limit() -> None:
    rig = Rig(pendulum(effort=5.0))
    rig.group("position", "swing")(0.0)
    rig.run(0.1)
    assert rig.position("swing") > 0.01  # gravity needs 11.8 N m
    rig.manager.switch(stop=["position"])
    strong = pendulum(effort=5.0).replace("gz_ros2_control/GazeboSimSystem", "gazebo_ros2_control/GazeboSystem")
    rig = Rig(strong)
    rig.group("position", "swing")(0.0)
    rig.run(0.5)
    assert rig.position("swing") == pytest.approx(0.0, abs=1e-3)  # moved to positions whatever it takes


def test_initial_values_are_where_joints_start_again_and_again() -> None:
    states = '<state_interface name="position"><param name="initial_value">0.07</param></state_interface>'
    rig = Rig(pendulum(joints=f'<joint name="slide"><command_interface name="position"/>{states}</joint>'))
    assert rig.position("slide") == pytest.approx(0.07)
    rig.group("position", "slide")(0.02)
    rig.run(0.5)
    rig.simulation.reset()
    assert rig.position("slide") == pytest.approx(0.07)
    rig.run(0.5)
    assert rig.manager.controllers["position"].state == "active"
    assert rig.position("slide") == pytest.approx(0.07, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("interface", "gains"),
    [
        ("effort", {"p": 800.0, "i": 500.0, "d": 60.0}),
        ("velocity", {"p": 10.0, "ff_velocity_scale": 1.0}),
    ],
)
def test_a_trajectory_is_followed_by_a_closed_loop(interface: str, gains: dict[str, float], tmp_path: Path) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text("controller_manager:\n  ros__parameters:\n    update_rate: 500\n", encoding="utf-8")
    rig = Rig(pendulum(options=f"<parameters>{file}</parameters>"))
    controller = rig.add(
        "arm",
        "joint_trajectory_controller/JointTrajectoryController",
        joints=["swing"],
        command_interfaces=[interface],
        state_interfaces=["position", "velocity"],
        gains={"swing": gains},
    )
    rig.run(1.0)
    points = (TrajectoryPoint(1.0, np.array([0.8]), np.zeros(1)), TrajectoryPoint(2.0, np.array([-0.5]), np.zeros(1)))
    controller.subscriptions["~/joint_trajectory"].take(TrajectoryCommand(("swing",), points))
    rig.run(3.0)
    states = [sample for _, sample in rig.said if sample.topic == "~/controller_state"]
    assert max(abs(state.error.positions[0]) for state in states[520:]) < 0.03
    assert rig.position("swing") == pytest.approx(-0.5, abs=0.01)


def test_old_names_of_interfaces_move_joints_and_strange_ones_are_said() -> None:
    commands = '<command_interface name="{}"/><state_interface name="position"/>'
    rig = Rig(pendulum(joints=f'<joint name="slide">{commands.format("position_pid")}</joint>'))
    controller = rig.add(
        "it", "forward_command_controller/ForwardCommandController", joints=["slide"], interface_name="position_pid"
    )
    controller.subscriptions["~/commands"].take(ValuesCommand(np.array([0.04])))
    rig.run(0.5)
    assert rig.position("slide") == pytest.approx(0.04, abs=1e-3)
    said: list[str] = []
    text = pendulum(joints=f'<joint name="slide">{commands.format("gap")}</joint>')
    rig = Rig(text)
    SimulatedSystem(rig.plugin.hardware[0], HardwareContext(warn=said.append), rig.plugin)
    assert "command interface 'slide/gap' moves nothing" in said[0]


def test_a_trajectory_is_forgotten_by_a_reset() -> None:
    rig = Rig(pendulum())
    controller = rig.add(
        "arm",
        "joint_trajectory_controller/JointTrajectoryController",
        joints=["swing"],
        command_interfaces=["position"],
        state_interfaces=["position", "velocity"],
    )
    take = controller.subscriptions["~/joint_trajectory"].take
    take(TrajectoryCommand(("swing",), (TrajectoryPoint(0.5, np.array([0.8])),)))
    rig.run(1.0)
    assert rig.position("swing") == pytest.approx(0.8, abs=1e-3)
    rig.simulation.reset()
    rig.run(1.0)
    assert rig.position("swing") == pytest.approx(0.0, abs=1e-3)
    take(TrajectoryCommand(("swing",), (TrajectoryPoint(0.5, np.array([0.4])),)))
    rig.run(1.0)
    assert rig.position("swing") == pytest.approx(0.4, abs=1e-3)


def test_a_joint_is_commanded_in_one_way() -> None:
    rig = Rig(pendulum())
    rig.group("position", "swing")
    with pytest.raises(SwitchError, match="joint 'swing' cannot take position and velocity at once"):
        rig.group("velocity", "swing")
    rig.manager.switch(["velocity"], ["position"])
    assert rig.manager.claimed("swing/velocity") == "velocity"


@pytest.mark.slow
@pytest.mark.parametrize("rate", [100, 250, 300, 1000])
def test_loops_hold_their_rate_exactly(tmp_path: Path, rate: int) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(f"controller_manager:\n  ros__parameters:\n    update_rate: {rate}\n", encoding="utf-8")
    rig = Rig(pendulum(options=f"<parameters>{file}</parameters>"))
    rig.add("states", "joint_state_broadcaster/JointStateBroadcaster")
    rig.run(2.0)
    assert len(rig.times) == 2 * rate
    exact = np.arange(1, 2 * rate + 1) * 1e9 / rate
    late = np.array(rig.times) - exact
    assert np.all((late > -1.0) & (late < 1_000_000))  # the first step of 1 ms at or after the instant
    stamps = [sample.stamp_ns for _, sample in rig.said if sample.topic == "joint_states"]
    assert stamps == rig.times


@pytest.mark.slow
def test_a_trajectory_is_followed_in_the_simulation() -> None:
    rig = Rig(pendulum())
    controller = rig.add(
        "arm",
        "joint_trajectory_controller/JointTrajectoryController",
        joints=["swing", "slide"],
        command_interfaces=["position"],
        state_interfaces=["position", "velocity"],
    )
    points = (
        TrajectoryPoint(1.0, np.array([0.8, 0.08]), np.zeros(2)),
        TrajectoryPoint(2.0, np.array([-0.5, 0.01]), np.zeros(2)),
    )
    controller.subscriptions["~/joint_trajectory"].take(TrajectoryCommand(("swing", "slide"), points))
    rig.run(2.5)
    states = [sample for _, sample in rig.said if sample.topic == "~/controller_state"]
    errors = np.array([state.error.positions for state in states])
    speeds = np.array([state.desired.velocities for state in states])
    assert np.max(np.abs(errors - 0.01 * speeds)[5:]) < 0.01  # one cycle late, and no more
    assert rig.position("swing") == pytest.approx(-0.5, abs=1e-3)


WHEEL = f"""<link name="{{0}}"><inertial><mass value="0.05"/>{INERTIA.format("1e-4")}</inertial><collision>
  <origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.05" length="0.02"/></geometry></collision></link>
  <joint name="{{0}}" type="continuous"><parent link="base"/><child link="{{0}}"/><origin xyz="0 {{1}} 0"/>
  <axis xyz="0 1 0"/></joint>"""
ROVER = f"""<robot name="rover"><link name="base"><inertial><mass value="2"/>{INERTIA.format("0.02")}</inertial>
  <collision><geometry><box size="0.3 0.2 0.06"/></geometry></collision></link>
  {WHEEL.format("left", 0.15)}{WHEEL.format("right", -0.15)}
  <link name="caster"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <joint name="caster" type="fixed"><parent link="base"/><child link="caster"/><origin xyz="-0.1 0 -0.03"/></joint>
  <link name="caster_2"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <joint name="caster_2" type="fixed"><parent link="base"/><child link="caster_2"/><origin xyz="0.1 0 -0.03"/></joint>
  <ros2_control name="wheels" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
  <joint name="left"><command_interface name="velocity"/><state_interface name="position"/></joint>
  <joint name="right"><command_interface name="velocity"/><state_interface name="position"/></joint>
  <sensor name="body"><state_interface name="angular_velocity.z"/><state_interface name="linear_acceleration.z"/>
  </sensor></ros2_control>
  <gazebo reference="base"><sensor name="body" type="imu"><update_rate>100</update_rate></sensor></gazebo>
  {PLUGIN.format("")}</robot>"""


def drive(rig: Rig, seconds: float, speed: float, turn: float) -> Any:
    from daidalos.samples.commands import TwistCommand

    controller = rig.manager.controllers["drive"].controller
    assert controller is not None
    take = controller.subscriptions["~/cmd_vel_unstamped"].take
    for _ in range(round(seconds / 0.1)):
        take(TwistCommand(np.array((speed, 0.0, 0.0)), np.array((0.0, 0.0, turn))))
        rig.run(0.1)
    return [sample for _, sample in rig.said if sample.topic == "~/odom"][-1]


@pytest.fixture
def rover() -> Rig:
    rig = Rig(ROVER, ground=True)
    rig.simulation.set_pose("robot", rig.simulation.pose("robot").__class__((0.0, 0.0, 0.05)))
    rig.run(0.5)
    rig.add(
        "drive",
        "diff_drive_controller/DiffDriveController",
        left_wheel_names=["left"],
        right_wheel_names=["right"],
        wheel_separation=0.3,
        wheel_radius=0.05,
        use_stamped_vel=False,
        publish_rate=100.0,
        linear={"x": {"max_acceleration": 2.0}},
        angular={"z": {"max_acceleration": 5.0}},
    )
    return rig


@pytest.mark.slow
def test_a_rover_drives_where_its_odometry_says(rover: Rig) -> None:
    start = rover.simulation.pose("robot").position
    odometry = drive(rover, 5.0, 0.5, 0.0)
    odometry = drive(rover, 0.5, 0.0, 0.0)
    end = rover.simulation.pose("robot").position
    assert end[0] - start[0] == pytest.approx(odometry.position[0], abs=2.5e-3)
    assert abs(end[1] - start[1]) < 5e-3
    assert odometry.position[0] == pytest.approx(2.5, abs=0.1)


def test_a_rover_turns_as_its_odometry_says(rover: Rig) -> None:
    turned = 0.0
    controller: Any = rover.manager.controllers["drive"].controller
    before = _yaw(rover)
    for _ in range(40):
        drive(rover, 0.1, 0.0, 2.0)
        now = _yaw(rover)
        turned += (now - before + math.pi) % (2 * math.pi) - math.pi
        before = now
    assert turned == pytest.approx(controller._odometry.pose[2], rel=2e-3)
    assert turned > 6.0
    states = rover.hardware.states
    assert states["body/angular_velocity.z"] == pytest.approx(2.0, abs=0.02)
    assert states["body/linear_acceleration.z"] == pytest.approx(9.8, abs=0.3)


def test_a_drive_commands_loops_that_command_motors() -> None:
    interfaces = (
        '<command_interface name="effort"/><state_interface name="position"/><state_interface name="velocity"/>'
    )
    old = '<command_interface name="velocity"/><state_interface name="position"/>'
    rig = Rig(ROVER.replace(old, interfaces), ground=True)
    rig.run(0.5)
    for wheel in ("left", "right"):
        rig.add(
            f"pid_{wheel}",
            "pid_controller/PidController",
            start=False,
            dof_names=[wheel],
            command_interface="effort",
            reference_and_state_interfaces=["velocity"],
            gains={wheel: {"p": 0.05, "i": 1.0, "u_clamp_max": 2.0, "u_clamp_min": -2.0}},
        )
    rig.add(
        "drive",
        "diff_drive_controller/DiffDriveController",
        start=False,
        left_wheel_names=["pid_left/left"],
        right_wheel_names=["pid_right/right"],
        wheel_separation=0.3,
        wheel_radius=0.05,
        position_feedback=False,
        use_stamped_vel=False,
        cmd_vel_timeout=1.0,
        linear={"x": {"max_acceleration": 0.5}},
    )
    with pytest.raises(SwitchError, match="'drive' needs pid_left/left/velocity: controller 'pid_left' is not active"):
        rig.manager.switch(["drive"])
    rig.manager.switch(["drive", "pid_left", "pid_right"])
    assert rig.manager.controllers["pid_left"].running.chained
    drive(rig, 4.0, 0.4, 0.0)
    linear, _ = rig.simulation.velocity("robot")
    assert np.linalg.norm(linear) == pytest.approx(0.4, abs=0.01)
    with pytest.raises(SwitchError, match="'pid_left' is needed by 'drive'"):
        rig.manager.switch(stop=["pid_left"])


GANTRY = f"""<robot name="gantry"><link name="world"/>
  <link name="x"><inertial><mass value="2"/>{INERTIA.format(0.1)}</inertial></link>
  <link name="tool"><inertial><mass value="0.5"/>{INERTIA.format(0.01)}</inertial></link>
  <joint name="jx" type="prismatic"><parent link="world"/><child link="x"/><origin xyz="0 0 1"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="500" velocity="0"/></joint>
  <joint name="flange" type="fixed"><parent link="x"/><child link="tool"/></joint>
  <gazebo reference="flange"><provideFeedback>true</provideFeedback>
    <sensor name="wrist" type="force_torque"><update_rate>100</update_rate></sensor></gazebo>
  <ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
  <joint name="jx"><command_interface name="position"/><state_interface name="position"/></joint>
  <sensor name="wrist">{"".join(f'<state_interface name="{k}.{a}"/>' for k in ("force", "torque") for a in "xyz")}
  </sensor></ros2_control>{PLUGIN.format("")}</robot>"""


@pytest.mark.slow
def test_a_tip_yields_to_a_push_that_its_sensor_feels() -> None:
    rig = Rig(GANTRY)
    frames = {"frame": {"id": "tool"}}
    rig.add(
        "yield",
        "admittance_controller/AdmittanceController",
        joints=["jx"],
        command_interfaces=["position"],
        state_interfaces=["position"],
        kinematics={"base": "world", "tip": "tool", "alpha": 1e-9},
        ft_sensor={"name": "wrist", "filter_coefficient": 0.3, **frames},
        control=frames,
        fixed_world_frame={"frame": {"id": "world"}},
        gravity_compensation={"CoG": {"force": 0.5 * 9.8}, **frames},
        admittance={
            "selected_axes": [True, False, False, False, False, False],
            "mass": [5.0] * 6,
            "damping_ratio": [1.0] * 6,
            "stiffness": [200.0] * 6,
            "joint_damping": 0.0,
        },
    )
    rig.run(0.5)
    assert rig.position("jx") == pytest.approx(0.0, abs=1e-4)
    physics = rig.simulation.physics
    physics.data.xfrc_applied[physics.model.body("robot::tool").id, 0] = 10.0
    rig.run(3.0)
    assert rig.position("jx") == pytest.approx(10.0 / 200.0, rel=0.02)
    physics.data.xfrc_applied[:] = 0.0
    rig.run(3.0)
    assert rig.position("jx") == pytest.approx(0.0, abs=1e-3)


def test_wheels_of_any_round_shape_are_driven_as_wheels() -> None:
    cylinder, ball = '<cylinder radius="0.05" length="0.02"/>', '<sphere radius="0.05"/>'
    block = '<box size="0.3 0.02 0.02"/>'
    for shape, round_enough in ((cylinder, True), (ball, True), (block, False)):
        rig = Rig(ROVER.replace(cylinder, shape), ground=True)
        armature = rig.simulation.physics.model.joint("robot::left").armature[0]
        # Two kilograms and two wheels of 50 g, which two wheels of 5 cm drive.
        assert armature == pytest.approx(2.1 * 0.05**2 / 2 if round_enough else 0.0, rel=0.01)


def _yaw(rig: Rig) -> float:
    x, y, z, w = rig.simulation.pose("robot").orientation
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def test_without_the_simulator_it_says_where_it_runs() -> None:
    info = read_hardware(urdf.parse(pendulum()))[0]
    with pytest.raises(HardwareError, match="GazeboSimSystem' is the simulator's; it runs where"):
        SimulatedSystem(info)


def test_a_missing_parameter_file_is_named() -> None:
    with pytest.raises(DescriptionError, match=r"there is no parameter file '/nowhere/a\.yaml'"):
        Rig(pendulum(options="<parameters>/nowhere/a.yaml</parameters>"))


def test_a_robot_that_says_nothing_of_control_is_there_without() -> None:
    simulation = Simulation()
    simulation.spawn(urdf.parse(f'<robot name="r"><link name="a"/>{PLUGIN.format("")}</robot>'))
    assert simulation.instance("r").name == "r"
    assert any("has no <ros2_control> element" in line for line in simulation.warnings)


def test_models_that_come_and_go_leave_controllers_alone() -> None:
    rig = Rig(pendulum())
    rig.group("position", "swing")(0.3)
    rig.run(0.5)
    box = sdf.parse_model(
        '<sdf version="1.6"><model name="box"><pose>5 5 1 0 0 0</pose><link name="l"><collision name="c"><geometry>'
        "<box><size>1 1 1</size></box></geometry></collision></link></model></sdf>"
    )
    rig.simulation.spawn(box, "box")
    rig.run(0.2)
    rig.simulation.delete("box")
    rig.run(0.2)
    assert rig.position("swing") == pytest.approx(0.3, abs=1e-3)


def test_a_saved_state_goes_on_as_before() -> None:
    rig = Rig(pendulum())
    move = rig.group("position", "swing")
    move(0.3)
    rig.run(0.055)
    state = rig.simulation.save()
    rig.plugin.cycle = None
    rig.run(0.2)
    first = rig.position("swing")
    rig.simulation.restore(state)
    rig.run(0.2)
    assert rig.position("swing") == first
