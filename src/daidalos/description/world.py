"""Data model of SDF models and worlds, with all poses resolved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.joint import Joint
from daidalos.description.link import Light, Link, Plugin, Rgba
from daidalos.description.markup import Element


@dataclass(frozen=True)
class Model:
    """Links and joints that are placed, spawned and deleted together.

    Nested models are flattened: their links, joints and frames are here as ``nested::name``.

    Parameters
    ----------
    name : str
    pose : Pose
        The model's frame in the world.
    links, joints : mapping
        By name; a link's pose is in the model's frame.
    frames : mapping
        Poses in the model's frame of everything that has a name: links, joints, frames, nested models.
    carriers : mapping
        The links that frames, joints and nested models are attached to; ``__model__`` stands for the model itself.
    static : bool
        Does not move, whatever pushes.
    scripted : bool
        Moves by a script alone (the figure of an actor).
    self_collide : bool
        Its links touch each other.
    plugins : tuple of Plugin
    ros2_control : tuple of Element
        ``<ros2_control>`` elements of the robot that it was made from.
    placement_frame : str
        The frame that `pose` placed; empty for the model's own.
    source : str
        File or other origin.
    warnings : tuple of str
        What is odd but does not stand in the way.
    """

    name: str
    pose: Pose = field(default_factory=Pose)
    links: Mapping[str, Link] = field(default_factory=dict)
    joints: Mapping[str, Joint] = field(default_factory=dict)
    frames: Mapping[str, Pose] = field(default_factory=dict)
    carriers: Mapping[str, str] = field(default_factory=dict)
    static: bool = False
    scripted: bool = False
    self_collide: bool = False
    wind: bool = False
    plugins: tuple[Plugin, ...] = ()
    ros2_control: tuple[Element, ...] = ()
    placement_frame: str = ""
    source: str = ""
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Physics:
    """Settings of a world's physics steps.

    Parameters
    ----------
    max_step_size : float
        [s].
    real_time_factor : float
        Wanted speed; 0 is as fast as possible.
    real_time_update_rate : float
        Gazebo classic's steps per second of wall time; 0 is as fast as possible.
    """

    max_step_size: float = 0.001
    real_time_factor: float = 1.0
    real_time_update_rate: float = 1000.0


@dataclass(frozen=True)
class Scene:
    """Visual settings of a world.

    Parameters
    ----------
    ambient, background : tuple of 4 floats
        Colours, 0..1.
    shadows, grid : bool
    sky : bool
        A sky that is lighter at the horizon instead of the background; so it is where the world names no background.
    """

    ambient: Rgba = (0.4, 0.4, 0.4, 1.0)
    background: Rgba = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    grid: bool = True
    sky: bool = True


@dataclass(frozen=True)
class SphericalCoordinates:
    """Geographic position of the world's origin.

    Parameters
    ----------
    latitude, longitude : float
        [deg].
    elevation : float
        [m].
    heading : float
        From east to the world's x axis, counter-clockwise [deg].
    """

    latitude: float = 0.0
    longitude: float = 0.0
    elevation: float = 0.0
    heading: float = 0.0


@dataclass(frozen=True)
class Atmosphere:
    """Temperature [K], its gradient [K/m] and pressure [Pa] at sea level."""

    temperature: float = 288.15
    temperature_gradient: float = -0.0065
    pressure: float = 101325.0


@dataclass(frozen=True)
class Waypoint:
    """Pose of an actor at a time [s] of its script."""

    time: float
    pose: Pose


@dataclass(frozen=True)
class Actor:
    """Animated figure that follows a script and is not affected by forces.

    Parameters
    ----------
    name : str
    pose : Pose
        Where it stands when it has no script.
    waypoints : tuple of Waypoint
        Sorted by time.
    loop : bool
        Starts again after the last waypoint.
    delay_start : float
        [s].
    auto_start : bool
    skin : str
        The mesh's uri, empty when none.
    model : Model
        Its links with what one sees and touches; static.
    """

    name: str
    model: Model
    pose: Pose = field(default_factory=Pose)
    waypoints: tuple[Waypoint, ...] = ()
    loop: bool = True
    delay_start: float = 0.0
    auto_start: bool = True
    skin: str = ""


@dataclass(frozen=True)
class World:
    """Content of a world file.

    Parameters
    ----------
    name : str
    models : tuple of Model
    lights : tuple of Light
    actors : tuple of Actor
    joints : mapping
        Joints between models; their links are named ``model::link``.
    frames : mapping
        Poses in the world of its named frames.
    physics : Physics
    gravity : tuple of 3 floats
        [m/s^2].
    magnetic_field : tuple of 3 floats
        [T].
    wind : tuple of 3 floats
        [m/s].
    scene, atmosphere, spherical_coordinates
        See their classes.
    plugins : tuple of Plugin
    source : str
        File or other origin.
    warnings : tuple of str
        What is odd but does not stand in the way.
    """

    name: str = "default"
    models: tuple[Model, ...] = ()
    lights: tuple[Light, ...] = ()
    actors: tuple[Actor, ...] = ()
    joints: Mapping[str, Joint] = field(default_factory=dict)
    frames: Mapping[str, Pose] = field(default_factory=dict)
    physics: Physics = field(default_factory=Physics)
    gravity: Vector = (0.0, 0.0, -9.8)
    magnetic_field: Vector = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    wind: Vector = (0.0, 0.0, 0.0)
    scene: Scene = field(default_factory=Scene)
    atmosphere: Atmosphere = field(default_factory=Atmosphere)
    spherical_coordinates: SphericalCoordinates | None = None
    plugins: tuple[Plugin, ...] = ()
    source: str = ""
    warnings: tuple[str, ...] = ()
