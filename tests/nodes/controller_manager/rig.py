"""A manager of mock hardware in a graph, stepped by hand, and someone who asks it."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
import yaml
from controller_manager_msgs import srv
from rclpy.executors import MultiThreadedExecutor
from rclpy.parameter import Parameter

from daidalos.control.extensions import hardware_class
from daidalos.description import urdf
from daidalos.description.ros2_control import read_hardware
from daidalos.nodes.controller_manager._manager_node import ControllerManagerNode

PERIOD_NS = 10_000_000
TIMEOUT_S = 20.0
FORWARD = "forward_command_controller/ForwardCommandController"


def interfaces(kind: str, *names: str) -> str:
    return "".join(f'<{kind}_interface name="{name}"/>' for name in names)


def joint(name: str, commands: tuple[str, ...], states: tuple[str, ...] = ("position", "velocity")) -> str:
    return f'<joint name="{name}">{interfaces("command", *commands)}{interfaces("state", *states)}</joint>'


def sensor(name: str, *states: str) -> str:
    values = "".join(
        f'<state_interface name="{s}"><param name="initial_value">1</param></state_interface>' for s in states
    )
    return f'<sensor name="{name}">{values}</sensor>'


POSE = ("position.x", "position.y", "position.z", *(f"orientation.{axis}" for axis in "xyzw"))
IMU = (
    *(f"orientation.{axis}" for axis in "xyzw"),
    *(f"{kind}.{axis}" for kind in ("angular_velocity", "linear_acceleration") for axis in "xyz"),
)
WRENCH = tuple(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz")
WHEELS = ("w1", "w2", "w3", "w4")
URDF = f"""<robot name="all"><link name="base"/>
  {"".join(f'<link name="{name}_link"/>' for name in ("shoulder", "elbow", "finger", *WHEELS, "s1", "s2"))}
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="shoulder_link"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="9" velocity="0"/></joint>
  <joint name="elbow" type="revolute"><parent link="shoulder_link"/><child link="elbow_link"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="0"/></joint>
  <joint name="finger" type="prismatic"><parent link="elbow_link"/><child link="finger_link"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="9" velocity="0"/></joint>
  {"".join(f'<joint name="{name}" type="continuous"><parent link="base"/><child link="{name}_link"/></joint>' for name in (*WHEELS, "s1", "s2"))}
  <ros2_control name="mock" type="system"><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  {joint("shoulder", ("position", "velocity", "effort"))}{joint("elbow", ("position", "velocity", "effort"))}
  {joint("finger", ("position", "effort"))}{"".join(joint(name, ("velocity",)) for name in WHEELS)}
  {joint("s1", ("position",))}{joint("s2", ("position",))}
  {sensor("imu", *IMU)}{sensor("wrist", *WRENCH)}{sensor("sonar", "range")}{sensor("tracker", *POSE)}
  <gpio name="valves"><command_interface name="left"/><state_interface name="left"/>
  <state_interface name="right"><param name="initial_value">0.5</param></state_interface></gpio>
  </ros2_control></robot>"""  # noqa: E501


class Rig:
    """A manager of mock hardware, spun meanwhile, and a node that asks it."""

    def __init__(self, parameters: dict[str, Any]) -> None:
        overrides: list[Parameter[Any]] = [Parameter(name, value=value) for name, value in parameters.items()]
        self.node = ControllerManagerNode(parameter_overrides=overrides)
        robot = urdf.parse(URDF)
        self.node.start(robot, [hardware_class(info)(info) for info in read_hardware(robot)])
        self.user = rclpy.create_node("user")
        self.now = 0

    def ask(self, kind: Any, service: str, /, **request: Any) -> Any:
        client = self.user.create_client(kind, f"/controller_manager/{service}")
        assert client.wait_for_service(TIMEOUT_S)
        return client.call(kind.Request(**request), TIMEOUT_S)

    def start(self, name: str) -> None:
        assert self.ask(srv.LoadController, "load_controller", name=name).ok
        assert self.ask(srv.ConfigureController, "configure_controller", name=name).ok
        response = self.switch(start=[name])
        assert response.ok, response.message

    def switch(self, start: Any = (), stop: Any = (), strictness: int = srv.SwitchController.Request.STRICT) -> Any:
        return self.ask(
            srv.SwitchController,
            "switch_controller",
            activate_controllers=list(start),
            deactivate_controllers=list(stop),
            strictness=strictness,
        )

    def cycle(self, count: int = 1) -> None:
        for _ in range(count):
            self.now += PERIOD_NS
            self.node.publish(self.node.cycle(self.now))

    def cycle_until(self, done: Callable[[], bool]) -> None:
        """Run cycles, each of which lets other threads run, until something has happened."""
        pause = threading.Event()
        for _ in range(int(TIMEOUT_S * 1000)):
            if done():
                return
            self.cycle()
            pause.wait(0.001)
        raise AssertionError("it did not happen")

    def states(self) -> dict[str, str]:
        return {one.name: one.state for one in self.ask(srv.ListControllers, "list_controllers").controller}


@contextmanager
def rig(**parameters: Any) -> Iterator[Rig]:
    made = Rig(parameters)
    executor = MultiThreadedExecutor(2)
    executor.add_node(made.node)
    executor.add_node(made.user)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        yield made
    finally:
        executor.shutdown()
        thread.join()
        made.node.destroy_node()
        made.user.destroy_node()


def parameter_file(folder: Path, name: str, **values: Any) -> str:
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump({name: {"ros__parameters": values}}), encoding="utf-8")
    return str(path)
