"""``<ros2_control>`` elements of a robot: hardware, its interfaces and their limits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from daidalos.common.errors import Location
from daidalos.description.joint import Joint, Mimic
from daidalos.description.markup import Element
from daidalos.description.robot import Robot
from daidalos.description.world import Model

HARDWARE_TYPES = ("system", "actuator", "sensor")


@dataclass(frozen=True)
class InterfaceInfo:
    """Command or state interface of hardware.

    Parameters
    ----------
    name : str
        Such as ``position``, without the component's name.
    lower, upper : float
        Limits of what is commanded; infinite when there are none.
    initial_value : float
        NaN when there is none.
    data_type : str
        Such as ``double`` or ``bool``.
    limited : bool
        False where ``<limits enable="false"/>`` lifts the limits.
    parameters : mapping
    """

    name: str
    lower: float = -math.inf
    upper: float = math.inf
    initial_value: float = math.nan
    data_type: str = "double"
    limited: bool = True
    parameters: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class ComponentInfo:
    """Joint, sensor or GPIO of hardware.

    Parameters
    ----------
    name : str
    type : str
        ``joint``, ``sensor`` or ``gpio``.
    commands, states : tuple of InterfaceInfo
    parameters : mapping
    limited : bool
        False where ``<limits enable="false"/>`` lifts the limits of all its interfaces.
    mimic : Mimic or None
        The joint that it follows, as the hardware's description or the robot's says.
    joint : Joint or None
        The robot's joint of that name.
    """

    name: str
    type: str
    commands: tuple[InterfaceInfo, ...] = ()
    states: tuple[InterfaceInfo, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    limited: bool = True
    mimic: Mimic | None = None
    joint: Joint | None = None

    @property
    def command_names(self) -> tuple[str, ...]:
        """Full names of the command interfaces, such as ``elbow/position``."""
        return tuple(f"{self.name}/{interface.name}" for interface in self.commands)

    @property
    def state_names(self) -> tuple[str, ...]:
        """Full names of the state interfaces."""
        return tuple(f"{self.name}/{interface.name}" for interface in self.states)


@dataclass(frozen=True)
class TransmissionInfo:
    """Transmission between actuators and joints of hardware; names and mechanical reductions by role."""

    name: str
    plugin: str
    joints: Mapping[str, float]
    actuators: Mapping[str, float]


@dataclass(frozen=True)
class HardwareInfo:
    """Content of a ``<ros2_control>`` element.

    Parameters
    ----------
    name : str
    type : str
        ``system``, ``actuator`` or ``sensor``.
    plugin : str
        Who drives it, such as ``mock_components/GenericSystem``.
    parameters : mapping
        Of the hardware.
    components : tuple of ComponentInfo
        Joints, sensors and GPIOs in the order of the file.
    transmissions : tuple of TransmissionInfo
    rw_rate : float
        How often it is read and written [Hz]; 0 is as often as the controllers run.
    is_async : bool
        Whether it asks for a thread of its own.
    location : Location
        File and line of the element, for errors.
    """

    name: str
    type: str
    plugin: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    components: tuple[ComponentInfo, ...] = ()
    transmissions: tuple[TransmissionInfo, ...] = ()
    rw_rate: float = 0.0
    is_async: bool = False
    location: Location = field(default=Location(), compare=False)

    @property
    def joints(self) -> tuple[ComponentInfo, ...]:
        """Joints among the components."""
        return self._of("joint")

    @property
    def sensors(self) -> tuple[ComponentInfo, ...]:
        """Sensors among the components."""
        return self._of("sensor")

    @property
    def gpios(self) -> tuple[ComponentInfo, ...]:
        """GPIOs among the components."""
        return self._of("gpio")

    @property
    def command_names(self) -> tuple[str, ...]:
        """Full names of all command interfaces."""
        return tuple(name for component in self.components for name in component.command_names)

    @property
    def state_names(self) -> tuple[str, ...]:
        """Full names of all state interfaces."""
        return tuple(name for component in self.components for name in component.state_names)

    def _of(self, kind: str) -> tuple[ComponentInfo, ...]:
        return tuple(component for component in self.components if component.type == kind)


def read_hardware(robot: Robot | Model) -> tuple[HardwareInfo, ...]:
    """Read all ``<ros2_control>`` elements of a robot.

    Parameters
    ----------
    robot : Robot or Model

    Returns
    -------
    tuple of HardwareInfo

    Raises
    ------
    DescriptionError
        When an element is wrong, with its file and line.
    """
    taken: set[str] = set()
    found = []
    for element in robot.ros2_control:
        info = _read_one(element, robot.joints)
        if info.name in taken:
            raise element.error(f"the name {info.name!r} is taken by other hardware")
        taken.add(info.name)
        found.append(info)
    return tuple(found)


def _read_one(element: Element, joints: Mapping[str, Joint]) -> HardwareInfo:
    kind = element.attribute("type")
    if kind not in HARDWARE_TYPES:
        raise element.error(f'attribute "type" should be one of {", ".join(HARDWARE_TYPES)}, got {kind!r}')
    hardware = element.require("hardware")
    plugin = hardware.text_of("plugin", "class_type")
    if not plugin:
        raise hardware.error("<plugin> is missing or empty")
    components = [_read_component(child, joints) for child in element.all("joint", "sensor", "gpio")]
    _reject_duplicates(element, components)
    info = HardwareInfo(
        name=element.name(),
        type=kind,
        plugin=plugin,
        parameters=_parameters(hardware),
        components=tuple(components),
        transmissions=tuple(_read_transmission(child) for child in element.all("transmission")),
        rw_rate=element.number_attribute("rw_rate", 0.0),
        is_async=_flag(element, "is_async", default=False),
        location=element.location,
    )
    if kind == "sensor" and info.command_names:
        raise element.error(f"hardware of type sensor takes no commands, got {info.command_names[0]!r}")
    return info


def _reject_duplicates(element: Element, components: Iterable[ComponentInfo]) -> None:
    seen: set[tuple[str, str]] = set()
    for component in components:
        for sort, names in (("command", component.command_names), ("state", component.state_names)):
            for name in names:
                if (sort, name) in seen:
                    raise element.error(f"the {sort} interface {name!r} is there twice")
                seen.add((sort, name))


def _read_component(element: Element, joints: Mapping[str, Joint]) -> ComponentInfo:
    name = element.name()
    joint = joints.get(name) if element.tag == "joint" else None
    if element.tag == "joint" and joints and joint is None:
        known = ", ".join(joints) or "none"
        raise element.error(f"the robot has no joint {name!r}; known are {known}")
    parameters = _parameters(element)
    limited = _limited(element)
    return ComponentInfo(
        name=name,
        type=element.tag,
        commands=tuple(_read_interface(child) for child in element.all("command_interface")),
        states=tuple(_read_interface(child) for child in element.all("state_interface")),
        parameters=parameters,
        limited=limited,
        mimic=_mimic(element, parameters, joint, joints),
        joint=joint,
    )


def _mimic(
    element: Element, parameters: Mapping[str, str], joint: Joint | None, joints: Mapping[str, Joint]
) -> Mimic | None:
    """Return the joint that a joint mimics: by old-style parameters, by ``mimic="true"`` or from the robot."""
    if "mimic" in parameters:
        leader = parameters["mimic"].strip()
        if joints and leader not in joints:
            raise element.error(f"it follows {leader!r}, which is not a joint of the robot")
        return Mimic(
            leader, _number(element, parameters, "multiplier", 1.0), _number(element, parameters, "offset", 0.0)
        )
    wanted = element.attributes.get("mimic")
    if wanted is None:
        return joint.mimic if joint else None
    if not _flag(element, "mimic", default=False):
        return None
    if joint is None or joint.mimic is None:
        raise element.error('mimic="true", but the robot\'s joint has no <mimic>')
    return joint.mimic


def _number(element: Element, parameters: Mapping[str, str], key: str, default: float) -> float:
    text = parameters.get(key)
    if text is None or not text.strip():
        return default
    try:
        value = float(text)
    except ValueError:
        raise element.error(f"parameter {key!r} should be a number, got {text.strip()!r}") from None
    if math.isnan(value):
        raise element.error(f"parameter {key!r} should be a number, got {text.strip()!r}")
    return value


def _read_interface(element: Element) -> InterfaceInfo:
    parameters = _parameters(element)
    lower = _number(element, parameters, "min", -math.inf)
    upper = _number(element, parameters, "max", math.inf)
    if lower > upper:
        raise element.error(f"its minimum {lower:g} is above its maximum {upper:g}")
    return InterfaceInfo(
        name=element.name(),
        lower=lower,
        upper=upper,
        initial_value=_initial(element, parameters),
        data_type=element.attribute("data_type", "double") or "double",
        limited=_limited(element),
        parameters=parameters,
    )


def _initial(element: Element, parameters: Mapping[str, str]) -> float:
    text = parameters.get("initial_value", "").strip().lower()
    if text in ("true", "false"):
        return float(text == "true")
    return _number(element, parameters, "initial_value", math.nan)


def _limited(element: Element) -> bool:
    limits = element.first("limits")
    return limits is None or _flag(limits, "enable", default=True)


def _read_transmission(element: Element) -> TransmissionInfo:
    def reductions(tag: str) -> dict[str, float]:
        return {child.name(): child.number_of("mechanical_reduction", default=1.0) for child in element.all(tag)}

    return TransmissionInfo(
        name=element.name(),
        plugin=element.text_of("plugin"),
        joints=reductions("joint"),
        actuators=reductions("actuator"),
    )


def _parameters(element: Element) -> Mapping[str, str]:
    return MappingProxyType({child.name(): child.text.strip() for child in element.all("param")})


def _flag(element: Element, key: str, default: bool) -> bool:
    word = element.attribute(key, str(default)).lower()
    if word in ("true", "1"):
        return True
    if word in ("false", "0"):
        return False
    raise element.error(f'attribute "{key}" should be true or false, got {word!r}')
