"""The controller manager in a graph: services, parameters, topics and actions, stepped by hand."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory, GripperCommand
from control_msgs.msg import DynamicInterfaceGroupValues, InterfaceValue
from controller_manager_msgs import srv
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from lifecycle_msgs.msg import State
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.parameter import Parameter
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from daidalos.common.extensions import listing
from daidalos.control.extensions import CONTROLLERS
from daidalos.nodes.controller_manager._manager_node import ControllerManagerNode
from nodes.controller_manager.rig import FORWARD, TIMEOUT_S, WHEELS, Rig, parameter_file, rig
from ros.graph import graph  # noqa: F401


def test_a_controller_lives_by_services(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", joints=["elbow"], interface_name="position")
    with rig(**{"it.type": FORWARD, "it.params_file": file}) as one:
        assert one.ask(srv.LoadController, "load_controller", name="it").ok
        assert not one.ask(srv.LoadController, "load_controller", name="it").ok
        assert one.states() == {"it": "unconfigured"}
        assert one.ask(srv.ConfigureController, "configure_controller", name="it").ok
        assert one.switch(start=["it"]).ok
        state = one.ask(srv.ListControllers, "list_controllers").controller[0]
        assert (state.name, state.state, state.type, state.update_rate) == ("it", "active", FORWARD, 100)
        assert list(state.claimed_interfaces) == list(state.required_command_interfaces) == ["elbow/position"]
        assert state.is_chainable
        assert list(state.reference_interfaces) == ["it/elbow/position"]
        assert not one.ask(srv.UnloadController, "unload_controller", name="it").ok
        assert one.switch(stop=["it"]).ok
        assert one.ask(srv.CleanupController, "cleanup_controller", name="it").ok
        assert one.ask(srv.UnloadController, "unload_controller", name="it").ok
        assert one.states() == {}
        assert "it" not in one.user.get_node_names()


def test_diagnostics_tell_what_is_active(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", joints=["elbow"], interface_name="position")
    values = {"it.type": FORWARD, "it.params_file": file, "diagnostic_updater.period": 0.05}
    with rig(**values) as one:
        said: list[DiagnosticArray] = []
        one.user.create_subscription(DiagnosticArray, "/diagnostics", said.append, 10)
        assert one.ask(srv.LoadController, "load_controller", name="it").ok

        def report(name: str) -> tuple[bytes, str, dict[str, str]] | None:
            found = (s for array in said[-1:] for s in array.status if s.name == f"controller_manager: {name}")
            return next(((s.level, s.message, {v.key: v.value for v in s.values}) for s in found), None)

        waiting = (DiagnosticStatus.WARN, "Not all controllers are active", {"it": "unconfigured"})
        one.cycle_until(lambda: report("Controllers Activity") == waiting)
        assert one.ask(srv.ConfigureController, "configure_controller", name="it").ok
        assert one.switch(start=["it"]).ok
        running = (DiagnosticStatus.OK, "All controllers are active", {"it": "active"})
        one.cycle_until(lambda: report("Controllers Activity") == running)
        hardware = (DiagnosticStatus.OK, "All hardware components are active", {"mock": "active"})
        assert report("Hardware Components Activity") == hardware


def test_hardware_and_interfaces_are_listed(graph: Context) -> None:  # noqa: F811
    with rig() as one:
        component = one.ask(srv.ListHardwareComponents, "list_hardware_components").component[0]
        assert (component.name, component.type, component.plugin_name) == (
            "mock",
            "system",
            "mock_components/GenericSystem",
        )
        assert (component.state.label, component.rw_rate) == ("active", 100)
        listed = one.ask(srv.ListHardwareInterfaces, "list_hardware_interfaces")
        commands = {entry.name: entry for entry in listed.command_interfaces}
        assert commands["elbow/position"].is_available
        assert not commands["elbow/position"].is_claimed
        assert "wrist/force.x" in {entry.name for entry in listed.state_interfaces}
        target = State(id=State.PRIMARY_STATE_INACTIVE)
        done = one.ask(srv.SetHardwareComponentState, "set_hardware_component_state", name="mock", target_state=target)
        assert (done.ok, done.state.label) == (True, "inactive")
        assert not one.ask(
            srv.SetHardwareComponentState, "set_hardware_component_state", name="leg", target_state=target
        ).ok
        types = one.ask(srv.ListControllerTypes, "list_controller_types")
        bases = dict(zip(types.types, types.base_classes, strict=True))
        assert bases[FORWARD] == "controller_interface::ChainableControllerInterface"
        assert bases["joint_state_broadcaster/JointStateBroadcaster"] == "controller_interface::ControllerInterface"


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"joints": ["elbow"]}, "controller 'it' cannot be configured: parameter 'interface_name' of /it must not"),
        (
            {"joints": "elbow", "interface_name": "position"},
            ":4: parameter 'joints' of /it must be a list of strings, got 'elbow'",
        ),
        (
            {"joins": ["elbow"], "interface_name": "position"},
            ":4: parameter 'joins' of /it is not declared; did you mean 'joints'?",
        ),
    ],
)
def test_wrong_parameters_are_said_in_a_line(
    graph: Context,  # noqa: F811
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    values: dict[str, Any],
    message: str,
) -> None:
    file = parameter_file(tmp_path, "it", **values)
    with rig(**{"it.type": FORWARD, "it.params_file": file}) as one:
        assert one.ask(srv.LoadController, "load_controller", name="it").ok
        assert not one.ask(srv.ConfigureController, "configure_controller", name="it").ok
    output = "".join(capfd.readouterr())
    assert message in output
    assert "Traceback" not in output


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({}, "the type of controller 'it' is not known: the parameter 'it.type' of 'controller_manager' is not set"),
        ({"it.type": "a/B"}, "there is no controller 'a/B'"),
        ({"it.type": FORWARD, "it.params_file": "/nowhere.yaml"}, "there is no parameter file '/nowhere.yaml'"),
    ],
)
def test_what_can_not_be_loaded_is_said_in_a_line(
    graph: Context,  # noqa: F811
    capfd: pytest.CaptureFixture[str],
    parameters: dict[str, Any],
    message: str,
) -> None:
    with rig(**parameters) as one:
        assert not one.ask(srv.LoadController, "load_controller", name="it").ok
        assert one.states() == {}
    output = "".join(capfd.readouterr())
    assert message in output
    assert "Traceback" not in output


def test_strict_and_best_effort(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    names = ("first", "second")
    parameters = {}
    for name in names:
        parameters[f"{name}.type"] = FORWARD
        parameters[f"{name}.params_file"] = parameter_file(tmp_path, name, joints=["elbow"], interface_name="position")
    with rig(**parameters) as one:
        for name in names:
            assert one.ask(srv.LoadController, "load_controller", name=name).ok
            assert one.ask(srv.ConfigureController, "configure_controller", name=name).ok
        refused = one.switch(start=names)
        assert not refused.ok
        assert "controller 'second' needs elbow/position, which 'first' holds" in refused.message
        assert set(one.states().values()) == {"inactive"}
        done = one.switch(start=names, strictness=srv.SwitchController.Request.BEST_EFFORT)
        assert done.ok
        assert one.states() == {"first": "active", "second": "inactive"}
        assert one.switch(start=["second"], strictness=srv.SwitchController.Request.FORCE_AUTO).ok
        assert one.states() == {"first": "inactive", "second": "active"}


JOINTS = ["shoulder", "elbow"]
CASES: dict[str, tuple[str, dict[str, Any], tuple[str, ...]]] = {
    "states": (
        "joint_state_broadcaster/JointStateBroadcaster",
        {},
        ("/joint_states sensor_msgs/msg/JointState", "/dynamic_joint_states control_msgs/msg/DynamicJointState"),
    ),
    "arm": (
        "joint_trajectory_controller/JointTrajectoryController",
        {"joints": JOINTS, "command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]},
        ("/arm/controller_state control_msgs/msg/JointTrajectoryControllerState",),
    ),
    "diff": (
        "diff_drive_controller/DiffDriveController",
        {
            "left_wheel_names": ["w1"],
            "right_wheel_names": ["w2"],
            "wheel_separation": 0.3,
            "wheel_radius": 0.1,
            "publish_limited_velocity": True,
        },
        (
            "/diff/odom nav_msgs/msg/Odometry",
            "/tf tf2_msgs/msg/TFMessage",
            "/diff/cmd_vel_out geometry_msgs/msg/TwistStamped",
        ),
    ),
    "ackermann": (
        "ackermann_steering_controller/AckermannSteeringController",
        {
            "wheelbase": 1.0,
            "rear_wheel_track": 0.6,
            "front_wheel_track": 0.6,
            "rear_wheels_radius": 0.2,
            "rear_wheels_names": ["w1", "w2"],
            "front_wheels_names": ["s1", "s2"],
        },
        (
            "/ackermann/odometry nav_msgs/msg/Odometry",
            "/ackermann/tf_odometry tf2_msgs/msg/TFMessage",
            "/ackermann/controller_state control_msgs/msg/SteeringControllerStatus",
        ),
    ),
    "mecanum": (
        "mecanum_drive_controller/MecanumDriveController",
        {
            **{
                f"{place}_wheel_command_joint_name": wheel
                for place, wheel in zip(("front_left", "front_right", "rear_right", "rear_left"), WHEELS, strict=True)
            },
            "kinematics.wheels_radius": 0.1,
            "kinematics.sum_of_robot_center_projection_on_X_Y_axis": 0.4,
        },
        ("/mecanum/controller_state control_msgs/msg/MecanumDriveControllerState",),
    ),
    "loops": (
        "pid_controller/PidController",
        {
            "dof_names": JOINTS,
            "command_interface": "effort",
            "reference_and_state_interfaces": ["position"],
            "use_external_measured_states": False,
        },
        (),
    ),
    "yields": (
        "admittance_controller/AdmittanceController",
        {
            "joints": JOINTS,
            "command_interfaces": ["position"],
            "state_interfaces": ["position"],
            "kinematics.base": "base",
            "kinematics.tip": "finger_link",
            "ft_sensor.name": "wrist",
            **{f"{at}.frame.id": "finger_link" for at in ("ft_sensor", "control", "gravity_compensation")},
            "fixed_world_frame.frame.id": "base",
            "admittance.mass": [1.0] * 6,
            "admittance.damping_ratio": [1.0] * 6,
            "admittance.stiffness": [10.0] * 6,
        },
        ("/yields/status control_msgs/msg/AdmittanceControllerState",),
    ),
    "body": (
        "imu_sensor_broadcaster/IMUSensorBroadcaster",
        {"sensor_name": "imu", "frame_id": "base"},
        ("/body/imu sensor_msgs/msg/Imu",),
    ),
    "force": (
        "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",
        {"sensor_name": "wrist", "frame_id": "base"},
        ("/force/wrench geometry_msgs/msg/WrenchStamped",),
    ),
    "ahead": (
        "range_sensor_broadcaster/RangeSensorBroadcaster",
        {"sensor_name": "sonar", "frame_id": "base"},
        ("/ahead/range sensor_msgs/msg/Range",),
    ),
    "pins": (
        "gpio_controllers/GpioCommandController",
        {"gpios": ["valves"], "command_interfaces.valves.interfaces": ["left"]},
        ("/pins/gpio_states control_msgs/msg/DynamicInterfaceGroupValues",),
    ),
    "place": (
        "pose_broadcaster/PoseBroadcaster",
        {"pose_name": "tracker", "frame_id": "base"},
        ("/place/pose geometry_msgs/msg/PoseStamped",),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_controllers_speak_as_upstream(graph: Context, tmp_path: Path, name: str) -> None:  # noqa: F811
    type_name, values, topics = CASES[name]
    file = parameter_file(tmp_path, name, **values)
    with rig(**{f"{name}.type": type_name, f"{name}.params_file": file}) as one:
        received: dict[str, Any] = {}
        for topic, message in (entry.split() for entry in topics):
            take = lambda message, topic=topic: received.update({topic: message})  # noqa: E731
            one.user.create_subscription(get_message(message), topic, take, 10)
        one.start(name)
        one.cycle_until(lambda: len(received) == len(topics))
        known = dict(one.user.get_topic_names_and_types())
        for topic, message in (entry.split() for entry in topics):
            assert known[topic] == [message]
        if name == "force":
            assert received["/force/wrench"].wrench.torque.z == 1.0


def test_every_type_is_tried_here_or_is_one_of_a_kind() -> None:
    tried = {type_name for type_name, _, _ in CASES.values()}
    same_interface = {
        FORWARD,
        "forward_command_controller/MultiInterfaceForwardCommandController",
        "passthrough_controller/PassthroughController",
        *(f"{kind}_controllers/JointGroup{kind.title()}Controller" for kind in ("position", "velocity", "effort")),
        *(f"{kind}/GripperActionController" for kind in ("position_controllers", "effort_controllers")),
        "parallel_gripper_action_controller/GripperActionController",
        "bicycle_steering_controller/BicycleSteeringController",
        "tricycle_steering_controller/TricycleSteeringController",
        "tricycle_controller/TricycleController",
    }
    assert {one.name for one in listing(CONTROLLERS)} == tried | same_interface


def test_commands_come_by_topic(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", joints=JOINTS, interface_name="position")
    with rig(**{"it.type": FORWARD, "it.params_file": file}) as one:
        one.start("it")
        publisher = one.user.create_publisher(Float64MultiArray, "/it/commands", 10)
        publisher.publish(Float64MultiArray(data=[0.5, -0.5]))
        assert one.node.manager is not None
        states = one.node.manager.components["mock"].hardware.states
        one.cycle_until(lambda: states["shoulder/position"] == 0.5 and states["elbow/position"] == -0.5)


def test_gpios_are_commanded_by_name(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", gpios=["valves"], command_interfaces={"valves": {"interfaces": ["left"]}})
    with rig(**{"it.type": "gpio_controllers/GpioCommandController", "it.params_file": file}) as one:
        one.start("it")
        heard: list[DynamicInterfaceGroupValues] = []
        one.user.create_subscription(DynamicInterfaceGroupValues, "/it/gpio_states", heard.append, 10)
        publisher = one.user.create_publisher(DynamicInterfaceGroupValues, "/it/commands", 10)
        values = InterfaceValue(interface_names=["left"], values=[1.0])
        publisher.publish(DynamicInterfaceGroupValues(interface_groups=["valves"], interface_values=[values]))
        one.cycle_until(lambda: bool(heard) and list(heard[-1].interface_values[0].values) == [1.0, 0.5])
        assert heard[-1].interface_groups == ["valves"]
        assert heard[-1].interface_values[0].interface_names == ["left", "right"]


def trajectory(*rows: tuple[float, list[float]]) -> JointTrajectory:
    points = [
        JointTrajectoryPoint(
            positions=positions, time_from_start=Duration(sec=int(time), nanosec=round(time % 1 * 1e9))
        )
        for time, positions in rows
    ]
    return JointTrajectory(joint_names=JOINTS, points=points)


@pytest.fixture
def arm(graph: Context, tmp_path: Path) -> Iterator[Rig]:  # noqa: F811
    type_name, values, _ = CASES["arm"]
    values = values | {"constraints.elbow.trajectory": 0.2, "action_monitor_rate": 50.0}
    file = parameter_file(tmp_path, "arm", **values)
    with rig(**{"arm.type": type_name, "arm.params_file": file}) as one:
        one.start("arm")
        yield one


def test_a_trajectory_by_action(arm: Rig) -> None:
    feedback: list[Any] = []
    client = ActionClient(arm.user, FollowJointTrajectory, "/arm/follow_joint_trajectory")
    assert client.wait_for_server(TIMEOUT_S)
    goal = FollowJointTrajectory.Goal(trajectory=trajectory((0.5, [1.0, 0.5])))
    sent = client.send_goal_async(goal, feedback_callback=feedback.append)
    arm.cycle_until(sent.done)
    handle = sent.result()
    assert handle.accepted
    result = handle.get_result_async()
    arm.cycle_until(result.done)
    assert (result.result().status, result.result().result.error_code) == (4, 0)
    assert feedback[0].feedback.joint_names == JOINTS
    arm.cycle()  # mock hardware shows in the next cycle what it was told in the last
    assert arm.node.manager is not None
    assert arm.node.manager.components["mock"].hardware.states["shoulder/position"] == pytest.approx(1.0)


def test_a_goal_is_cancelled_or_refused(arm: Rig) -> None:
    client = ActionClient(arm.user, FollowJointTrajectory, "/arm/follow_joint_trajectory")
    assert client.wait_for_server(TIMEOUT_S)
    sent = client.send_goal_async(FollowJointTrajectory.Goal(trajectory=trajectory((1000.0, [1.0, 0.5]))))
    arm.cycle_until(sent.done)
    handle = sent.result()
    result, cancelled = handle.get_result_async(), handle.cancel_goal_async()
    arm.cycle_until(lambda: result.done() and cancelled.done())
    assert result.result().status == 5
    unknown = trajectory((1.0, [1.0, 0.5]))
    unknown.joint_names = ["shoulder", "knee"]
    refused = client.send_goal_async(FollowJointTrajectory.Goal(trajectory=unknown))
    arm.cycle_until(refused.done)
    assert not refused.result().accepted
    assert arm.switch(stop=["arm"]).ok
    refused = client.send_goal_async(FollowJointTrajectory.Goal(trajectory=trajectory((1.0, [1.0, 0.5]))))
    arm.cycle_until(refused.done)
    assert not refused.result().accepted


def test_parameters_change_while_it_runs_or_say_why_not(arm: Rig) -> None:
    node = arm.node._nodes["arm"]
    changed, wrong, fixed = (
        node.set_parameters([Parameter(name, value=value)])[0]
        for name, value in (
            ("constraints.elbow.goal", 0.5),
            ("constraints.goal_time", -1.0),
            ("joints", ["elbow"]),
        )
    )
    assert changed.successful
    assert not wrong.successful
    assert "constraints.goal_time out of range Min: 0.0, Max: inf" in wrong.reason
    assert not fixed.successful
    assert arm.node.manager is not None
    controller: Any = arm.node.manager.controllers["arm"].controller
    assert controller.parameters.joint_constraints["elbow"].goal == 0.5


def test_a_gripper_by_action(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "grip", joint="finger")
    parameters = {"grip.type": "position_controllers/GripperActionController", "grip.params_file": file}
    with rig(**parameters) as one:
        one.start("grip")
        client = ActionClient(one.user, GripperCommand, "/grip/gripper_cmd")
        assert client.wait_for_server(TIMEOUT_S)
        goal = GripperCommand.Goal()
        goal.command.position = 0.4
        sent = client.send_goal_async(goal)
        one.cycle_until(sent.done)
        result = sent.result().get_result_async()
        one.cycle_until(result.done)
        assert result.result().result.reached_goal
        assert result.result().result.position == pytest.approx(0.4)


def test_names_can_be_given_by_namespace(graph: Context) -> None:  # noqa: F811
    node = ControllerManagerNode(namespace="/robot1", parameter_overrides=[Parameter("update_rate", value=50)])
    node.start(None, [])
    services = dict(node.get_service_names_and_types())
    assert "/robot1/controller_manager/list_controllers" in services
    assert node.update_rate == 50.0
    node.destroy_node()


def test_initial_states_and_limits_are_parameters(graph: Context) -> None:  # noqa: F811
    with rig(**{"hardware_components_initial_state.inactive": ["mock"], "enforce_command_limits": False}) as one:
        assert one.node.manager is not None
        component = one.node.manager.components["mock"]
        assert component.state == "inactive"
        assert one.ask(srv.ListHardwareComponents, "list_hardware_components").component[0].state.label == "inactive"


def test_numbers_survive_the_way_through_messages(arm: Rig) -> None:
    received: list[Any] = []
    message = get_message("control_msgs/msg/JointTrajectoryControllerState")
    arm.user.create_subscription(message, "/arm/controller_state", received.append, 10)
    publisher = arm.user.create_publisher(JointTrajectory, "/arm/joint_trajectory", 10)
    publisher.publish(trajectory((0.2, [0.25, -0.25])))
    arm.cycle_until(lambda: bool(received) and np.allclose(received[-1].feedback.positions, [0.25, -0.25]))
    assert list(received[-1].joint_names) == JOINTS
    assert list(received[-1].output.positions) == pytest.approx([0.25, -0.25])
