"""A robot on an ABB controller as hardware of ros2_control, guided by EGM."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import HardwareInfo
from daidalos.industry.egm.client import LOOPBACK, PORT, EgmClient, RobotState

Array = NDArray[np.float64]

_CONNECT_S = 10.0
_TIMEOUT_S = 1.0
"""Silence of the controller that is an error [s]; it has to stop its robot by itself when guidance stays away."""


class AbbSystem(Hardware):
    """Robot of an IRC5 or OmniCore whose joints are guided by EGM, in the order of the ``<ros2_control>`` element.

    Its parameters are ``egm_port`` (6510), or one port for each mechanical unit of a MultiMove system, by names that
    end with ``egm_port``, in the order of the joints; ``listen``, the own address that is listened on (loopback),
    ``rws_ip``, the address of the controller (the first that sends where absent), and ``timeout`` (1 s), the silence
    of the controller after which it counts as lost. A controller that is lost, or that stops guidance, is an error: the
    manager then takes the hardware out of operation. Active, the robot is told to stay where it is until a controller
    of ros2_control commands it.
    """

    names = ("abb_hardware_interface/ABBSystemHardware", "abb_hardware_interface/ABBSystemPositionOnlyHardware")

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        super().__init__(info, context)
        for joint in info.joints:
            if [one.name for one in joint.commands if one.name not in ("position", "velocity")]:
                raise HardwareError(f"joint '{joint.name}': only position and velocity can be commanded by EGM")
        self._joints = [joint.name for joint in info.joints]
        self._units: list[_Unit] = []
        self._timeout = _TIMEOUT_S
        self._is_active = False

    def configure(self) -> None:
        """Open the port, and wait for the controller."""
        given = self.info.parameters
        names = [name for name in given if name.endswith("egm_port")]
        try:
            ports = [int(given[name]) for name in names] or [PORT]
            self._timeout = float(given.get("timeout") or _TIMEOUT_S)
        except ValueError as error:
            raise HardwareError(f"'{self.info.name}': {error}") from None
        if not (math.isfinite(self._timeout) and self._timeout > 0.0):
            raise HardwareError(f"'{self.info.name}': timeout is {self._timeout:g} s, but must be greater than 0")
        address = given.get("rws_ip", "").strip()
        try:
            for port in ports:
                self._units.append(_Unit(EgmClient(given.get("listen", LOOPBACK), port, address or None)))
            for unit in self._units:
                unit.take(unit.client.wait(_CONNECT_S), 0.0)
            self._check_axes()
        except UserError as error:
            self.cleanup()
            raise HardwareError(str(error)) from None
        self._set_states(0.0)

    def _check_axes(self) -> None:
        count = sum(len(unit.joints) for unit in self._units)
        if count != len(self._joints):
            raise HardwareError(f"the controller has {count} axes, '{self.info.name}' {len(self._joints)}")

    def cleanup(self) -> None:
        """Close the ports; the controller then stops by itself."""
        for unit in self._units:
            unit.client.close()
        self._units = []

    def activate(self) -> None:
        """Take commands from now on."""
        self._is_active = True
        for unit in self._units:
            unit.silence = 0.0
        self.commands.values[:] = np.nan

    def deactivate(self) -> None:
        """Hold the robot where it is."""
        for unit in self._units:
            unit.client.send_joints(unit.joints)
        self._is_active = False

    def read(self, now_ns: int, period: float) -> None:
        """Take the newest states."""
        for unit in self._units:
            state = unit.client.receive(0.0)
            if state is not None:
                unit.take(state, period)
            else:
                unit.silence += period
        self._check_axes()
        self._set_states(period)
        if not self._is_active:
            return
        for unit in self._units:
            if unit.silence > self._timeout:
                raise HardwareError(f"'{self.info.name}': no message of the controller for {unit.silence:.3g} s")
            if unit.state is not None and not unit.state.is_guided:
                raise HardwareError(f"'{self.info.name}': the controller has stopped guided motion")

    def _set_states(self, period: float) -> None:
        positions = np.concatenate([unit.joints for unit in self._units])
        speeds = np.concatenate([unit.speeds for unit in self._units])
        for name, position, speed in zip(self._joints, positions, speeds, strict=True):
            if f"{name}/velocity" in self.states:
                self.states[f"{name}/velocity"] = float(speed)
            if f"{name}/position" in self.states:
                self.states[f"{name}/position"] = float(position)

    def write(self, now_ns: int, period: float) -> None:
        """Send the commanded angles; joints that nobody commands stay where they are."""
        if not self._is_active:
            return
        begin = 0
        for unit in self._units:
            names = self._joints[begin : begin + len(unit.joints)]
            begin += len(names)
            positions = np.array([self._command(f"{name}/position") for name in names])
            speeds = np.nan_to_num([self._command(f"{name}/velocity") for name in names], nan=0.0, posinf=np.inf)
            goal = np.where(np.isnan(positions), unit.joints, positions)
            try:
                unit.client.send_joints(goal, speeds if speeds.any() else None)
            except ValueError as error:
                raise HardwareError(f"'{self.info.name}': {error}") from None

    def _command(self, name: str) -> float:
        return float(self.commands[name]) if name in self.commands else math.nan


@dataclass
class _Unit:
    """A mechanical unit: its connection, its latest state, and how long it has been silent [s]."""

    client: EgmClient
    state: RobotState | None = None
    silence: float = 0.0
    speeds: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def joints(self) -> Array:
        """Return the latest angles [rad]."""
        return self.state.joints if self.state is not None else np.zeros(0)

    def take(self, state: RobotState, period: float) -> None:
        """Take a new state."""
        elapsed = period + self.silence
        known = self.state is not None and len(self.joints) == len(state.joints) and elapsed > 0.0
        self.speeds = (state.joints - self.joints) / elapsed if known else np.zeros(len(state.joints))
        self.state, self.silence = state, 0.0
