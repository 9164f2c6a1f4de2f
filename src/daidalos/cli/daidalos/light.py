"""`daidalos light`: a moving head that points at places of a work cell."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.lighting.configuration import Configuration, OutputParameters
    from daidalos.industry.lighting.head import Head


class LightVerb:
    """Point a moving head at places of a work cell."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos light`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
        point = commands.add_parser("point", help="point at a place until Ctrl-C, then go dark")
        for axis in "XYZ":
            point.add_argument(axis.lower(), type=float, metavar=axis, help=f"{axis.lower()} in the world [m]")
        add_configuration(point)
        point.add_argument("--head", metavar="NAME", help="name of the head (default: the first)")
        point.add_argument("--color", metavar="COLOR", help="#rrggbb, or a name of the colour wheel")
        point.add_argument("--dimmer", type=float, metavar="SHARE", help="brightness from 0 to 1")
        point.add_argument("--duration", type=_seconds, metavar="S", help="end after this time instead of by Ctrl-C")
        point.set_defaults(_command=_point)
        demo = commands.add_parser("demo", help="a simulated head over a table, in the simulator and the studio")
        demo.add_argument("--port", type=_port, default=8765, metavar="N", help="of the studio (default: 8765)")
        demo.add_argument("--no-browser", action="store_true", help="print the studio's address, open nothing")
        demo.add_argument(
            "--artnet-port", type=_port, metavar="N", help="of the simulated head (default: 6454, or a free one)"
        )
        demo.set_defaults(_command=_demo)
        run = commands.add_parser("run", help="take points and channels over MQTT until Ctrl-C, then go dark")
        add_configuration(run)
        run.add_argument(
            "--broker", metavar="URL", help="mqtt://user:password@host:1883 or mqtts:// (default: embedded)"
        )
        run.add_argument("--port", type=_port, metavar="N", help="port of the embedded broker (default: 1883)")
        run.set_defaults(_command=_run)
        calibrate = commands.add_parser(
            "calibrate", help="find a head's pose by aiming at known points with the arrow keys"
        )
        add_configuration(calibrate)
        calibrate.add_argument("--head", metavar="NAME", help="name of the head (default: the first)")
        places = calibrate.add_mutually_exclusive_group()
        places.add_argument(
            "--points", type=Path, metavar="FILE", help="YAML file with a list of known points [x, y, z]"
        )
        places.add_argument(
            "--table", type=float, nargs=5, default=(-1.0, -0.75, 1.0, 0.75, 0.0),
            metavar=("X0", "Y0", "X1", "Y1", "Z"),
            help="corners of a table, which are the points, and its height [m] (default: -1 -0.75 1 0.75 0)",
        )  # fmt: skip
        calibrate.add_argument(
            "-o", "--output", type=Path, default=Path("calibration.yaml"), metavar="FILE",
            help="result (default: calibration.yaml); FILE.session keeps what is confirmed, and is resumed",
        )  # fmt: skip
        calibrate.set_defaults(_command=_calibrate)
        flow = commands.add_parser("flow", help="print a flow of Node-RED that drives a head, to be imported there")
        flow.add_argument("name", choices=("mqtt", "artnet"), help="over MQTT, or by Art-Net without Daidalos")
        flow.set_defaults(_command=_print_flow)
        fixture = commands.add_parser("fixture", help="print the channels of a fixture file")
        fixture.add_argument("file", help="built-in fixture, or a file in YAML or of the Open Fixture Library in JSON")
        fixture.add_argument("--mode", default="", help="mode of the fixture (default: the first)")
        fixture.set_defaults(_command=_print_fixture)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        try:
            status: int = args._command(args)
        except OSError as error:
            raise UserError(f"{error.filename}: {error.strerror}" if error.filename else str(error)) from None
        return status


def add_configuration(parser: argparse.ArgumentParser) -> None:
    """Declare the options that choose heads and outputs."""
    parser.add_argument(
        "--config", type=Path, metavar="FILE", help="heads and outputs (default: one head, Art-Net here)"
    )
    parser.add_argument("--artnet", metavar="HOST", help="send Art-Net to this address, in place of the file's outputs")
    parser.add_argument("--sacn", metavar="HOST", help="send sACN to this address or 'multicast', likewise")


def configuration(args: argparse.Namespace) -> Configuration:
    """Return the configuration that the options choose."""
    from dataclasses import replace

    from daidalos.industry.lighting.configuration import DEFAULT, ArtNetParameters, SacnParameters, read_configuration

    found = read_configuration(args.config or DEFAULT)
    outputs: list[OutputParameters] = [ArtNetParameters(host=args.artnet)] if args.artnet else []
    outputs += [SacnParameters(host=args.sacn)] if args.sacn else []
    return replace(found, outputs=tuple(outputs)) if outputs else found


def _point(args: argparse.Namespace) -> int:
    """Point at a place until the end."""
    from daidalos.cli.daidalos.ending import Ending
    from daidalos.industry.lighting.engine import Engine
    from daidalos.industry.lighting.kinematics import PointingError
    from daidalos.industry.lighting.show import Show

    chosen = configuration(args)
    show = Show(chosen.make_heads())
    head = show.head(args.head or chosen.heads[0].name)
    _set_look(head, args)
    try:
        angles = head.point((args.x, args.y, args.z))
    except PointingError as error:
        raise UserError(str(error)) from None
    print(
        f"{head.name}: pan {math.degrees(angles.pan):.3f} deg, tilt {math.degrees(angles.tilt):.3f} deg, "
        f"universe {head.universe}, channels {head.first} to {head.last}",
        flush=True,
    )
    with Ending() as ending, Engine(show, chosen.make_outputs(), report):
        ending.wait(args.duration)
    return 0


def _set_look(head: Head, args: argparse.Namespace) -> None:
    from dataclasses import replace

    from daidalos.industry.lighting.look import parse_color

    look = head.look
    if args.color is not None:
        look = replace(look, color=parse_color(args.color))
    if args.dimmer is not None:
        look = replace(look, dimmer=args.dimmer)
    head.show(look)


def _run(args: argparse.Namespace) -> int:
    """Serve all heads over MQTT until the end."""
    from dataclasses import replace

    from daidalos.cli.daidalos.ending import Ending
    from daidalos.industry.lighting.engine import Engine
    from daidalos.industry.lighting.mqtt_service import MqttService
    from daidalos.industry.lighting.show import Show

    chosen = configuration(args)
    mqtt = chosen.mqtt
    if args.broker is not None:
        mqtt = replace(mqtt, broker=args.broker)
    if args.port is not None:
        mqtt = replace(mqtt, port=args.port)
    show = Show(chosen.make_heads())
    with (
        Ending() as ending,
        Engine(show, chosen.make_outputs(), report) as engine,
        MqttService(engine, list(show.heads), mqtt, report) as service,
    ):
        print(f"broker {service.url}", flush=True)
        for name in show.heads:
            print(f"{name}/point expects [x, y, z], {name}/dashboard the values of channels", flush=True)
        ending.wait()
    return 0


def _demo(args: argparse.Namespace) -> int:
    """Launch the simulated head in the foreground."""
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from daidalos.cli.daidalos.launching import run_launch
    from daidalos.cli.daidalos.overlays import leave_overlays
    from daidalos.cli.ros2.launch import find_launch_file

    leave_overlays()
    source = AnyLaunchDescriptionSource(str(find_launch_file("daidalos_lighting", "demo.launch.py")))
    port = args.artnet_port or _artnet_port()
    settings = {"port": str(args.port), "open_browser": str(not args.no_browser).lower(), "artnet_port": str(port)}
    return run_launch(IncludeLaunchDescription(source, launch_arguments=list(settings.items())))


def _artnet_port() -> int:
    """Return the port of Art-Net, or a free one where another program receives there."""
    import socket

    from daidalos.industry.lighting.artnet import PORT

    for port in (PORT, 0):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            found = int(probe.getsockname()[1])
            if found != PORT:
                report(f"another program receives Art-Net at port {PORT}; the simulated head has port {found}")
            return found
    raise UserError("there is no free UDP port")


def _calibrate(args: argparse.Namespace) -> int:
    """Calibrate a head at the terminal."""
    from daidalos.cli.daidalos.light_calibration import calibrate

    return calibrate(args, configuration(args), report)


def _print_flow(args: argparse.Namespace) -> int:
    """Print a flow of Node-RED."""
    from daidalos.interfaces.library import BUILT_IN

    path = BUILT_IN / "daidalos_lighting" / "node_red" / f"{args.name}.json"
    print(path.read_text(encoding="utf-8"), end="")
    return 0


def _print_fixture(args: argparse.Namespace) -> int:
    """Print the channels of a fixture."""
    from daidalos.industry.lighting.fixture import ANGLES
    from daidalos.industry.lighting.fixture_file import read_fixture

    fixture = read_fixture(args.file, args.mode)
    print(f"{fixture.name}, mode {fixture.mode}, {fixture.size} channels")
    for channel in fixture.channels:
        numbers = ", ".join(str(offset + 1) for offset in channel.offsets)
        print(f"{numbers:>7}  {channel.name}")
        for one in channel.ranges:
            scale = 180 / math.pi if one.function in ANGLES else 1.0
            meaning = one.name or f"{scale * one.start:g} to {scale * one.end:g}"
            print(f"{'':9}{one.first:>5} to {one.last:<5}  {one.function}: {meaning}")
    return 0


def _seconds(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError("must be above 0")
    return value


def _port(text: str) -> int:
    value = int(text)
    if not 1 <= value <= 65535:
        raise argparse.ArgumentTypeError("must be from 1 to 65535")
    return value


def report(line: str) -> None:
    """Print a line on standard error."""
    import sys

    print(line, file=sys.stderr, flush=True)
