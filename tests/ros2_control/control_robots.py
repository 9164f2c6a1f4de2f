"""Robots and helpers for tests of control."""

from collections.abc import Callable
from typing import Any

from daidalos.common.extensions import find
from daidalos.common.parameters import parameters_from
from daidalos.control.contracts import Controller, ControllerContext
from daidalos.control.extensions import CONTROLLERS, hardware_class
from daidalos.control.interfaces import Interfaces, LoanedInterfaces
from daidalos.control.manager import ControllerManager
from daidalos.description import urdf
from daidalos.description.robot import Robot
from daidalos.description.ros2_control import read_hardware

PERIOD_NS = 10_000_000


def arm(hardware: str = "mock_components/GenericSystem", extra: str = "", parameters: str = "") -> Robot:
    """Return an arm with three joints; the last turns without end."""
    joint = """<joint name="{0}"><command_interface name="position"/><command_interface name="velocity"/>
      <state_interface name="position"/><state_interface name="velocity"/></joint>"""
    return urdf.parse(f"""<robot name="arm">
      <link name="base"/><link name="upper"/><link name="lower"/><link name="hand"/>
      <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
        <limit lower="-3" upper="3" effort="100" velocity="50"/></joint>
      <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="100" velocity="50"/></joint>
      <joint name="wrist" type="continuous"><parent link="lower"/><child link="hand"/><origin xyz="1 0 0"/>
        <axis xyz="0 0 1"/></joint>
      <ros2_control name="arm" type="system"><hardware><plugin>{hardware}</plugin>{parameters}</hardware>
        {"".join(joint.format(name) for name in ("shoulder", "elbow", "wrist"))}{extra}</ros2_control></robot>""")


def manager(robot: Robot, update_rate: float = 100.0, **options: Any) -> ControllerManager:
    """Return a manager of a robot's hardware."""
    hardware = [hardware_class(info)(info) for info in read_hardware(robot)]
    return ControllerManager(hardware, update_rate, **options)


def from_values(**values: Any) -> Callable[[type], Any]:
    """Return what makes parameters from keyword arguments."""
    return lambda kind: parameters_from(kind, values)


def alone(
    type_name: str, robot: Robot | None = None, context: dict[str, Any] | None = None, **values: Any
) -> tuple[Controller, Interfaces, Interfaces]:
    """Return an active controller with interfaces of its own, commands and states, at zero."""
    cls = find(CONTROLLERS, type_name)
    controller = cls(parameters_from(cls.Parameters, values), ControllerContext("it", 100.0, robot, **(context or {})))
    commands, states = Interfaces(controller.command_names), Interfaces(controller.state_names)
    states.values[:] = 0.0
    controller.assign(LoanedInterfaces(commands.names, [commands]), LoanedInterfaces(states.names, [states]))
    controller.activate(0)
    return controller, commands, states


def cycle(controller: Controller, now_ns: int, period_ns: int = PERIOD_NS) -> list[Any]:
    """Run one cycle of a controller."""
    controller.now_ns = now_ns
    if not controller.chained:
        controller.take_references(now_ns, period_ns * 1e-9)
    return list(controller.update(now_ns, period_ns * 1e-9))
