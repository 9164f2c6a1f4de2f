"""ros2_control in the simulator: motors and sensors of the hardware in a robot's description."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.description.ros2_control import ComponentInfo, HardwareInfo, read_hardware
from daidalos.samples.sensors import (
    ImuSample,
    RangeSample,
    Sample,
    WrenchSample,
)
from daidalos.simulation.contracts import Component, ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.joint_drives import DriveState, JointDrives
from daidalos.simulation.libraries import library_of
from daidalos.simulation.plugin_parameters import PluginParameters

DEFAULT_RATE = 100.0
_KINEMATIC = "gazebo_ros2_control/GazeboSystem"
"""Hardware that moves joints to positions whatever their effort limit says."""


class Ros2Control(Plugin):
    """``libgazebo_ros2_control.so``, gz's ``gz_ros2_control-system``, and ROS 1's ``libgazebo_ros_control.so``.

    Who runs controllers sets `cycle`, which is called once in each period of the controller manager.

    Attributes
    ----------
    hardware : tuple of HardwareInfo
    drives : JointDrives
    files : tuple of Path
        Parameter files.
    manager_name : str
    remappings : tuple of str
        As on the command line, ``from:=to``.
    rate : float
        Of the controller manager [Hz].
    cycle : callable or None
        Called with the time [ns].
    """

    names = ("gazebo_ros2_control", "gazebo_ros_control", "gz_ros2_control-system", "ign_ros2_control-system")
    unused = (
        *("robot_param", "robot_param_node", "robotSimType", "robot_sim_type", "controlPeriod", "control_period"),
        *("position_proportional_gain", "legacyModeNS"),
    )
    state: DriveState

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.hardware = _own_hardware(description, context)
        self.files = tuple(_file(child) for child in element.all("parameters"))
        self.manager_name = element.text_of(
            "controller_manager_name", "controller_manager_node_name", default="controller_manager"
        )
        ros = element.first("ros") or Element("ros")
        self.remappings = tuple(child.text.strip() for child in ros.all("remapping") if ":=" in child.text)
        self.holds = element.flag_of("hold_joints", default=True)
        self.rate = _update_rate(self.files, f"{self.parameters.namespace.rstrip('/')}/{self.manager_name}")
        self.period = 1.0 / self.rate
        self.cycle: Callable[[int], None] | None = None
        joints = [(info.plugin, joint) for info in self.hardware for joint in info.joints if _moves(joint)]
        efforts = {joint.name: _effort(plugin, joint) for plugin, joint in joints if _is_driven(joint)}
        spinning = {joint.name for _, joint in joints if joint.name in efforts and not _takes_positions(joint)}
        self.drives = JointDrives(efforts, [joint.name for _, joint in joints], spinning)
        self._initial = {joint.name: position for _, joint in joints if not math.isnan(position := _start(joint))}

    @classmethod
    def make(cls, description: Description, context: ComponentContext) -> Iterable[Component]:
        """Yield the plugin if the robot has hardware to control."""
        if any(info.components for info in _own_hardware(description, context)):
            return super().make(description, context)
        missing = (
            "other plugins control all of its joints"
            if read_hardware(context.model)
            else "the robot has no <ros2_control> element that says what to control"
        )
        context.warn(f"{description.element.where}: {missing}; plugin {description.name!r} is left out")
        return ()

    def prepare(self, build: ModelBuild) -> None:
        """Add the motors."""
        self.drives.prepare(build)

    def bind(self, instance: Instance) -> None:
        """Find joints, motors and sensors."""
        self.drives.bind(instance)
        self._components: dict[str, Component] = {
            name: one for one in instance.components if (name := getattr(one, "name", ""))
        }

    def start(self) -> DriveState:
        """Return the state with the joints at their initial values."""
        self.drives.place(self._initial)
        state = self.drives.start(self.holds)
        if self.state is not None:  # a reset; the joints' command modes stay
            state.modes = self.state.modes
        self.drives.command(state, self.period)
        return state

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Run the controllers; without them the joints hold their positions."""
        if self.cycle is not None:
            self.cycle(now_ns)
        self.drives.command(self.state, self.period)
        return ()

    def has_sensor(self, name: str) -> bool:
        """Return whether the model has a sensor of that name."""
        return name in self._components

    def measure(self, sensor: str, now_ns: int) -> dict[str, float]:
        """Return the current values of a model's sensor, by interface; empty if there is no such sensor."""
        component: Any = self._components.get(sensor)
        samples = () if component is None else component.measure(now_ns)
        return {name: value for sample in samples for name, value in _values(sample).items()}


def _own_hardware(description: Description, context: ComponentContext) -> tuple[HardwareInfo, ...]:
    """Return the hardware of one of a robot's plugins of this kind, of which each joint has only one.

    A plugin whose namespace begins the names of joints has these; the others are the first one's of those
    without such joints.
    """
    hardware = read_hardware(context.model)
    rivals = [plugin for plugin in context.model.plugins if library_of(plugin) in Ros2Control.names]
    if len(rivals) < 2:
        return hardware
    names = [joint.name for info in hardware for joint in info.joints]
    prefixes = [PluginParameters(plugin, context).namespace.rpartition("/")[2] for plugin in rivals]
    owners: dict[str, int] = {}
    for number, prefix in enumerate(prefixes):
        if prefix:
            owners |= {name: number for name in names if name.startswith(prefix) and name not in owners}
    rest = next((number for number in range(len(rivals)) if number not in owners.values()), 0)
    places = [number for number, plugin in enumerate(rivals) if _is_same(plugin, description)]
    mine = {name for name in names if owners.get(name, rest) in places[:1]}
    return tuple(
        replace(info, components=tuple(c for c in info.components if c.name in mine or c.name not in names))
        for info in hardware
        if not info.joints or any(joint.name in mine for joint in info.joints)
    )


def _is_same(plugin: Description, other: Description) -> bool:
    return (plugin.element.line, plugin.element.source, plugin.name) == (
        other.element.line,
        other.element.source,
        other.name,
    )


def _values(sample: Sample) -> dict[str, float]:
    if isinstance(sample, ImuSample):
        return {
            **_axes("orientation", "xyzw", sample.orientation),
            **_axes("angular_velocity", "xyz", sample.angular_velocity),
            **_axes("linear_acceleration", "xyz", sample.linear_acceleration),
        }
    if isinstance(sample, WrenchSample):
        return {**_axes("force", "xyz", sample.force), **_axes("torque", "xyz", sample.torque)}
    if isinstance(sample, RangeSample):
        return {"range": sample.range}
    return {}


def _axes(name: str, axes: str, values: NDArray[np.float64]) -> dict[str, float]:
    return {f"{name}.{axis}": float(value) for axis, value in zip(axes, values, strict=True)}


def _moves(joint: ComponentInfo) -> bool:
    return joint.joint is not None and bool(joint.joint.axes)


def _is_driven(joint: ComponentInfo) -> bool:
    return bool(joint.commands) and joint.mimic is None


def _effort(plugin: str, joint: ComponentInfo) -> float:
    """Return a motor's maximum effort; a limit of zero, a common mistake in descriptions, means none."""
    effort = joint.joint.axis.effort if joint.joint is not None else math.inf
    return math.inf if effort <= 0.0 or (plugin == _KINEMATIC and _takes_positions(joint)) else effort


def _takes_positions(joint: ComponentInfo) -> bool:
    return any(command.name in ("position", "position_pid") for command in joint.commands)


def _start(joint: ComponentInfo) -> float:
    return next((one.initial_value for one in joint.states if one.name == "position"), math.nan)


def _file(element: Element) -> Path:
    path = Path(element.text.strip())
    if not path.is_file():
        raise element.error(f"there is no parameter file '{path}'")
    return path


def _update_rate(files: Iterable[Path], manager: str) -> float:
    """Return a manager's rate [Hz] from its parameter files, by its full name or else without namespace."""
    rates = {"named": math.nan, "bare": math.nan}
    for file in files:
        try:
            content = read_yaml(file)
        except DocumentError:
            continue  # errors are reported where all parameters are read
        for name, section in _sections(content):
            value = section.get("update_rate")
            if isinstance(value, int | float) and value > 0:
                if _matches(name, manager):
                    rates["named"] = float(value)
                elif name == f"/{manager.rpartition('/')[2]}":
                    rates["bare"] = float(value)
    return next((rate for rate in rates.values() if not math.isnan(rate)), DEFAULT_RATE)


def _matches(pattern: str, name: str) -> bool:
    """Return whether a node name with the wildcards ``*`` and ``**`` matches a node."""
    text = re.escape(pattern).replace(r"/\*\*", "(?:/[^/]+)*").replace(r"\*", "[^/]+")
    return re.fullmatch(text, name) is not None


def _sections(content: Any, name: str = "") -> Iterable[tuple[str, dict[str, Any]]]:
    """Yield the node names of a file with their parameters."""
    if not isinstance(content, dict):
        return
    for key, value in content.items():
        if key == "ros__parameters" and isinstance(value, dict):
            yield name, value
        elif key != "ros__parameters":
            yield from _sections(value, f"{name}/{str(key).strip('/')}")
