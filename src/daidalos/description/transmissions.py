"""URDF's ``<transmission>``: transmissions between actuators and joints."""

from __future__ import annotations

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element
from daidalos.description.robot import Actuator, Robot, Transmission, TransmissionJoint

_COMMANDS = {f"{what.capitalize()}JointInterface": what for what in ("position", "velocity", "effort")}
_STATES = ("position", "velocity", "effort")


def read_transmissions(root: Element, warnings: list[str]) -> tuple[Transmission, ...]:
    """Read the transmissions of a robot, in both notations of ROS 1 and in that of ROS 2.

    Parameters
    ----------
    root : Element
        ``<robot>``.
    warnings : list of str
        Called with a line for each transmission that is wrong and left out: only some controllers need them.
    """
    transmissions = []
    for element in root.all("transmission"):
        try:
            transmissions.append(_transmission(element))
        except DescriptionError as problem:
            warnings.append(f"{problem}; the transmission is left out")
    return tuple(transmissions)


def control_from_transmissions(robot: Robot) -> tuple[Element, ...]:
    """Return the ``<ros2_control>`` element for a robot's ROS 1 transmissions; None without them.

    Parameters
    ----------
    robot : Robot
    """
    commands: dict[str, list[str]] = {}
    for joint in (joint for transmission in robot.transmissions for joint in transmission.joints):
        names = [name.rpartition("/")[2] for name in joint.hardware_interfaces]
        commands.setdefault(joint.name, []).extend(_COMMANDS[name] for name in names if name in _COMMANDS)
    joints = [
        Element(
            "joint",
            {"name": name},
            children=[
                *(Element("command_interface", {"name": one}) for one in dict.fromkeys(wanted)),
                *(Element("state_interface", {"name": one}) for one in _STATES),
            ],
            source=robot.source,
        )
        for name, wanted in commands.items()
        if name in robot.joints
    ]
    if not joints:
        return ()
    plugin = Element("plugin", text="gazebo_ros2_control/GazeboSystem")
    attributes = {"name": "transmissions", "type": "system"}
    return (Element("ros2_control", attributes, "", [Element("hardware", children=[plugin]), *joints], robot.source),)


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
