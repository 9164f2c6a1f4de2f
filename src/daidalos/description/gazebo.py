"""Conversion of URDF robots with ``<gazebo>`` extensions to models for the simulator.

Does what Gazebo does when a URDF is spawned, except that links on fixed joints stay links of their
own, so that every name of the description keeps its meaning in the simulation.
"""

from __future__ import annotations

from dataclasses import replace

from daidalos.description.joint import Joint
from daidalos.description.kinematics import link_poses_at_zero
from daidalos.description.link import Collision, Link, Material, Plugin, Sensor, Surface, Visual
from daidalos.description.markup import Element
from daidalos.description.named_colors import named_color
from daidalos.description.robot import Robot
from daidalos.description.sdf.frames import read_pose
from daidalos.description.sdf.links import read_direction, read_plugin, read_sensor
from daidalos.description.transmissions import control_from_transmissions
from daidalos.description.world import Model


def model_from_robot(robot: Robot) -> Model:
    """Convert a robot to a model.

    Parameters
    ----------
    robot : Robot
        Its root link becomes the model's frame. A root link called ``world`` becomes the world, to
        which its children are then attached.

    Returns
    -------
    Model

    Raises
    ------
    DescriptionError
        When an extension is wrong.
    """
    extensions = _Extensions(robot)
    poses = link_poses_at_zero(robot)
    in_world = robot.root == "world"
    links = {
        name: extensions.apply_to_link(replace(link, pose=poses[name]))
        for name, link in robot.links.items()
        if not (in_world and name == robot.root)
    }
    joints = {name: extensions.apply_to_joint(joint) for name, joint in robot.joints.items()}
    frames = poses | {joint.name: poses[joint.parent] @ joint.origin for joint in joints.values()}
    return Model(
        name=robot.name,
        links=links,
        joints=joints,
        frames=frames,
        static=extensions.robot_flag("static"),
        self_collide=extensions.robot_flag("self_collide", "selfCollide"),
        plugins=tuple(extensions.plugins),
        ros2_control=robot.ros2_control or control_from_transmissions(robot),
        source=robot.source,
        warnings=(*robot.warnings, *extensions.warnings),
    )


class _Extensions:
    """``<gazebo>`` elements of a robot by their references."""

    def __init__(self, robot: Robot) -> None:
        self._of_robot: list[Element] = []
        self._of: dict[str, list[Element]] = {}
        self.plugins: list[Plugin] = []
        self.warnings: list[str] = []
        for extension in robot.gazebo:
            element, reference = extension.element, extension.reference
            self.plugins += [read_plugin(child) for child in element.all("plugin")]
            if not reference:
                self._of_robot.append(element)
            elif reference in robot.links or reference in robot.joints:
                self._of.setdefault(reference, []).append(element)
            else:
                self.warnings.append(
                    f"{element.where}: {element.label}: refers to {reference!r}, neither a link nor a joint"
                )

    def robot_flag(self, *tags: str) -> bool:
        return any(element.flag_of(*tags, default=False) for element in self._of_robot)

    def apply_to_link(self, link: Link) -> Link:
        elements = self._of.get(link.name, [])
        sensors = tuple(_sensor(child) for e in elements for child in e.all("sensor"))
        surface = _surface(elements)
        material = _material(elements)
        laser_retro = _number(elements, "laserRetro", "laser_retro") or 0.0
        weightless = _flag(elements, "turnGravityOff")
        return replace(
            link,
            gravity=not weightless if weightless is not None else _flag(elements, "gravity") is not False,
            self_collide=_flag(elements, "selfCollide", "self_collide"),
            kinematic=bool(_flag(elements, "kinematic")),
            visuals=tuple(_colored(visual, material) for visual in link.visuals),
            collisions=tuple(
                replace(_number_name(collision, link, i), surface=surface, laser_retro=laser_retro)
                for i, collision in enumerate(link.collisions)
            ),
            sensors=link.sensors + sensors,
        )

    def apply_to_joint(self, joint: Joint) -> Joint:
        elements = self._of.get(joint.name, [])
        stiffness = _number(elements, "springStiffness")
        if stiffness is not None and joint.axes:
            reference = _number(elements, "springReference") or 0.0
            axis = replace(joint.axis, spring_stiffness=stiffness, spring_reference=reference)
            joint = replace(joint, axes=(axis, *joint.axes[1:]))
        sensors = tuple(_sensor(child) for e in elements for child in e.all("sensor"))
        return replace(joint, sensors=joint.sensors + sensors)


def _sensor(element: Element) -> Sensor:
    return read_sensor(element, lambda child: read_pose(child).pose)


def _surface(elements: list[Element]) -> Surface:
    given = next((e.first("fdir1") for e in reversed(elements) if e.first("fdir1") is not None), None)
    direction, direction_frame = read_direction(given)
    return Surface(
        direction=direction,
        direction_frame=direction_frame,
        mu=_number(elements, "mu1", "mu"),
        mu2=_number(elements, "mu2"),
        slip1=_number(elements, "slip1"),
        slip2=_number(elements, "slip2"),
        kp=_number(elements, "kp"),
        kd=_number(elements, "kd"),
    )


def _number(elements: list[Element], *tags: str) -> float | None:
    """Return the last value given; ``<mu1 value="0.2"/>`` is an old notation."""
    value: float | None = None
    for element in elements:
        child = element.first(*tags)
        if child is not None:
            value = child.number_attribute("value") if "value" in child.attributes else child.number()
    return value


def _flag(elements: list[Element], *tags: str) -> bool | None:
    """Return the last value given."""
    value: bool | None = None
    for element in elements:
        if element.first(*tags) is not None:
            value = element.flag_of(*tags, default=False)
    return value


def _material(elements: list[Element]) -> Material | None:
    name = ""
    for element in elements:
        name = element.text_of("material", default=name)
    color = named_color(name)
    return None if color is None else Material(name, color, ambient=color)


def _colored(visual: Visual, material: Material | None) -> Visual:
    return visual if material is None else replace(visual, material=material)


def _number_name(collision: Collision, link: Link, index: int) -> Collision:
    """Name a collision as Gazebo does, for contact messages."""
    if collision.name:
        return collision
    suffix = f"_{index}" if index else ""
    return replace(collision, name=f"{link.name}_collision{suffix}")
