"""A robot on an ABB controller as hardware of ros2_control, guided by EGM."""

from __future__ import annotations

import math

import numpy as np

from daidalos.common.errors import UserError
from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import HardwareInfo
from daidalos.industry.egm.client import LOOPBACK, PORT, EgmClient, RobotState

_CONNECT_S = 10.0


class AbbSystem(Hardware):
    """Robot of an IRC5 or OmniCore whose joints are guided by EGM, in the order of the ``<ros2_control>`` element.

    Its parameters are ``egm_port`` (6510), ``listen``, the own address that is listened on (loopback), ``rws_ip``, the
    address of the controller (the first that sends where absent), and ``timeout`` (0.1 s), the silence of the
    controller after which it counts as lost. A controller that is lost, or that stops guidance, is an error: the
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
        self._client: EgmClient | None = None
        self._timeout = 0.1
        self._silence = 0.0
        self._state: RobotState | None = None
        self._is_active = False

    def configure(self) -> None:
        """Open the port, and wait for the controller."""
        given = self.info.parameters
        try:
            port = int(given.get("egm_port") or given.get("egm_port_1") or PORT)
            self._timeout = float(given.get("timeout") or 0.1)
        except ValueError as error:
            raise HardwareError(f"'{self.info.name}': {error}") from None
        if not (math.isfinite(self._timeout) and self._timeout > 0.0):
            raise HardwareError(f"'{self.info.name}': timeout is {self._timeout:g} s, but must be greater than 0")
        address = given.get("rws_ip", "").strip()
        try:
            self._client = EgmClient(given.get("listen", LOOPBACK), port, address or None)
            self._take(self._client.wait(_CONNECT_S), 0.0)
        except UserError as error:
            self.cleanup()
            raise HardwareError(str(error)) from None

    def cleanup(self) -> None:
        """Close the port; the controller then stops by itself."""
        if self._client is not None:
            self._client.close()
            self._client = None
        self._state = None

    def activate(self) -> None:
        """Take commands from now on."""
        self._is_active = True
        self._silence = 0.0
        self.commands.values[:] = np.nan

    def deactivate(self) -> None:
        """Hold the robot where it is."""
        if self._state is not None and self._client is not None:
            self._client.send_joints(self._state.joints)
        self._is_active = False

    def read(self, now_ns: int, period: float) -> None:
        """Take the newest state."""
        if self._client is None:
            return
        state = self._client.receive(0.0)
        if state is not None:
            self._take(state, period + self._silence)
            self._silence = 0.0
        else:
            self._silence += period
        if not self._is_active:
            return
        if self._silence > self._timeout:
            raise HardwareError(f"'{self.info.name}': no message of the controller for {self._silence:.3g} s")
        if self._state is not None and not self._state.is_guided:
            raise HardwareError(f"'{self.info.name}': the controller has stopped guided motion")

    def _take(self, state: RobotState, period: float) -> None:
        if len(state.joints) != len(self._joints):
            raise HardwareError(f"the controller has {len(state.joints)} axes, '{self.info.name}' {len(self._joints)}")
        before = self._state.joints if self._state is not None and period > 0.0 else state.joints
        speeds = (state.joints - before) / (period or 1.0)
        for name, position, speed in zip(self._joints, state.joints, speeds, strict=True):
            if f"{name}/velocity" in self.states:
                self.states[f"{name}/velocity"] = float(speed)
            if f"{name}/position" in self.states:
                self.states[f"{name}/position"] = float(position)
        self._state = state

    def write(self, now_ns: int, period: float) -> None:
        """Send the commanded angles; joints that nobody commands stay where they are."""
        if self._client is None or self._state is None or not self._is_active:
            return
        goal = self._state.joints.copy()
        speeds = np.zeros(len(goal))
        for number, name in enumerate(self._joints):
            position = self._command(f"{name}/position")
            speed = self._command(f"{name}/velocity")
            if not math.isnan(position):
                goal[number] = position
            if not math.isnan(speed):
                speeds[number] = speed
        try:
            self._client.send_joints(goal, speeds if speeds.any() else None)
        except ValueError as error:
            raise HardwareError(f"'{self.info.name}': {error}") from None

    def _command(self, name: str) -> float:
        return float(self.commands[name]) if name in self.commands else math.nan
