"""Admittance controller: joints follow their references and yield to the wrench of a force sensor."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.common.pose3 import quaternion_from_matrix
from daidalos.control.admittance import AdmittanceLaw, AdmittanceState, advance, without_weight
from daidalos.control.chain import Chain
from daidalos.control.contracts import Controller, Subscription
from daidalos.control.errors import ControlError
from daidalos.control.interfaces import Interfaces, interface_names
from daidalos.samples.controllers import AdmittanceSample, TrajectoryPoint
from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class Kinematics(Parameters):
    """Chain of joints."""

    base: str = parameter("", "Link that the chain starts at.", not_empty=True, read_only=True)
    tip: str = parameter("", "Link that the chain ends at.", not_empty=True, read_only=True)
    alpha: float = parameter(0.0005, "Damping of the inverse kinematics near singular positions.", minimum=0.0)


@dataclass(frozen=True)
class Frame(Parameters):
    """Frame: a link of the robot, or one outside of it."""

    id: str = parameter("", "Name of the frame.", not_empty=True, read_only=True)
    external: bool = parameter(False, "Whether the frame is outside of the robot.", read_only=True)


@dataclass(frozen=True)
class ForceSensor(Parameters):
    """Force-torque sensor."""

    name: str = parameter("", "Name of the sensor in its state interfaces.", not_empty=True, read_only=True)
    frame: Frame = group(Frame)
    filter_coefficient: float = parameter(
        0.05, "Weight of a new value in the low-pass filter; 1 does not filter.", above=0.0
    )


@dataclass(frozen=True)
class FrameHolder(Parameters):
    """Named frame."""

    frame: Frame = group(Frame)


@dataclass(frozen=True)
class CentreOfGravity(Parameters):
    """Centre of gravity of the tool."""

    pos: tuple[float, ...] = parameter((0.0, 0.0, 0.0), "Position in the frame.", unit="m", length=3)
    force: float = parameter(0.0, "Weight of the tool.", unit="N")


@dataclass(frozen=True)
class GravityCompensation(Parameters):
    """Gravity compensation of the sensor's payload."""

    frame: Frame = group(Frame)
    CoG: CentreOfGravity = group(CentreOfGravity)


@dataclass(frozen=True)
class LawParameters(Parameters):
    """Admittance law along and about the axes of the control frame; see `AdmittanceLaw`."""

    selected_axes: tuple[bool, ...] = parameter((True,) * 6, "Axes along and about which the tip yields.", length=6)
    mass: tuple[float, ...] = parameter(
        (), "Virtual mass and inertia.", unit="kg, kg m^2", length=6, minimum=0.0001, maximum=1000000.0
    )
    damping_ratio: tuple[float, ...] = parameter((), "Damping relative to the critical one.", length=6)
    stiffness: tuple[float, ...] = parameter(
        (), "Virtual stiffness.", unit="N/m, N m/rad", length=6, minimum=0.0, maximum=100000000.0
    )
    joint_damping: float = parameter(5.0, "Damping of the joints' own drift.", unit="1/s", minimum=0.0)


@dataclass(frozen=True)
class AdmittanceParameters(Parameters):
    """Parameters of the admittance controller, as ROS names them."""

    joints: tuple[str, ...] = parameter((), "Joints of the chain.", not_empty=True, unique=True, read_only=True)
    command_joints: tuple[str, ...] = parameter(
        (), "Joints that are commanded; empty for those in joints.", unique=True, read_only=True
    )
    command_interfaces: tuple[str, ...] = parameter(
        (), "Interfaces that are commanded.", choices=("position", "velocity"), not_empty=True, read_only=True
    )
    state_interfaces: tuple[str, ...] = parameter(
        (), "Interfaces that are measured.", choices=("position", "velocity", "acceleration"), not_empty=True,
        read_only=True,
    )  # fmt: skip
    chainable_command_interfaces: tuple[str, ...] = parameter(
        ("position", "velocity"), "References that other controllers may command.", choices=("position", "velocity"),
        read_only=True,
    )  # fmt: skip
    kinematics: Kinematics = group(Kinematics)
    ft_sensor: ForceSensor = group(ForceSensor)
    control: FrameHolder = group(FrameHolder)
    fixed_world_frame: FrameHolder = group(FrameHolder)
    gravity_compensation: GravityCompensation = group(GravityCompensation)
    admittance: LawParameters = group(LawParameters)
    enable_parameter_update_without_reactivation: bool = parameter(
        True, "Whether changed parameters take effect while the controller is active."
    )

    def check(self) -> None:
        """Check the combination of interfaces and joints."""
        if "position" not in self.state_interfaces:
            raise ParameterError("state_interfaces", "must have position")
        if self.command_joints and len(self.command_joints) != len(self.joints):
            count = len(self.joints)
            raise ParameterError("command_joints", f"has {len(self.command_joints)} elements, joints has {count}")


class AdmittanceController(Controller):
    """Controller of joint references from ``~/joint_references`` or other controllers, compliant to forces."""

    names = ("admittance_controller/AdmittanceController",)
    Parameters = AdmittanceParameters
    chainable = True
    parameters: AdmittanceParameters

    def configure(self) -> None:
        """Set the interface names, and find the chain."""
        p = self.parameters
        if self.context.robot is None:
            raise ControlError("the robot's description is needed for its kinematics, and is not there")
        self._chain = Chain(self.context.robot, p.kinematics.base, p.kinematics.tip, p.joints)
        for frame in (p.ft_sensor.frame, p.control.frame, p.gravity_compensation.frame):
            if not frame.external:
                self._chain.row(frame.id)
        self._count = len(p.joints)
        self.command_names = interface_names(p.command_joints or p.joints, p.command_interfaces)
        axes = tuple(f"{p.ft_sensor.name}/{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz")
        self.state_names = (*interface_names(p.joints, ["position"]), *axes)
        self._received: TrajectoryPoint | None = None
        self.references = Interfaces(interface_names(p.joints, p.chainable_command_interfaces))
        self._take_law()

    def reconfigure(self, parameters: AdmittanceParameters) -> None:
        """Apply the changed law."""
        super().reconfigure(parameters)
        if parameters.enable_parameter_update_without_reactivation:
            self._take_law()

    def _take_law(self) -> None:
        given = self.parameters.admittance
        self._law = AdmittanceLaw.of_ratio(
            np.array(given.selected_axes, dtype=bool),
            np.array(given.mass),
            np.array(given.damping_ratio),
            np.array(given.stiffness),
            given.joint_damping,
            self.parameters.kinematics.alpha,
        )

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """State of the admittance law."""
        return {"~/status": AdmittanceSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """References of the joints."""
        return {"~/joint_references": Subscription(TrajectoryPoint, self._take)}

    def _take(self, point: TrajectoryPoint) -> None:
        for name in ("positions", "velocities"):
            values = getattr(point, name)
            if values is not None and len(values) != self._count:
                self.context.warn(f"reference has {len(values)} {name} for {self._count} joints; it is ignored")
                return
        if point.positions is None:
            self.context.warn("reference has no positions; it is ignored")
            return
        self._received = point

    def activate(self, now_ns: int) -> None:
        """Hold the joints at their positions, and use the sensor from now on."""
        self._take_law()
        values = self.states.read()
        self._reference = values[: self._count].copy()
        if np.isnan(self._reference).any():
            raise ControlError("positions of joints are not known yet")
        self._reference_rate = np.zeros(self._count)
        self._received = None
        self._state = AdmittanceState.none(self._count)
        self._wrench: np.ndarray | None = None
        self.references.values[:] = np.nan

    def deactivate(self) -> None:
        """Stop."""
        if "velocity" in self.parameters.command_interfaces:
            place = self.parameters.command_interfaces.index("velocity") * self._count
            commands = self.commands.read()
            commands[place : place + self._count] = 0.0
            self.commands.write(commands)

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last received references."""
        if self._received is None:
            return
        rates = self._received.velocities
        for row, kind in enumerate(self.parameters.chainable_command_interfaces):
            values = self._received.positions if kind == "position" else rates
            place = slice(row * self._count, (row + 1) * self._count)
            self.references.values[place] = np.zeros(self._count) if values is None else values

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Move the joints so that the tip yields to the measured wrench."""
        self._read_references()
        values = self.states.read()
        positions = values[: self._count]
        wrench = self._filtered(values[self._count :], positions)
        rotation = self._rotation(self.parameters.control.frame, positions)
        self._state = advance(self._law, self._chain, self._state, self._reference, rotation, wrench, period)
        wanted = {
            "position": self._reference + self._state.joints,
            "velocity": self._reference_rate + self._state.joint_velocities,
        }
        self.commands.write(np.concatenate([wanted[kind] for kind in self.parameters.command_interfaces]))
        if self.context.has_subscribers("~/status"):
            yield self._sample(now_ns, rotation, wrench)

    def _read_references(self) -> None:
        given = self.references.values.reshape(-1, self._count)
        for kind, values in zip(self.parameters.chainable_command_interfaces, given, strict=True):
            known = ~np.isnan(values)
            target = self._reference if kind == "position" else self._reference_rate
            target[known] = values[known]

    def _rotation(self, frame: Frame, positions: np.ndarray) -> np.ndarray:
        """Return a frame's rotation in the base; a frame outside of the robot counts as the base's."""
        return np.eye(3) if frame.external else self._chain.pose(positions, frame.id)[1]

    def _filtered(self, measured: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Return the filtered external wrench in the base's axes; a missing measurement counts as zero."""
        tool, sensor = self.parameters.gravity_compensation, self.parameters.ft_sensor.frame
        rotation = self._rotation(sensor, positions)
        centre = self._rotation(tool.frame, positions) @ np.array(tool.CoG.pos)
        down = self._rotation(self.parameters.fixed_world_frame.frame, positions) @ np.array((0.0, 0.0, -1.0))
        wrench = without_weight(np.nan_to_num(measured), rotation, tool.CoG.force, centre, down)
        share = min(self.parameters.ft_sensor.filter_coefficient, 1.0)
        before = wrench if self._wrench is None else self._wrench
        self._wrench = share * wrench + (1.0 - share) * before
        return self._wrench

    def _sample(self, now_ns: int, rotation: np.ndarray, wrench: np.ndarray) -> AdmittanceSample:
        position, orientation = (
            (np.zeros(3), np.eye(3))
            if self.parameters.ft_sensor.frame.external
            else self._chain.pose(self._reference, self.parameters.ft_sensor.frame.id)
        )
        return AdmittanceSample(
            stamp_ns=now_ns,
            topic="~/status",
            frame_id=self.parameters.kinematics.base,
            mass=self._law.mass,
            damping=self._law.damping,
            stiffness=self._law.stiffness,
            selected=self._law.selected,
            control_orientation=np.array(quaternion_from_matrix(rotation)),
            sensor_frame=self.parameters.ft_sensor.frame.id,
            sensor_position=position,
            sensor_orientation=np.array(quaternion_from_matrix(orientation)),
            offset=self._state.offset,
            velocity=self._state.velocity,
            acceleration=self._state.acceleration,
            wrench=wrench,
            joints=self.parameters.joints,
            joint_offset=self._state.joints,
            joint_velocity=self._state.joint_velocities,
        )
