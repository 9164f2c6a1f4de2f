"""Mock hardware: states follow commands at once, as ``mock_components/GenericSystem``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import ComponentInfo, HardwareInfo, InterfaceInfo

Places = NDArray[np.intp]

_MOTION = ("position", "velocity", "acceleration")
_AT_REST = (*_MOTION, "effort")


class GenericSystem(Hardware):
    """Mock hardware that mirrors commands into states.

    Its parameters are ROS's: ``calculate_dynamics`` derives what is not commanded (speed from positions, positions
    from speeds or accelerations), ``disable_commands`` ignores commands, ``position_state_following_offset`` (with
    ``custom_interface_with_following_offset``) keeps positions off their commands, ``mock_sensor_commands`` and
    ``mock_gpio_commands`` let sensors and GPIOs be set by commands of their own.
    """

    names = ("mock_components/GenericSystem", "fake_components/GenericSystem")

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        super().__init__(_with_mock_commands(info), context)
        self._ignores = _flag(info, "disable_commands")
        self._dynamics = _flag(info, "calculate_dynamics")
        self._offset = _number(info, "position_state_following_offset", "state_following_offset")
        self._offset_name = info.parameters.get("custom_interface_with_following_offset", "").strip() or "position"
        self._modes: dict[str, str] = {}
        shared = [name for name in self.commands.names if name in self.states]
        self._mirrored_commands = np.array([self.commands.index[name] for name in shared], dtype=np.intp)
        self._mirrored_states = np.array([self.states.index[name] for name in shared], dtype=np.intp)
        self._offsets = np.array([self._offset_of(name) for name in shared])
        self._moving_joints = np.array([self._is_motion(name) for name in shared], dtype=bool)
        self._joints = [_Motion(joint, self) for joint in self.info.joints] if self._dynamics else []

    def configure(self) -> None:
        """Set the initial values, with joints at rest."""
        self.commands.values[:] = np.nan
        self.states.values[:] = np.nan
        for joint in self.info.joints:
            for interface in joint.states:
                if interface.name in _AT_REST:
                    self.states[f"{joint.name}/{interface.name}"] = 0.0
        self._set_initial()
        self._follow_leaders()

    def _set_initial(self) -> None:
        """Set the states and commands to the initial values that the description gives."""
        for component in self.info.components:
            for interfaces, values, kind in (
                (component.commands, self.commands, "command"),
                (component.states, self.states, "state"),
            ):
                for interface in interfaces:
                    value = _initial_value(component, interface, kind)
                    if not np.isnan(value):
                        values[f"{component.name}/{interface.name}"] = value

    def switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Set each joint's mode to the interface that was claimed last."""
        for name in start:
            joint, _, interface = name.rpartition("/")
            if interface in _MOTION:
                self._modes[joint] = interface

    def read(self, now_ns: int, period: float) -> None:
        """Copy the commands to the states."""
        if not self._ignores:
            known = self.commands.values[self._mirrored_commands]
            given = ~np.isnan(known)
            if self._dynamics:
                given &= ~self._moving_joints
            self.states.values[self._mirrored_states[given]] = (known + self._offsets)[given]
            for joint in self._joints:
                joint.move(self._modes.get(joint.name, ""), period)
        self._follow_leaders()

    def _is_motion(self, name: str) -> bool:
        joint, _, interface = name.rpartition("/")
        return interface in _MOTION and any(one.name == joint for one in self.info.joints)

    def _offset_of(self, name: str) -> float:
        joint, _, interface = name.rpartition("/")
        is_joint = any(one.name == joint for one in self.info.joints)
        return self._offset if is_joint and interface == self._offset_name else 0.0

    def _follow_leaders(self) -> None:
        for joint in self.info.joints:
            if joint.mimic is None:
                continue
            for interface in joint.states:
                leader = f"{joint.mimic.joint}/{interface.name}"
                if leader in self.states and interface.name in _MOTION:
                    offset = joint.mimic.offset if interface.name == "position" else 0.0
                    self.states[f"{joint.name}/{interface.name}"] = (
                        joint.mimic.multiplier * self.states[leader] + offset
                    )


class _Motion:
    """Motion of one joint from its commanded interface."""

    def __init__(self, joint: ComponentInfo, system: GenericSystem) -> None:
        self.name = joint.name
        self._commands, self._states = system.commands, system.states
        self._offset = system._offset if system._offset_name == "position" else 0.0
        self._known = [interface.name for interface in joint.states if interface.name in _MOTION]
        self._commanded = [interface.name for interface in joint.commands if interface.name in _MOTION]

    def move(self, mode: str, period: float) -> None:
        mode = mode or next(iter(self._commanded), "")
        command = self._commands[f"{self.name}/{mode}"] if mode in self._commanded else math.nan
        if math.isnan(command) or period <= 0.0:
            return
        position, velocity = self._state("position"), self._state("velocity")
        if mode == "position":
            command += self._offset
            speed = (command - position) / period
            self._set(position=command, velocity=speed, acceleration=(speed - velocity) / period)
        elif mode == "velocity":
            acceleration = (command - velocity) / period
            self._set(position=position + command * period, velocity=command, acceleration=acceleration)
        else:
            speed = velocity + command * period
            self._set(position=position + speed * period, velocity=speed, acceleration=command)

    def _state(self, interface: str) -> float:
        return self._states[f"{self.name}/{interface}"] if interface in self._known else 0.0

    def _set(self, **values: float) -> None:
        for interface, value in values.items():
            if interface in self._known:
                self._states[f"{self.name}/{interface}"] = value


def _with_mock_commands(info: HardwareInfo) -> HardwareInfo:
    """Return the hardware with mock commands for the states of its sensors and GPIOs, if enabled."""
    kinds = {
        kind
        for kind, names in (
            ("sensor", ("mock_sensor_commands", "fake_sensor_commands")),
            ("gpio", ("mock_gpio_commands", "fake_gpio_commands")),
        )
        if any(_flag(info, name) for name in names)
    }
    components = tuple(
        replace(component, commands=component.states) if component.type in kinds else component
        for component in info.components
    )
    return replace(info, components=components)


def _flag(info: HardwareInfo, name: str) -> bool:
    word = info.parameters.get(name, "false").strip().lower()
    if word not in ("true", "false", "1", "0", ""):
        raise HardwareError(f"parameter '{name}' should be true or false, got '{word}'", info.location)
    return word in ("true", "1")


def _number(info: HardwareInfo, *names: str) -> float:
    for name in names:
        text = info.parameters.get(name, "").strip()
        try:
            if text:
                return float(text)
        except ValueError:
            raise HardwareError(f"parameter '{name}' should be a number, got '{text}'", info.location) from None
    return 0.0


def _initial_value(component: ComponentInfo, interface: InterfaceInfo, kind: str) -> float:
    """Return the initial value of an interface, NaN where none is given.

    A state without a value of its own starts where the command of its name does.
    """
    if not np.isnan(interface.initial_value) or kind == "command":
        return interface.initial_value
    return next((one.initial_value for one in component.commands if one.name == interface.name), float("nan"))
