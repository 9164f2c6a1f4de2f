"""Controller managers beside models of the simulation."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from controller_manager_msgs import srv
from rclpy.context import Context
from sensor_msgs.msg import JointState

from daidalos.description import sdf, urdf
from daidalos.nodes.gazebo_ros._companions import Companions
from daidalos.simulation import Simulation
from ros.graph import graph, spinning  # noqa: F401

INERTIA = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
ROBOT = f"""<robot name="r"><link name="world"/><link name="a">{INERTIA}</link>
  <joint name="j" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/></joint>
  <ros2_control name="h" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
  <joint name="j"><command_interface name="position"/><state_interface name="position"/></joint></ros2_control>
  <gazebo><plugin name="p" filename="libgazebo_ros2_control.so">{{}}</plugin></gazebo></robot>"""
PARAMETERS = """/**:
  ros__parameters:
    use_local_topics: false
/robot1/manager:
  ros__parameters:
    update_rate: 50
    states.type: joint_state_broadcaster/JointStateBroadcaster
"""
TIMEOUT_S = 20.0


class Rig:
    """A simulation with companions, stepped by hand as the simulator's node does it."""

    def __init__(self, context: Context) -> None:
        self.warnings: list[str] = []
        self.simulation = Simulation(sdf.parse("<sdf version='1.6'><world name='w'/></sdf>"))
        self.companions = Companions(context, self.warnings.append)

    def spawn(self, options: str, name: str = "r", namespace: str = "") -> None:
        self.simulation.spawn(urdf.parse(ROBOT.format(options)), name, namespace=namespace)
        self.companions.follow(self.simulation)

    def advance(self, seconds: float) -> None:
        self.simulation.advance(round(seconds * 1e9))
        self.companions.publish()


@pytest.fixture
def rig(graph: Context) -> Iterator[Rig]:  # noqa: F811
    made = Rig(graph)
    yield made
    made.companions.close()


def ask(node: Any, manager: str, kind: Any, service: str, **request: Any) -> Any:
    client = node.create_client(kind, f"{manager}/{service}")
    assert client.wait_for_service(TIMEOUT_S)
    return client.call(kind.Request(**request), TIMEOUT_S)


def test_names_rates_and_topics_are_as_the_plugin_says(rig: Rig, tmp_path: Path) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(PARAMETERS, encoding="utf-8")
    rig.spawn(
        f"<parameters>{file}</parameters><controller_manager_name>manager</controller_manager_name>"
        "<ros><namespace>/robot1</namespace><remapping>joint_states:=states_of_joints</remapping></ros>"
    )
    assert rig.warnings == []
    user, received = rclpy.create_node("user"), []
    user.create_subscription(JointState, "/robot1/states_of_joints", received.append, 100)
    with spinning(user):
        manager = "/robot1/manager"
        assert ask(user, manager, srv.LoadController, "load_controller", name="states").ok
        assert ask(user, manager, srv.ConfigureController, "configure_controller", name="states").ok
        assert ask(user, manager, srv.SwitchController, "switch_controller", activate_controllers=["states"]).ok
        names = {(name, namespace) for name, namespace in user.get_node_names_and_namespaces()}
        assert {("manager", "/robot1"), ("states", "/robot1")} <= names
        publishers = user.get_publishers_info_by_topic("/robot1/states_of_joints")
        assert [one.node_name for one in publishers] == ["states"]
        rig.advance(1.0)
        deadline = user.get_clock().now().nanoseconds + int(TIMEOUT_S * 1e9)
        while len(received) < 50 and user.get_clock().now().nanoseconds < deadline:
            pass
    stamps = [message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in received]
    assert stamps == [20_000_000 * k for k in range(1, 51)]
    user.destroy_node()


def test_the_simulator_moves_what_a_plugin_in_c_plus_plus_would_drive(rig: Rig) -> None:
    described = ROBOT.format("").replace("gz_ros2_control/GazeboSimSystem", "my_robot/Driver")
    rig.simulation.spawn(urdf.parse(described), "r")
    rig.companions.follow(rig.simulation)
    user = rclpy.create_node("user")
    with spinning(user):
        answer = ask(user, "/controller_manager", srv.ListHardwareComponents, "list_hardware_components")
    assert [(one.plugin_name, one.state.label) for one in answer.component] == [
        ("gz_ros2_control/GazeboSimSystem", "active")
    ]
    user.destroy_node()


def test_companions_come_and_go_with_models(rig: Rig) -> None:
    user = rclpy.create_node("user")
    for name in ("one", "two"):
        rig.spawn("", name, f"/{name}")
    names = {f"{namespace}/{name}" for name, namespace in user.get_node_names_and_namespaces()}
    assert {"/one/controller_manager", "/two/controller_manager"} <= names
    rig.advance(0.1)
    rig.simulation.delete("one")
    rig.companions.follow(rig.simulation)
    names = {f"{namespace}/{name}" for name, namespace in user.get_node_names_and_namespaces()}
    assert "/one/controller_manager" not in names
    assert "/two/controller_manager" in names
    rig.advance(0.1)
    user.destroy_node()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("a: [", "the controllers of 'r' cannot be started: "),
        (
            "controller_manager:\n  ros__parameters:\n    update_rate: fast\n",
            "parameters.yaml:3: parameter 'update_rate'",
        ),
    ],
)
def test_a_file_that_can_not_be_used_is_said_and_the_model_stays(
    rig: Rig, tmp_path: Path, content: str, message: str
) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(content, encoding="utf-8")
    rig.spawn(f"<parameters>{file}</parameters>")
    assert len(rig.warnings) == 1
    assert message in rig.warnings[0]
    rig.advance(0.1)
    assert rig.simulation.models == ("r",)
