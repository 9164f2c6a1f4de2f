"""Data model of URDF robots: a tree of links and joints, with extensions of simulators and controllers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from daidalos.description.joint import Joint
from daidalos.description.link import Link, Material
from daidalos.description.markup import Element


@dataclass(frozen=True)
class Actuator:
    """Motor of a transmission."""

    name: str
    mechanical_reduction: float = 1.0
    hardware_interfaces: tuple[str, ...] = ()


@dataclass(frozen=True)
class TransmissionJoint:
    """Joint driven by a transmission."""

    name: str
    hardware_interfaces: tuple[str, ...] = ()
    mechanical_reduction: float = 1.0
    offset: float = 0.0
    role: str = ""


@dataclass(frozen=True)
class Transmission:
    """Transmission between motors and joints."""

    name: str
    type: str
    joints: tuple[TransmissionJoint, ...]
    actuators: tuple[Actuator, ...]


@dataclass(frozen=True)
class GazeboExtension:
    """``<gazebo>`` element with settings for the robot, or for the link or joint `reference`."""

    reference: str
    element: Element = field(compare=False)


@dataclass(frozen=True)
class Robot:
    """Robot of a URDF file.

    Parameters
    ----------
    name : str
    links, joints : mapping
        By name, in the order of the file.
    root : str
        The link that is nobody's child.
    materials : mapping
        Named ones, by name.
    transmissions : tuple of Transmission
    gazebo : tuple of GazeboExtension
        ``<gazebo>`` elements in the order of the file.
    ros2_control : tuple of Element
        ``<ros2_control>`` elements as they are.
    source : str
        File or other origin.
    warnings : tuple of str
        What is odd but does not stand in the way.
    """

    name: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    root: str
    materials: Mapping[str, Material] = field(default_factory=dict)
    transmissions: tuple[Transmission, ...] = ()
    gazebo: tuple[GazeboExtension, ...] = ()
    ros2_control: tuple[Element, ...] = ()
    source: str = ""
    warnings: tuple[str, ...] = ()
