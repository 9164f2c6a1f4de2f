"""Admittance controller: joints follow their references and yield to what a force sensor feels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from daidalos.common.pose3 import quaternion_from_matrix
from daidalos.control.admittance import AdmittanceLaw, AdmittanceState, advance, without_weight
from daidalos.control.chain import Chain
from daidalos.control.controllers.base import Controller, Subscription
from daidalos.control.errors import ControlError, ParameterError
from daidalos.control.interfaces import Interfaces, interface_names
from daidalos.control.parameters import (
    above,
    at_least,
    elements_within,
    not_empty,
    parameter,
    size,
    subset_of,
    unique,
)
from daidalos.control.samples import AdmittanceSample, TrajectoryPoint
from daidalos.simulation.samples import Sample


@dataclass(frozen=True)
class Kinematics:
    """The chain; plugins of others are read and ours is used."""

    plugin_name: str = parameter("", read_only=True)
    plugin_package: str = parameter("", read_only=True)
    base: str = parameter("", not_empty, read_only=True)
    tip: str = parameter("", not_empty, read_only=True)
    alpha: float = parameter(0.0005, at_least(0.0))


@dataclass(frozen=True)
class Frame:
    """A frame: a link of the robot, or one outside of it."""

    id: str = parameter("", not_empty, read_only=True)
    external: bool = parameter(default=False, read_only=True)


@dataclass(frozen=True)
class ForceSensor:
    """The force-torque sensor, its frame, and how much of a new value counts (1: all)."""

    name: str = parameter("", not_empty, read_only=True)
    frame: Frame = field(default_factory=Frame)
    filter_coefficient: float = parameter(0.05, above(0.0))


@dataclass(frozen=True)
class FrameHolder:
    """A named frame."""

    frame: Frame = field(default_factory=Frame)


@dataclass(frozen=True)
class CentreOfGravity:
    """Of the tool: position in the frame [m] and weight [N]."""

    pos: tuple[float, ...] = parameter((0.0, 0.0, 0.0), size(3))
    force: float = parameter(0.0)


@dataclass(frozen=True)
class GravityCompensation:
    """What the sensor carries beside the outside force."""

    frame: Frame = field(default_factory=Frame)
    CoG: CentreOfGravity = field(default_factory=CentreOfGravity)


@dataclass(frozen=True)
class LawParameters:
    """The law along and about the axes of the control frame; see `AdmittanceLaw`."""

    selected_axes: tuple[bool, ...] = parameter((True,) * 6, size(6))
    mass: tuple[float, ...] = parameter((), size(6), elements_within(0.0001, 1000000.0))
    damping_ratio: tuple[float, ...] = parameter((), size(6))
    stiffness: tuple[float, ...] = parameter((), size(6), elements_within(0.0, 100000000.0))
    joint_damping: float = parameter(5.0, at_least(0.0))


@dataclass(frozen=True)
class AdmittanceParameters:
    """Parameters, as ROS names them."""

    joints: tuple[str, ...] = parameter((), not_empty, unique, read_only=True)
    command_joints: tuple[str, ...] = parameter((), unique, read_only=True)
    command_interfaces: tuple[str, ...] = parameter((), not_empty, subset_of("position", "velocity"), read_only=True)
    state_interfaces: tuple[str, ...] = parameter(
        (), not_empty, subset_of("position", "velocity", "acceleration"), read_only=True
    )
    chainable_command_interfaces: tuple[str, ...] = parameter(
        ("position", "velocity"), subset_of("position", "velocity"), read_only=True
    )
    kinematics: Kinematics = field(default_factory=Kinematics)
    ft_sensor: ForceSensor = field(default_factory=ForceSensor)
    control: FrameHolder = field(default_factory=FrameHolder)
    fixed_world_frame: FrameHolder = field(default_factory=FrameHolder)
    gravity_compensation: GravityCompensation = field(default_factory=GravityCompensation)
    admittance: LawParameters = field(default_factory=LawParameters)
    enable_parameter_update_without_reactivation: bool = parameter(default=True)

    def check(self) -> None:
        """Refuse what can not be controlled."""
        if "position" not in self.state_interfaces:
            raise ParameterError("state_interfaces", "must have position")
        if self.command_joints and len(self.command_joints) != len(self.joints):
            count = len(self.joints)
            raise ParameterError("command_joints", f"has {len(self.command_joints)} elements, joints has {count}")


class AdmittanceController(Controller):
    """Moves joints to references from ``~/joint_references`` or other controllers, less what forces push away."""

    names = ("admittance_controller/AdmittanceController",)
    parameters = AdmittanceParameters
    chainable = True
    p: AdmittanceParameters

    def configure(self) -> None:
        """Name interfaces and find the chain."""
        p = self.p
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
        """Take the law."""
        super().reconfigure(parameters)
        if parameters.enable_parameter_update_without_reactivation:
            self._take_law()

    def _take_law(self) -> None:
        given = self.p.admittance
        self._law = AdmittanceLaw.of_ratio(
            np.array(given.selected_axes, dtype=bool),
            np.array(given.mass),
            np.array(given.damping_ratio),
            np.array(given.stiffness),
            given.joint_damping,
            self.p.kinematics.alpha,
        )

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """The state of the law."""
        return {"~/status": AdmittanceSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """References."""
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
        """Hold the joints where they are; what the sensor feels counts from now."""
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
        """Stand."""
        if "velocity" in self.p.command_interfaces:
            place = self.p.command_interfaces.index("velocity") * self._count
            commands = self.commands.read()
            commands[place : place + self._count] = 0.0
            self.commands.write(commands)

    def take_references(self, now_ns: int, period: float) -> None:
        """Take what was received last."""
        if self._received is None:
            return
        rates = self._received.velocities
        for row, kind in enumerate(self.p.chainable_command_interfaces):
            values = self._received.positions if kind == "position" else rates
            place = slice(row * self._count, (row + 1) * self._count)
            self.references.values[place] = np.zeros(self._count) if values is None else values

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Let the tip yield."""
        self._read_references()
        values = self.states.read()
        positions = values[: self._count]
        wrench = self._filtered(values[self._count :], positions)
        rotation = self._rotation(self.p.control.frame, positions)
        self._state = advance(self._law, self._chain, self._state, self._reference, rotation, wrench, period)
        wanted = {
            "position": self._reference + self._state.joints,
            "velocity": self._reference_rate + self._state.joint_velocities,
        }
        self.commands.write(np.concatenate([wanted[kind] for kind in self.p.command_interfaces]))
        if self.context.has_subscribers("~/status"):
            yield self._sample(now_ns, rotation, wrench)

    def _read_references(self) -> None:
        given = self.references.values.reshape(-1, self._count)
        for kind, values in zip(self.p.chainable_command_interfaces, given, strict=True):
            known = ~np.isnan(values)
            target = self._reference if kind == "position" else self._reference_rate
            target[known] = values[known]

    def _rotation(self, frame: Frame, positions: np.ndarray) -> np.ndarray:
        """Return a frame's rotation in the base; one outside of the robot is taken to be the base's."""
        return np.eye(3) if frame.external else self._chain.pose(positions, frame.id)[1]

    def _filtered(self, measured: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Return the outside wrench in the base's axes, smoothed; a sensor that says nothing feels nothing."""
        tool, sensor = self.p.gravity_compensation, self.p.ft_sensor.frame
        rotation = self._rotation(sensor, positions)
        centre = self._rotation(tool.frame, positions) @ np.array(tool.CoG.pos)
        down = self._rotation(self.p.fixed_world_frame.frame, positions) @ np.array((0.0, 0.0, -1.0))
        wrench = without_weight(np.nan_to_num(measured), rotation, tool.CoG.force, centre, down)
        share = min(self.p.ft_sensor.filter_coefficient, 1.0)
        before = wrench if self._wrench is None else self._wrench
        self._wrench = share * wrench + (1.0 - share) * before
        return self._wrench

    def _sample(self, now_ns: int, rotation: np.ndarray, wrench: np.ndarray) -> AdmittanceSample:
        position, orientation = (
            (np.zeros(3), np.eye(3))
            if self.p.ft_sensor.frame.external
            else self._chain.pose(self._reference, self.p.ft_sensor.frame.id)
        )
        return AdmittanceSample(
            stamp_ns=now_ns,
            topic="~/status",
            frame_id=self.p.kinematics.base,
            mass=self._law.mass,
            damping=self._law.damping,
            stiffness=self._law.stiffness,
            selected=self._law.selected,
            control_orientation=np.array(quaternion_from_matrix(rotation)),
            sensor_frame=self.p.ft_sensor.frame.id,
            sensor_position=position,
            sensor_orientation=np.array(quaternion_from_matrix(orientation)),
            offset=self._state.offset,
            velocity=self._state.velocity,
            acceleration=self._state.acceleration,
            wrench=wrench,
            joints=self.p.joints,
            joint_offset=self._state.joints,
            joint_velocity=self._state.joint_velocities,
        )
