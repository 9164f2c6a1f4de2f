"""Simulated hardware of the controller manager: joints with motors, and sensors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import HardwareInfo
from daidalos.simulation.joint_drives import Mode

if TYPE_CHECKING:
    from daidalos.simulation.plugins.ros2_control import Ros2Control

_STATES = ("position", "velocity", "effort")
_MODES = {
    "position": Mode.POSITION,
    "velocity": Mode.VELOCITY,
    "effort": Mode.EFFORT,
    # With these names Gazebo's hardware closes a loop of its own; ours always does.
    "position_pid": Mode.POSITION,
    "velocity_pid": Mode.VELOCITY,
}


class SimulatedSystem(Hardware):
    """Robot in the simulation, by the plugin names of Gazebo's packages.

    Parameters
    ----------
    info, context
        See `Hardware`.
    plugin : Ros2Control or None
        The simulation's side; without it there is no simulation to control.
    """

    names = (
        "gazebo_ros2_control/GazeboSystem",
        "gz_ros2_control/GazeboSimSystem",
        "ign_ros2_control/IgnitionSystem",
    )

    def __init__(
        self, info: HardwareInfo, context: HardwareContext | None = None, plugin: Ros2Control | None = None
    ) -> None:
        super().__init__(info, context)
        if plugin is None:
            raise HardwareError(
                f"'{info.plugin}' is the simulator's; it runs where the robot's <gazebo> element "
                "has the plugin gazebo_ros2_control or gz_ros2_control",
                info.location,
            )
        self._plugin = plugin
        drives = plugin.drives
        self._driven = {name: row for row, name in enumerate(drives.driven)}
        self._check()
        pairs = [
            (self.states.index[f"{joint.name}/{state.name}"], _STATES.index(state.name), drives.names.index(joint.name))
            for joint in info.joints
            for state in joint.states
            if state.name in _STATES and joint.name in drives.names
        ]
        self._states, self._kinds, self._rows = np.array(pairs, dtype=np.intp).reshape(-1, 3).T
        self._used = np.zeros(3, dtype=bool)
        self._used[self._kinds] = True
        self._idle = Mode.HOLD if plugin.holds else Mode.FREE
        # Which command goes to which drive, for those that are claimed.
        self._commands: dict[int, int] = {}

    def _check(self) -> None:
        for joint in self.info.joints:
            for command in joint.commands:
                if command.name not in _MODES:
                    known = ", ".join(_MODES)
                    self.context.warn(
                        f"{self.info.location.prefix()}command interface '{joint.name}/{command.name}' moves nothing; "
                        f"the simulation has {known}"
                    )

    def configure(self) -> None:
        """Read the state of the joints; sensors are first read in the first cycle, between two steps."""
        for sensor in self.info.sensors:
            if not self._plugin.has_sensor(sensor.name):
                self.context.warn(f"hardware '{self.info.name}': the robot has no sensor '{sensor.name}'")
        self._read_joints()

    def prepare_switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Refuse a joint that is to be commanded in two ways."""
        wanted: dict[str, str] = {}
        going_on = [self.commands.names[place] for place in self._commands if self.commands.names[place] not in stop]
        for name in (*going_on, *start):
            joint, _, kind = name.rpartition("/")
            if joint in self._driven and kind in _MODES and wanted.setdefault(joint, kind) != kind:
                raise HardwareError(f"joint '{joint}' cannot take {wanted[joint]} and {kind} at once")

    def switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Set the motors' commands; joints without a command hold or are free."""
        state = self._plugin.state
        for name in stop:
            row = self._commands.pop(self.commands.index[name], None)
            if row is not None:
                state.modes[row], state.targets[row] = self._idle, np.nan
        for name in start:
            joint, _, kind = name.rpartition("/")
            if joint in self._driven and kind in _MODES:
                row = self._driven[joint]
                self._commands[self.commands.index[name]] = row
                state.modes[row] = _MODES[kind]

    def read(self, now_ns: int, period: float) -> None:
        """Read joints and sensors."""
        self._read_joints()
        for sensor in self.info.sensors:
            for name, value in self._plugin.measure(sensor.name, now_ns).items():
                if f"{sensor.name}/{name}" in self.states:
                    self.states[f"{sensor.name}/{name}"] = value

    def _read_joints(self) -> None:
        drives = self._plugin.drives
        table = np.zeros((3, len(drives.names)))
        if self._used[0]:
            table[0] = drives.positions
        if self._used[1]:
            table[1] = drives.velocities
        if self._used[2]:
            table[2] = drives.efforts_now
        self.states.values[self._states] = table[self._kinds, self._rows]

    def write(self, now_ns: int, period: float) -> None:
        """Pass the commands on."""
        targets = self._plugin.state.targets
        for place, row in self._commands.items():
            targets[row] = self.commands.values[place]

    def deactivate(self) -> None:
        """Hold, or leave the joints free."""
        self._plugin.state.targets[list(self._driven.values())] = np.nan
