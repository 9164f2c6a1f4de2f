"""URDF's ``<transmission>``: what lies between actuators and joints."""

from __future__ import annotations

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element
from daidalos.description.robot import Actuator, Transmission, TransmissionJoint


def read_transmissions(root: Element, warnings: list[str]) -> tuple[Transmission, ...]:
    """Read the transmissions of a robot, in both notations of ROS 1 and in that of ROS 2.

    Parameters
    ----------
    root : Element
        ``<robot>``.
    warnings : list of str
        Takes a line for each transmission that is wrong and left out: only some controllers need them.
    """
    transmissions = []
    for element in root.all("transmission"):
        try:
            transmissions.append(_transmission(element))
        except DescriptionError as problem:
            warnings.append(f"{problem}; the transmission is left out")
    return tuple(transmissions)


def _transmission(element: Element) -> Transmission:
    joints = (
        TransmissionJoint(
            name=child.attribute("name", ""),
            hardware_interfaces=_hardware_interfaces(child),
            mechanical_reduction=child.number_of("mechanical_reduction", "mechanicalReduction", default=1.0),
            offset=child.number_of("offset", default=0.0),
            role=child.attribute("role", child.text_of("role")),
        )
        for child in element.all("joint")
    )
    actuators = (
        Actuator(
            name=child.attribute("name", ""),
            mechanical_reduction=child.number_of("mechanical_reduction", "mechanicalReduction", default=1.0),
            hardware_interfaces=_hardware_interfaces(child),
        )
        for child in element.all("actuator")
    )
    return Transmission(
        name=element.attribute("name", ""),
        type=element.text_of("type", "plugin", default=element.attribute("type", "")),
        joints=tuple(joints),
        actuators=tuple(actuators),
    )


def _hardware_interfaces(element: Element) -> tuple[str, ...]:
    return tuple(child.text.strip() for child in element.all("hardwareInterface", "hardware_interface"))
