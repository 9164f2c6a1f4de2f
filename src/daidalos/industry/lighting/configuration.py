"""Configuration file of heads and outputs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from daidalos.common.documents import read_yaml
from daidalos.common.errors import Location, UserError
from daidalos.common.parameters import ParameterError, Parameters, parameter, parameters_from
from daidalos.common.pose3 import Pose
from daidalos.common.suggestions import hint
from daidalos.industry.lighting import artnet, sacn
from daidalos.industry.lighting.device import MqttParameters
from daidalos.industry.lighting.fixture_file import read_fixture
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.kinematics import Geometry
from daidalos.industry.lighting.look import Look, parse_color
from daidalos.industry.lighting.outputs import ArtNetOutput, Output, SacnOutput, UsbOutput

DEFAULT = Path(__file__).parents[2] / "share" / "daidalos_lighting" / "config" / "head.yaml"
P = TypeVar("P", bound=Parameters)
_KEYS = ("heads", "outputs", "mqtt")


@dataclass(frozen=True)
class HeadParameters(Parameters):
    """Parameters of one head."""

    name: str = parameter("Moving-head", "Name, also the first part of its MQTT topics.", not_empty=True)
    fixture: str = parameter("zema_13_channel", "Built-in fixture, or path of a fixture file.", not_empty=True)
    mode: str = parameter("", "Mode of the fixture; the first where empty.")
    universe: int = parameter(1, "DMX universe as it is sent.", minimum=0, maximum=sacn.MAX_UNIVERSE)
    address: int = parameter(1, "First DMX channel.", minimum=1, maximum=512)
    position: tuple[float, ...] = parameter((0.0, 0.0, 2.8), "Where the axes meet, in the world.", unit="m", length=3)
    rpy: tuple[float, ...] = parameter(
        (3.141592653589793, 0.0, 0.0), "Roll, pitch and yaw of the base; z is the pan axis, down where the head hangs.",
        unit="rad", length=3,
    )  # fmt: skip
    tilt_zero: float = parameter(0.0, "True tilt where the tilt reads 0.", unit="rad", minimum=-0.5, maximum=0.5)
    axis_skew: float = parameter(
        0.0, "Angle by which the tilt axis is not square to pan's.", unit="rad", minimum=-0.2, maximum=0.2
    )
    beam_skew: float = parameter(
        0.0, "Angle by which the beam is not square to the tilt axis.", unit="rad", minimum=-0.2, maximum=0.2
    )
    invert_pan: bool = parameter(False, "Whether greater values turn clockwise about the pan axis.")
    invert_tilt: bool = parameter(False, "Whether greater values tilt the other way.")
    movement: str = parameter(
        "smooth", "Profile of limited speed and acceleration, or only the ends of movements.",
        choices=("smooth", "direct"),
    )  # fmt: skip
    dimmer: float = parameter(1.0, "Share of the full brightness.", minimum=0.0, maximum=1.0)
    color: str = parameter("#ffffff", "Colour as #rrggbb, or a name of the colour wheel.")
    calibration: str = parameter(
        "", "File of `daidalos light calibrate`, whose pose and angles are taken; none where empty."
    )


@dataclass(frozen=True)
class ArtNetParameters(Parameters):
    """Parameters of an Art-Net output."""

    protocol: str = parameter("artnet", "Kind of output.", choices=("artnet",))
    host: str = parameter("127.0.0.1", "Address of the receiver, or the broadcast address of its network.")
    port: int = parameter(artnet.PORT, "UDP port.", minimum=1, maximum=65535)
    universes: tuple[int, ...] = parameter((), "Universes; all where empty.", minimum=0, maximum=artnet.MAX_UNIVERSE)
    answer_polls: bool = parameter(True, "Whether ArtPoll is answered, unless the receiver is on this machine.")


@dataclass(frozen=True)
class SacnParameters(Parameters):
    """Parameters of an sACN output."""

    protocol: str = parameter("sacn", "Kind of output.", choices=("sacn",))
    host: str = parameter("127.0.0.1", "Address of the receiver, or multicast.")
    port: int = parameter(sacn.PORT, "UDP port.", minimum=1, maximum=65535)
    universes: tuple[int, ...] = parameter(
        (), "Universes; all where empty.", minimum=sacn.MIN_UNIVERSE, maximum=sacn.MAX_UNIVERSE
    )
    priority: int = parameter(100, "Priority beside other senders.", minimum=0, maximum=200)


@dataclass(frozen=True)
class UsbParameters(Parameters):
    """Parameters of a USB widget."""

    protocol: str = parameter("enttec", "Kind of output.", choices=("enttec",))
    device: str = parameter("/dev/ttyUSB0", "Serial port.", not_empty=True)
    universe: int = parameter(1, "Universe.", minimum=0, maximum=sacn.MAX_UNIVERSE)


OutputParameters = ArtNetParameters | SacnParameters | UsbParameters
_OUTPUTS: dict[str, type[Any]] = {"artnet": ArtNetParameters, "sacn": SacnParameters, "enttec": UsbParameters}


@dataclass(frozen=True)
class Configuration:
    """Heads, outputs and broker of a file.

    Attributes
    ----------
    heads : tuple of HeadParameters
    outputs : tuple of OutputParameters
    mqtt : MqttParameters
    folder : Path
        What relative paths begin at.
    source : str
        The file.
    """

    heads: tuple[HeadParameters, ...]
    outputs: tuple[OutputParameters, ...]
    mqtt: MqttParameters = field(default_factory=MqttParameters)
    folder: Path = field(default_factory=Path)
    source: str = ""

    def make_heads(self) -> list[Head]:
        """Return the heads.

        Raises
        ------
        UserError, OSError
            When a fixture cannot be read or does not fit.
        """
        return [make_head(one, self.folder) for one in self.heads]

    def make_outputs(self) -> list[Output]:
        """Open the outputs.

        Raises
        ------
        UserError, OSError
            When one cannot be opened, or a universe does not exist in its protocol.
        """
        for one in self.outputs:
            self._refuse_universes(one)
        return [make_output(one) for one in self.outputs]

    def with_artnet_port(self, port: int) -> Configuration:
        """Return the configuration with another port of its Art-Net outputs; with the same one where it is 0.

        Raises
        ------
        ParameterError
            When there is no such port.
        """
        if not port:
            return self
        outputs = tuple(replace(one, port=port) if isinstance(one, ArtNetParameters) else one for one in self.outputs)
        return replace(self, outputs=outputs)

    def _refuse_universes(self, output: OutputParameters) -> None:
        least, most = (1, sacn.MAX_UNIVERSE) if isinstance(output, SacnParameters) else (0, artnet.MAX_UNIVERSE)
        if isinstance(output, UsbParameters) or output.universes:
            return
        for head in self.heads:
            if not least <= head.universe <= most:
                raise UserError(
                    f"{self.source}: head '{head.name}': universe {head.universe} does not exist in {output.protocol}, "
                    f"which has {least} to {most}"
                )


def read_configuration(path: Path) -> Configuration:
    """Return the configuration of a YAML file with the lists ``heads`` and ``outputs``, and the mapping ``mqtt``.

    Raises
    ------
    UserError
        Naming the file and the entry.
    OSError
        When the file cannot be opened.
    """
    content = read_yaml(path)
    source = str(path)
    if not isinstance(content, dict):
        raise UserError("must be a mapping with the lists 'heads' and 'outputs'", Location(source))
    for key in content:
        if key not in _KEYS:
            raise UserError(f"'{key}' is unknown{hint(str(key), ('heads', 'outputs', 'mqtt'))}", Location(source))
    heads = tuple(_read(HeadParameters, one, place) for one, place in _items(content, "heads", source))
    if not heads:
        raise UserError("'heads' is empty", Location(source))
    outputs = tuple(_read_output(one, place) for one, place in _items(content, "outputs", source))
    mqtt = _read(MqttParameters, content.get("mqtt") or {}, Location(source, None, "mqtt"))
    return Configuration(heads, outputs, mqtt, path.parent, source)


def make_head(parameters: HeadParameters, folder: Path) -> Head:
    """Return the head of its parameters.

    Raises
    ------
    UserError, OSError
        When its fixture cannot be read or does not fit.
    """
    return Head(
        parameters.name,
        read_fixture(parameters.fixture, parameters.mode, folder),
        _geometry(parameters, folder),
        parameters.universe,
        parameters.address,
        Look(parameters.dimmer, parse_color(parameters.color)),
        parameters.invert_pan,
        parameters.invert_tilt,
        parameters.movement == "smooth",
    )


def make_output(parameters: OutputParameters) -> Output:
    """Open an output.

    Raises
    ------
    UserError, OSError
        When it cannot be opened.
    """
    if isinstance(parameters, UsbParameters):
        return UsbOutput(parameters.device, parameters.universe)
    universes = parameters.universes or None
    if isinstance(parameters, SacnParameters):
        return SacnOutput(parameters.host, parameters.port, universes, parameters.priority)
    is_here = parameters.host == "localhost" or parameters.host.startswith("127.")
    reply_port = artnet.PORT if parameters.answer_polls and not is_here else None
    return ArtNetOutput(parameters.host, parameters.port, universes, reply_port)


def _geometry(parameters: HeadParameters, folder: Path) -> Geometry:
    if parameters.calibration:
        from daidalos.industry.lighting.calibration_file import read_geometry

        return read_geometry(folder / parameters.calibration)
    x, y, z = parameters.position
    pose = Pose.from_xyz_rpy((x, y, z), parameters.rpy)
    return Geometry(pose, parameters.tilt_zero, parameters.axis_skew, parameters.beam_skew)


def _items(content: Mapping[str, Any], key: str, source: str) -> Iterable[tuple[Any, Location]]:
    items = content.get(key) or []
    if not isinstance(items, list):
        raise UserError(f"'{key}' must be a list", Location(source))
    return [(one, Location(source, None, f"{key}[{index}]")) for index, one in enumerate(items)]


def _read_output(item: Any, place: Location) -> OutputParameters:
    protocol = item.get("protocol") if isinstance(item, dict) else None
    if protocol not in _OUTPUTS:
        raise UserError(f"'{protocol}' is no protocol{hint(str(protocol), _OUTPUTS)}", place)
    found: OutputParameters = _read(_OUTPUTS[protocol], item, place)
    return found


def _read(kind: type[P], item: Any, place: Location) -> P:
    if not isinstance(item, dict) or not all(isinstance(key, str) for key in item):
        raise UserError("must be a mapping", place)
    try:
        return parameters_from(kind, item)
    except ParameterError as error:
        raise UserError(f"parameter '{error.name}' {error.problem}", place) from None
