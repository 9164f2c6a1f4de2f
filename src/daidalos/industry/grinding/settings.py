"""Parameters of a grinding cell: arm, actuator, contact, disc, spindle, sensors and safety."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.parameters import ParameterError, Parameters, group, parameter, parameters_from

GRAVITY = 9.81
PERIOD = 1e-3
"""Period of the force control [s]."""


@dataclass(frozen=True)
class ActuatorParameters(Parameters):
    """Pneumatic actuator with one axis, and its valve."""

    area: float = parameter(1.0e-3, "Area of the piston.", unit="m^2", above=0.0)
    stroke: float = parameter(0.05, "Stroke of the piston.", unit="m", above=0.0)
    mass: float = parameter(4.0, "Mass that the piston carries: grinder, disc and rod.", unit="kg", above=0.0)
    max_pressure: float = parameter(6e5, "Greatest difference of the pressures in both chambers.", unit="Pa", above=0.0)
    valve_time: float = parameter(0.03, "Time constant of the valve, first order.", unit="s", above=0.0)
    valve_delay: float = parameter(0.01, "Dead time of the valve.", unit="s", minimum=0.0, maximum=0.5)
    coulomb_friction: float = parameter(3.0, "Friction of the seals while they slide.", unit="N", minimum=0.0)
    static_friction: float = parameter(4.0, "Friction of the seals before they slide.", unit="N", minimum=0.0)
    stribeck_speed: float = parameter(0.005, "Speed at which static friction has faded.", unit="m/s", above=0.0)
    viscous_friction: float = parameter(60.0, "Friction per speed.", unit="N s/m", minimum=0.0)
    seal_stiffness: float = parameter(1.5e5, "Stiffness of the seals before they slide.", unit="N/m", above=0.0)
    closed_stiffness: float = parameter(8e3, "Stiffness of the air with closed valves.", unit="N/m", above=0.0)

    def check(self) -> None:
        """Refuse a static friction below the sliding one."""
        if self.static_friction < self.coulomb_friction:
            raise ParameterError("static_friction", f"must be at least coulomb_friction, {self.coulomb_friction:g} N")


@dataclass(frozen=True)
class ArmParameters(Parameters):
    """Errors and dynamics of the arm along the tool's axis."""

    delay: float = parameter(0.012, "Dead time of corrections of the path.", unit="s", minimum=0.0, maximum=0.5)
    time_constant: float = parameter(0.04, "Time constant of corrections, first order.", unit="s", above=0.0)
    max_speed: float = parameter(0.1, "Greatest speed of corrections.", unit="m/s", above=0.0)
    position_error: float = parameter(1e-3, "Amplitude of the pose error along the tool.", unit="m", minimum=0.0)
    angle_error: float = parameter(1e-3, "Amplitude of the pose error about the axes.", unit="rad", minimum=0.0)
    error_length: float = parameter(0.15, "Length of the path over which the errors repeat.", unit="m", above=0.0)


@dataclass(frozen=True)
class ContactParameters(Parameters):
    """Contact of the disc: a lumped law in series with the elastic face of the disc."""

    law: str = parameter("kelvin_voigt", "Lumped law.", choices=("kelvin_voigt", "hertz"))
    stiffness: float = parameter(1e5, "Stiffness of disc, spindle and mount (kelvin_voigt).", unit="N/m", above=0.0)
    damping: float = parameter(250.0, "Damping of the contact.", unit="N s/m", minimum=0.0)
    hertz_stiffness: float = parameter(7e6, "Force per deflection^1.5 (hertz).", unit="N/m^1.5", above=0.0)
    face_stiffness: float = parameter(2e9, "Pressure of the face per depth.", unit="Pa/m", above=0.0)


@dataclass(frozen=True)
class DiscParameters(Parameters):
    """Grinding disc: geometry, removal and wear."""

    radius: float = parameter(0.0625, "Outer radius.", unit="m", above=0.0)
    inner_radius: float = parameter(0.02, "Radius within which the face is set back.", unit="m", minimum=0.0)
    preston: float = parameter(2.8e-11, "Removed depth per pressure and way (Preston).", unit="1/Pa", above=0.0)
    friction: float = parameter(0.35, "Coefficient of friction on the workpiece.", minimum=0.0)
    layer: float = parameter(2e-3, "Thickness of the abrasive that may be worn off.", unit="m", above=0.0)
    grinding_ratio: float = parameter(10.0, "Removed volume per worn volume of the disc.", above=0.0)
    dulling: float = parameter(0.3, "Share of the removal that is lost when it is worn out.", minimum=0.0, below=1.0)
    lean: float = parameter(
        0.03, "Angle of the disc against the surface, its contact behind the centre.", unit="rad", above=0.0,
        maximum=0.5,
    )  # fmt: skip
    wear: float = parameter(0.0, "Share of the layer that is worn off at the beginning.", minimum=0.0, maximum=1.0)

    def check(self) -> None:
        """Refuse an inner radius beyond the outer one."""
        if self.inner_radius >= self.radius:
            raise ParameterError("inner_radius", f"must be below radius, {self.radius:g} m")

    @property
    def life(self) -> float:
        """Return the volume that the disc removes until it is worn out [m^3]."""
        return self.grinding_ratio * self.layer * math.pi * (self.radius**2 - self.inner_radius**2)


@dataclass(frozen=True)
class SpindleParameters(Parameters):
    """Motor of the angle grinder."""

    speed: float = parameter(838.0, "Idle speed; 838 rad/s are 8000 turns a minute.", unit="rad/s", above=0.0)
    droop: float = parameter(60.0, "Loss of speed per torque.", unit="rad/s/(N m)", minimum=0.0)
    time_constant: float = parameter(0.15, "Time constant of the speed.", unit="s", above=0.0)
    max_torque: float = parameter(3.0, "Torque at which it is stopped.", unit="N m", above=0.0)
    unbalance: float = parameter(4e-6, "Unbalance of the disc.", unit="kg m", minimum=0.0)


@dataclass(frozen=True)
class SensorParameters(Parameters):
    """Sensors of force and of the cylinder's position."""

    force_noise: float = parameter(0.3, "Standard deviation of the force.", unit="N", minimum=0.0)
    cut_off: float = parameter(25.0, "Cut-off of the force's filter, second order.", unit="Hz", above=0.0)
    position_noise: float = parameter(1e-5, "Standard deviation of the position.", unit="m", minimum=0.0)
    scan_noise: float = parameter(2e-6, "Standard deviation of a scanned height.", unit="m", minimum=0.0)
    timeout: float = parameter(0.05, "Age of a force from which it counts as lost.", unit="s", above=0.0)


@dataclass(frozen=True)
class SafetyParameters(Parameters):
    """When grinding is stopped and the tool lifted off."""

    max_force: float = parameter(150.0, "Force from which it is too great.", unit="N", above=0.0)
    force_error: float = parameter(8.0, "Error of the force that may not last.", unit="N", above=0.0)
    error_time: float = parameter(0.8, "How long such an error may last.", unit="s", above=0.0)
    contact_loss_time: float = parameter(0.3, "How long the contact may be lost.", unit="s", above=0.0)
    touch_force: float = parameter(5.0, "Force with which the disc touches down.", unit="N", above=0.0)
    approach_speed: float = parameter(0.015, "Speed at which it touches down.", unit="m/s", above=0.0)
    standoff: float = parameter(0.01, "Distance from which it touches down.", unit="m", above=0.0)


@dataclass(frozen=True)
class CellParameters(Parameters):
    """Grinding cell."""

    arm: ArmParameters = group(ArmParameters)
    actuator: ActuatorParameters = group(ActuatorParameters)
    contact: ContactParameters = group(ContactParameters)
    disc: DiscParameters = group(DiscParameters)
    spindle: SpindleParameters = group(SpindleParameters)
    sensor: SensorParameters = group(SensorParameters)
    safety: SafetyParameters = group(SafetyParameters)


def read_cell(path: Path) -> CellParameters:
    """Return the parameters in a YAML file, in groups as `CellParameters` has them; what is left out has its default.

    Raises
    ------
    DocumentError
        Where it is no such file.
    """
    content = read_yaml(path)
    if content is None:
        content = {}
    if not isinstance(content, dict):
        raise DocumentError("must be a mapping of groups such as 'actuator'", str(path), 1)
    try:
        return parameters_from(CellParameters, content)
    except ParameterError as error:
        raise DocumentError(str(error), str(path)) from None
