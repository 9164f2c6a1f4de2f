"""Controllers in the simulator as a course runs them: programs, spawners, verbs of `ros2 control`."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from nodes.stepped_terminal import Terminal, Terminals

pytestmark = [pytest.mark.slow, pytest.mark.scenario(timeout=300, record=False)]

INERTIA = '<mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>'
JOINT = """<joint name="{0}"><command_interface name="position"/><state_interface name="position"/>
  <state_interface name="velocity"/></joint>"""
ROBOT = f"""<robot name="arm"><link name="world"/><link name="base"><inertial>{INERTIA}</inertial></link>
  <link name="upper"><inertial><origin xyz="0.25 0 0"/>{INERTIA}</inertial></link>
  <link name="lower"><inertial><origin xyz="0.25 0 0"/>{INERTIA}</inertial></link>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 2"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="100" velocity="5"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="100" velocity="5"/></joint>
  <ros2_control name="arm_system" type="system">
    <hardware><plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware>
    {JOINT.format("shoulder")}{JOINT.format("elbow")}</ros2_control>
  <gazebo><plugin filename="libgazebo_ros2_control.so" name="gazebo_ros2_control">
    <parameters>{{parameters}}</parameters></plugin></gazebo></robot>"""
PARAMETERS = """controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    arm_controller:
      type: joint_trajectory_controller/JointTrajectoryController
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""
GOAL = json.dumps(
    {
        "trajectory": {
            "joint_names": ["shoulder", "elbow"],
            "points": [{"positions": [0.5, -0.25], "time_from_start": {"sec": 1}}],
        }
    }
)


@pytest.fixture
def simulator(tmp_path: Path, terminal: Terminals) -> Iterator[Terminal]:
    parameters = tmp_path / "controllers.yaml"
    parameters.write_text(PARAMETERS, encoding="utf-8")
    robot = tmp_path / "arm.urdf"
    robot.write_text(ROBOT.replace("{parameters}", str(parameters)), encoding="utf-8")
    with terminal("run", "gazebo_ros", "gzserver") as server:
        server.wait_for("simulating an empty world")
        terminal.ros2("run", "gazebo_ros", "spawn_entity.py", "-entity", "arm", "-file", str(robot))
        yield server


def test_an_arm_is_brought_up_moved_and_taken_down(simulator: Terminal, terminal: Terminals) -> None:
    assert "Configured and activated arm_controller" in terminal.ros2(
        "run",
        "controller_manager",
        "spawner",
        "joint_state_broadcaster",
        "arm_controller",
        "--controller-manager-timeout",
        "20",
    )
    listed = terminal.ros2("control", "list_controllers")
    assert re.search(r"arm_controller +joint_trajectory_controller/JointTrajectoryController +active", listed)
    assert "gazebo_ros2_control/GazeboSystem" in terminal.ros2("control", "list_hardware_components")
    assert "shoulder/position [available] [claimed]" in terminal.ros2("control", "list_hardware_interfaces")
    assert "pid_controller/PidController" in terminal.ros2("control", "list_controller_types")

    action = "/arm_controller/follow_joint_trajectory"
    moved = terminal.ros2("action", "send_goal", action, "control_msgs/action/FollowJointTrajectory", GOAL)
    assert "Goal successfully reached!" in moved
    states = terminal.ros2("topic", "echo", "--once", "--field", "position", "/joint_states")
    found = [float(number) for number in re.findall(r"-?\d+\.\d+(?:e-?\d+)?", states)]
    assert found == pytest.approx([0.5, -0.25], abs=2e-3)

    assert "Successfully deactivated arm_controller" in terminal.ros2(
        "control", "set_controller_state", "arm_controller", "inactive"
    )
    assert "Successfully switched" in terminal.ros2(
        "control", "switch_controllers", "--activate", "arm_controller", "--strict"
    )
    with terminal("control", "unload_controller", "arm_controller") as failed:
        assert failed.wait() != 0
    simulator.wait_for("controller 'arm_controller' is active; stop it first")
    assert "Unloaded arm_controller" in terminal.ros2("run", "controller_manager", "unspawner", "arm_controller")
    assert "arm_controller" not in terminal.ros2("control", "list_controllers")
    assert simulator.interrupt() == 0


def test_a_reset_leaves_controllers_active(simulator: Terminal, terminal: Terminals) -> None:
    terminal.ros2("run", "controller_manager", "spawner", "joint_state_broadcaster", "arm_controller")
    terminal.ros2("service", "call", "/reset_simulation", "std_srvs/srv/Empty")
    stamp = terminal.ros2("topic", "echo", "--once", "--field", "header.stamp.sec", "/joint_states")
    assert int(stamp.split()[0]) < 20
    action = "/arm_controller/follow_joint_trajectory"
    moved = terminal.ros2("action", "send_goal", action, "control_msgs/action/FollowJointTrajectory", GOAL)
    assert "Goal successfully reached!" in moved
    terminal.ros2("service", "call", "/delete_entity", "gazebo_msgs/srv/DeleteEntity", "{name: arm}")
    assert "/controller_manager" not in terminal.ros2("node", "list")
    assert simulator.interrupt() == 0


def test_spawners_work_while_time_stands_still(simulator: Terminal, terminal: Terminals) -> None:
    terminal.ros2("service", "call", "/pause_physics", "std_srvs/srv/Empty")
    assert "Configured and activated joint_state_broadcaster" in terminal.ros2(
        "run", "controller_manager", "spawner", "joint_state_broadcaster"
    )
    with terminal("run", "controller_manager", "spawner", "nobody") as missing:
        assert missing.wait() == 2
        assert "error: loading controller 'nobody' failed; see the controller manager's log" in missing.text
    simulator.wait_for("the type of controller 'nobody' is not known")
    assert simulator.interrupt() == 0
