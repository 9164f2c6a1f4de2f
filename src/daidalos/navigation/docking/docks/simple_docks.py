"""Docks at poses that are known or seen, with and without a charger."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, parameter
from daidalos.common.pose2 import compose
from daidalos.common.pose3 import Pose
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.docking.contracts import DockType
from daidalos.navigation.docking.detection import DetectionParameters, DockDetection


@dataclass(frozen=True)
class SimpleNonChargingDockParameters(DetectionParameters):
    """Parameters of docks, by their Nav2 names."""

    use_stall_detection: bool = parameter(False, "Whether stalled wheels mean docked.", read_only=True)
    stall_joint_names: tuple[str, ...] = parameter((), "Joints of these wheels.", read_only=True)
    stall_velocity_threshold: float = parameter(1.0, "Mean speed below which they stand.", unit="rad/s", minimum=0.0)
    stall_effort_threshold: float = parameter(1.0, "Mean effort from which on they push.", minimum=0.0)
    docking_threshold: float = parameter(0.05, "Distance from the dock that means docked.", unit="m", above=0.0)
    staging_x_offset: float = parameter(-0.7, "Staging pose, ahead of the dock's pose.", unit="m")
    staging_yaw_offset: float = parameter(0.0, "Turn of the staging pose.", unit="rad")
    dock_direction: str = parameter("forward", "Which side of the robot comes first: forward or backward.")
    rotate_to_dock: bool = parameter(False, "Whether the robot sees the dock ahead, turns, and docks backward.")

    def check(self) -> None:
        """Refuse a direction that does not exist or fit."""
        if self.dock_direction.lower() not in ("forward", "backward"):
            raise ParameterError("dock_direction", f"must be one of forward, backward, got {self.dock_direction!r}")
        if self.rotate_to_dock and self.dock_direction.lower() != "backward":
            raise ParameterError("rotate_to_dock", "needs the dock_direction backward")
        if self.use_stall_detection and not self.stall_joint_names:
            raise ParameterError("stall_joint_names", "must not be empty with use_stall_detection")


class SimpleNonChargingDock(DockType):
    """Dock without a charger."""

    names = ("opennav_docking::SimpleNonChargingDock",)
    Parameters = SimpleNonChargingDockParameters
    parameters: SimpleNonChargingDockParameters

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._detection = DockDetection()
        self._dock: Array | None = None
        self._is_stalled = False

    @property
    def is_charger(self) -> bool:
        """Implement `DockType.is_charger`."""
        return False

    @property
    def is_backward(self) -> bool:
        """Implement `DockType.is_backward`."""
        return self.parameters.dock_direction.lower() == "backward"

    @property
    def rotates_to_dock(self) -> bool:
        """Implement `DockType.rotates_to_dock`."""
        return self.parameters.rotate_to_dock

    @property
    def detection_topic(self) -> str:
        """Implement `DockType.detection_topic`."""
        return "detected_dock_pose" if self.parameters.use_external_detection_pose else ""

    @property
    def joint_topic(self) -> str:
        """Implement `DockType.joint_topic`."""
        return "joint_states" if self.parameters.use_stall_detection else ""

    def take_detection(self, pose: Pose, stamp: float) -> None:
        """Implement `DockType.take_detection`."""
        self._detection.take(pose, stamp, self.parameters)

    def take_joints(self, names: Sequence[str], velocities: Sequence[float], efforts: Sequence[float]) -> None:
        """Implement `DockType.take_joints`; a joint without velocity or effort does not count as stalled."""
        p = self.parameters
        known = dict(zip(names, zip(velocities, efforts, strict=False), strict=False))
        found = np.abs([known[name] for name in p.stall_joint_names if name in known]).reshape(-1, 2)
        if not found.size:
            self._is_stalled = False
            return
        velocity, effort = found.mean(axis=0)
        self._is_stalled = bool(velocity < p.stall_velocity_threshold and effort > p.stall_effort_threshold)

    def staging_pose(self, dock: Array) -> Array:
        """Implement `DockType.staging_pose`."""
        return compose(dock, (self.parameters.staging_x_offset, 0.0, self.parameters.staging_yaw_offset))

    def start(self, dock: Array) -> None:
        """Implement `DockType.start`."""
        if not self.parameters.use_external_detection_pose:
            self._dock = dock

    def refined_pose(self, dock: Array, now: float) -> Array:
        """Implement `DockType.refined_pose`."""
        p = self.parameters
        self._dock = self._detection.pose(now, p) if p.use_external_detection_pose else dock
        return self._dock

    def is_docked(self, robot: Array) -> bool:
        """Implement `DockType.is_docked`."""
        if self.parameters.use_stall_detection:
            return self._is_stalled
        if self._dock is None:
            return False
        return float(np.hypot(*(robot - self._dock)[:2])) < self.parameters.docking_threshold


@dataclass(frozen=True)
class SimpleChargingDockParameters(SimpleNonChargingDockParameters):
    """Parameters of docks with a charger, by their Nav2 names."""

    use_battery_status: bool = parameter(
        True, "Whether the battery's current means charging, rather than being docked.", read_only=True
    )
    charging_threshold: float = parameter(0.5, "Current of the battery from which on it is charged.", unit="A")


class SimpleChargingDock(SimpleNonChargingDock):
    """Dock with a charger."""

    names = ("opennav_docking::SimpleChargingDock",)
    Parameters = SimpleChargingDockParameters
    parameters: SimpleChargingDockParameters
    _current = 0.0

    @property
    def is_charger(self) -> bool:
        """Implement `DockType.is_charger`."""
        return True

    @property
    def battery_topic(self) -> str:
        """Implement `DockType.battery_topic`."""
        return "battery_state" if self.parameters.use_battery_status else ""

    def take_battery(self, current: float) -> None:
        """Implement `DockType.take_battery`."""
        self._current = current

    def is_charging(self, robot: Array) -> bool:
        """Implement `DockType.is_charging`."""
        p = self.parameters
        return self._current > p.charging_threshold if p.use_battery_status else self.is_docked(robot)
