"""Work sequences: devices, steps, what they show and how they are confirmed, from YAML."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.documents import read_yaml
from daidalos.common.errors import Location, UserError
from daidalos.common.extensions import find
from daidalos.common.parameters import ParameterError, Parameters, parameters_from
from daidalos.common.pose3 import Vector
from daidalos.common.suggestions import hint
from daidalos.industry.assistance.device import POINT, SHOW, Content, Device, DeviceError
from daidalos.industry.assistance.extensions import DEVICES
from daidalos.industry.assistance.hand import HandParameters
from daidalos.industry.lighting.device import MqttParameters

_KEYS = ("point", "follow", "color", "text")
BUTTON, MQTT, TOPIC, AFTER, HAND = "button", "mqtt", "topic", "after", "hand"


@dataclass(frozen=True)
class Confirmation:
    """How a step ends.

    Attributes
    ----------
    kind : str
        `BUTTON`, `MQTT`, `TOPIC`, `AFTER` or `HAND`.
    name : str
        MQTT topic or ROS topic, or the hand's place in words.
    payload : str
        What the MQTT message must be; anything where empty.
    type_name : str
        Of the ROS topic's messages.
    seconds : float
        Time after which the step ends by itself [s].
    place : (x, y, z) or None
        Above which a hand is to be seen [m].
    """

    kind: str = BUTTON
    name: str = ""
    payload: str = ""
    type_name: str = "std_msgs/msg/Empty"
    seconds: float = 0.0
    place: Vector | None = None


@dataclass(frozen=True)
class Showing:
    """What one device shows in a step.

    Attributes
    ----------
    device : str
    content : Content
    place : (x, y, z) or None
        Where it points [m].
    follow : str
        ROS topic whose newest point it points at; none where empty.
    """

    device: str
    content: Content
    place: Vector | None = None
    follow: str = ""


@dataclass(frozen=True)
class Step:
    """Step of a sequence."""

    name: str
    showings: tuple[Showing, ...]
    confirmation: Confirmation


@dataclass(frozen=True)
class PlannedDevice:
    """Device of a file that is not open yet: its kind, class and parameters."""

    kind: str
    device_class: type[Device]
    parameters: Parameters


@dataclass(frozen=True)
class Sequence:
    """Work sequence of a file.

    Attributes
    ----------
    name : str
    devices : mapping of str to PlannedDevice
    steps : tuple of Step
    mqtt : MqttParameters or None
        None where the file names no broker.
    camera : HandParameters
        Depth camera that sees hands.
    world_frame : str
        Frame of `tf` in which places are.
    folder : Path
        What relative paths begin at.
    """

    name: str
    devices: Mapping[str, PlannedDevice]
    steps: tuple[Step, ...]
    mqtt: MqttParameters | None
    camera: HandParameters
    world_frame: str
    folder: Path

    def confirmations(self, kind: str) -> list[Confirmation]:
        """Return the different confirmations of a kind."""
        return list(dict.fromkeys(one.confirmation for one in self.steps if one.confirmation.kind == kind))

    def open_devices(self, stack: ExitStack) -> dict[str, Device]:
        """Open all devices, to be closed by a stack.

        Raises
        ------
        UserError, OSError
            When one cannot be opened.
        """
        found = {}
        for name, planned in self.devices.items():
            try:
                found[name] = planned.device_class(planned.parameters, self.folder)
            except UserError as error:
                raise UserError(f"device '{name}': {error}") from None
            stack.callback(found[name].close)
        return found


def read_sequence(path: Path) -> Sequence:
    """Return the sequence of a YAML file.

    Raises
    ------
    UserError
        Naming the file and the entry.
    OSError
        When the file cannot be opened.
    """
    source = str(path)
    content = _mapping(read_yaml(path), Location(source), ("name", "devices", "steps", "mqtt", "camera", "world_frame"))
    devices = {}
    for name, item in _mapping(content.get("devices") or {}, Location(source, None, "devices")).items():
        devices[name] = _device(item, Location(source, None, f"devices.{name}"))
    items = content.get("steps")
    if not isinstance(items, list) or not items:
        raise UserError("needs the list 'steps'", Location(source))
    steps = tuple(_step(one, devices, Location(source, None, f"steps[{index}]")) for index, one in enumerate(items))
    mqtt = None
    if "mqtt" in content:
        mqtt = _parameters(MqttParameters, content["mqtt"] or {}, Location(source, None, "mqtt"))
    if mqtt is None and any(one.confirmation.kind == MQTT for one in steps):
        mqtt = MqttParameters()
    camera = _parameters(HandParameters, content.get("camera") or {}, Location(source, None, "camera"))
    world_frame = content.get("world_frame", "world")
    if not isinstance(world_frame, str) or not world_frame:
        raise UserError("must be the name of a frame", Location(source, None, "world_frame"))
    return Sequence(
        str(content.get("name") or path.stem), devices, steps, mqtt, camera, world_frame, path.parent
    )  # fmt: skip


def read_showing(device: str, content: Any, skills: tuple[str, ...]) -> Showing:
    """Return what a device is asked to show: ``{point: [x, y, z], color: red, text: ...}``, or ``[x, y, z]`` alone.

    In place of ``point``, ``follow`` names a topic of points.

    Raises
    ------
    DeviceError
        When it is of another form, or the device has no such skill.
    """
    if isinstance(content, list):
        content = {"point": content}
    if not isinstance(content, dict):
        raise DeviceError("expected {point: [x, y, z], color: red, text: ...}")
    for key in content:
        if key not in _KEYS:
            raise DeviceError(f"'{key}' is unknown{hint(str(key), _KEYS)}")
    texts = {key: content.get(key, "") for key in ("color", "text")}
    for key, value in texts.items():
        if not isinstance(value, str) or len(value) > 1000:
            raise DeviceError(f"'{key}' must be a string of at most 1000 characters")
    place, follow = content.get("point"), content.get("follow", "")
    if not isinstance(follow, str) or (follow and place is not None):
        raise DeviceError("'follow' must be the name of a topic, and there is either 'point' or 'follow'")
    if place is None and not follow:
        return Showing(device, Content(**texts))
    if POINT not in skills:
        raise DeviceError(f"the device cannot point, only {SHOW}")
    return Showing(device, Content(**texts), None if place is None else _place("point", place), follow)


def _place(key: str, value: Any) -> Vector:
    is_point = isinstance(value, list) and len(value) == 3 and all(type(one) in (int, float) for one in value)
    if not is_point or not all(math.isfinite(one) and abs(one) < 1e6 for one in value):
        raise DeviceError(f"'{key}' must be [x, y, z] in metres, all of them finite numbers")
    x, y, z = (float(one) for one in value)
    return x, y, z


def _device(item: Any, place: Location) -> PlannedDevice:
    values = dict(_mapping(item, place))
    kind = values.pop("kind", None)
    if not isinstance(kind, str):
        raise UserError("needs a 'kind'", place)
    device_class = find(DEVICES, kind, asked_by=place)
    return PlannedDevice(kind, device_class, _parameters(device_class.Parameters, values, place))


def _step(item: Any, devices: Mapping[str, PlannedDevice], place: Location) -> Step:
    values = _mapping(item, place, ("name", "show", "confirm"))
    name = values.get("name")
    if not isinstance(name, str) or not name:
        raise UserError("needs a 'name'", place)
    showings = []
    for device, content in _mapping(values.get("show") or {}, place).items():
        if device not in devices:
            raise UserError(f"there is no device '{device}'{hint(device, devices)}", place)
        try:
            showings.append(read_showing(device, content, devices[device].device_class.skills))
        except DeviceError as error:
            raise UserError(f"'{device}': {error}", place) from None
    return Step(name, tuple(showings), _confirmation(values.get("confirm"), place))


def _confirmation(item: Any, place: Location) -> Confirmation:
    if item is None or item == BUTTON:
        return Confirmation()
    values = _mapping(item, place, (MQTT, "payload", TOPIC, "type", AFTER, HAND))
    kinds = [one for one in (MQTT, TOPIC, AFTER, HAND) if one in values]
    if len(kinds) != 1:
        raise UserError("'confirm' must be button, or have one of mqtt, topic, after and hand", place)
    value = values[kinds[0]]
    if kinds == [AFTER]:
        if type(value) not in (int, float) or not 0.0 <= value < 1e6:
            raise UserError(f"'after' must be a time in seconds, got {value!r}", place)
        return Confirmation(AFTER, seconds=float(value))
    if kinds == [HAND]:
        try:
            at = _place(HAND, value)
        except DeviceError as error:
            raise UserError(str(error), place) from None
        return Confirmation(HAND, "[{:g}, {:g}, {:g}]".format(*at), place=at)
    if not isinstance(value, str) or not value:
        raise UserError(f"'{kinds[0]}' must be the name of a topic", place)
    if kinds == [MQTT]:
        return Confirmation(MQTT, value, str(values.get("payload", "")))
    return Confirmation(TOPIC, value, type_name=str(values.get("type", Confirmation.type_name)))


def _mapping(item: Any, place: Location, keys: tuple[str, ...] = ()) -> Mapping[str, Any]:
    if not isinstance(item, dict) or not all(isinstance(key, str) for key in item):
        raise UserError("must be a mapping", place)
    for key in item:
        if keys and key not in keys:
            raise UserError(f"'{key}' is unknown{hint(key, keys)}", place)
    return item


def _parameters(kind: type[Any], values: Any, place: Location) -> Any:
    try:
        return parameters_from(kind, _mapping(values, place))
    except ParameterError as error:
        raise UserError(f"parameter '{error.name}' {error.problem}", place) from None
