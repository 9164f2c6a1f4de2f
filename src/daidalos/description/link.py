"""Links of URDF and SDF: inertia, visuals, collisions and sensors."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.geometry import Geometry
from daidalos.description.markup import Element

Rgba = tuple[float, float, float, float]


@dataclass(frozen=True)
class Material:
    """Colours of a visual.

    Parameters
    ----------
    name : str
        As the description names it; empty when it does not.
    color : tuple of 4 floats or None
        Red, green, blue, alpha in 0..1 (SDF's diffuse); None when only a texture or a name is given.
    ambient, specular, emissive : tuple of 4 floats or None
        As SDF gives them.
    texture : str
        The image's uri as written, empty when none.
    texture_path : Path or None
        The file that it means here.
    """

    name: str = ""
    color: Rgba | None = None
    ambient: Rgba | None = None
    specular: Rgba | None = None
    emissive: Rgba | None = None
    texture: str = ""
    texture_path: Path | None = None


@dataclass(frozen=True)
class Surface:
    """Contact properties of a collision; None for values that the description leaves open.

    Parameters
    ----------
    mu, mu2 : float or None
        Coulomb friction along the first direction and across it.
    direction : tuple of 3 floats
        The first direction (``fdir1``); zero leaves it to the simulator.
    direction_frame : str
        The link in whose axes it stands still while the surface turns; empty for the surface's own.
    slip1, slip2 : float or None
        Force dependent slip [1/(N s)] in the two directions.
    torsional : float or None
        Coefficient of torsional friction.
    patch_radius : float
        Radius of the contact patch that torsional friction acts on [m].
    kp, kd : float or None
        Contact stiffness [N/m] and damping [N s/m].
    restitution : float
        Share of the approach speed that is given back, 0..1.
    restitution_threshold : float
        Approach speed below which nothing bounces [m/s].
    collide : bool
        False for a collision that touches nothing (``collide_without_contact``).
    bitmask : int
        Two collisions meet when their masks have a bit in common.
    """

    mu: float | None = None
    mu2: float | None = None
    direction: Vector = (0.0, 0.0, 0.0)
    direction_frame: str = ""
    slip1: float | None = None
    slip2: float | None = None
    torsional: float | None = None
    patch_radius: float = 0.0
    kp: float | None = None
    kd: float | None = None
    restitution: float = 0.0
    restitution_threshold: float = 0.0
    collide: bool = True
    bitmask: int = 0xFFFF


@dataclass(frozen=True)
class Inertial:
    """Mass properties of a link.

    Parameters
    ----------
    mass : float
        [kg].
    pose : Pose
        The centre of mass frame in the link.
    inertia : tuple of 6 floats
        ixx, ixy, ixz, iyy, iyz, izz about the centre of mass in `pose`'s axes [kg m^2].
    """

    mass: float
    pose: Pose = field(default_factory=Pose)
    inertia: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Visual:
    """Visual geometry, placed in its link."""

    geometry: Geometry
    pose: Pose = field(default_factory=Pose)
    material: Material | None = None
    name: str = ""
    transparency: float = 0.0
    cast_shadows: bool = True
    visibility_flags: int = 0xFFFFFFFF
    label: int | None = None


@dataclass(frozen=True)
class Collision:
    """Collision geometry, placed in its link."""

    geometry: Geometry
    pose: Pose = field(default_factory=Pose)
    surface: Surface = field(default_factory=Surface)
    name: str = ""
    laser_retro: float = 0.0
    where: str = field(default="", compare=False)


@dataclass(frozen=True)
class Plugin:
    """Plugin of a world, a model or a sensor.

    Parameters
    ----------
    name : str
        Its name in the description.
    filename : str
        The library that Gazebo would load, such as ``libgazebo_ros_diff_drive.so``.
    element : Element
        The element with its parameters.
    scope : str
        The nested model that it was written in, such as ``arm::hand``; empty for the model itself.
    """

    name: str
    filename: str
    element: Element = field(compare=False)
    scope: str = ""


@dataclass(frozen=True)
class Sensor:
    """Sensor on a link or a joint; the settings of its type stay in `element`.

    Parameters
    ----------
    name, type : str
        As SDF has them.
    element : Element
        The whole element; the simulator's class for `type` reads its part of it.
    pose : Pose
        In the link (for a joint's sensor: in the joint's child link).
    update_rate : float
        [Hz]; 0 means every simulation step.
    topic : str
        Where it publishes; empty for the simulator's default.
    plugins : tuple of Plugin
        ROS's plugins inside the sensor.
    """

    name: str
    type: str
    element: Element = field(compare=False)
    pose: Pose = field(default_factory=Pose)
    update_rate: float = 0.0
    topic: str = ""
    always_on: bool = True
    visualize: bool = False
    plugins: tuple[Plugin, ...] = ()


@dataclass(frozen=True)
class Link:
    """Rigid body.

    Parameters
    ----------
    name : str
    pose : Pose
        In the model's frame with every joint at zero (SDF); identity in a URDF robot, whose joints place it.
    inertial : Inertial or None
        None when the description gives none.
    visuals, collisions, sensors, lights : tuple
        What it carries.
    gravity, kinematic, self_collide, wind : bool or None
        SDF's switches; `self_collide` None leaves it to the model.
    static : bool
        Part of a nested model that does not move, whatever pushes.
    where : str
        The place in the description, for errors.
    """

    name: str
    pose: Pose = field(default_factory=Pose)
    inertial: Inertial | None = None
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    lights: tuple[Light, ...] = ()
    gravity: bool = True
    kinematic: bool = False
    self_collide: bool | None = None
    wind: bool = False
    static: bool = False
    linear_damping: float = 0.0
    angular_damping: float = 0.0
    where: str = field(default="", compare=False)


@dataclass(frozen=True)
class Light:
    """Light source.

    Parameters
    ----------
    name : str
    type : str
        ``point``, ``spot`` or ``directional``.
    pose : Pose
        In the world, or in the link that carries it.
    diffuse, specular : tuple of 4 floats
        Colours, 0..1.
    direction : tuple of 3 floats
        Where it shines, in its own frame.
    attenuation_range, attenuation_constant, attenuation_linear, attenuation_quadratic : float
        How it fades [m, -, 1/m, 1/m^2].
    intensity : float
        Factor on its colours.
    cast_shadows, on : bool
    spot_inner_angle, spot_outer_angle, spot_falloff : float
        The cone of a spot [rad] and how it fades to its rim.
    """

    name: str
    type: str
    pose: Pose = field(default_factory=Pose)
    diffuse: Rgba = (1.0, 1.0, 1.0, 1.0)
    specular: Rgba = (0.1, 0.1, 0.1, 1.0)
    direction: Vector = (0.0, 0.0, -1.0)
    attenuation_range: float = 10.0
    attenuation_constant: float = 1.0
    attenuation_linear: float = 1.0
    attenuation_quadratic: float = 0.0
    intensity: float = 1.0
    cast_shadows: bool = False
    on: bool = True
    spot_inner_angle: float = 0.0
    spot_outer_angle: float = 0.0
    spot_falloff: float = 0.0
