"""`daidalos assist`: lights and projectors that lead a worker through a sequence."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.cli.daidalos.assist_calibration import add_calibration
from daidalos.cli.daidalos.assist_calibration import calibrate as calibrate_projector
from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.industry.assistance.runner import Runner
    from daidalos.industry.assistance.sequence import Sequence, Step


class AssistVerb:
    """Lead a worker through a sequence with lights and projectors."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos assist`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
        run = commands.add_parser("run", help="lead through a work sequence; Enter confirms, q and Enter end it")
        run.add_argument("sequence", type=Path, metavar="SEQUENCE", help="YAML file with devices and steps")
        run.add_argument("--times", type=Path, metavar="FILE", help="write the times of the steps as CSV")
        run.add_argument("--broker", metavar="URL", help="announce the devices at mqtt://user:password@host:1883")
        run.set_defaults(_command=_run)
        check = commands.add_parser("check", help="check a work sequence without its devices")
        check.add_argument("sequence", type=Path, metavar="SEQUENCE", help="YAML file with devices and steps")
        check.set_defaults(_command=_check)
        calibrate = commands.add_parser(
            "calibrate", help="find the homography of a video projector by clicks on known points, or by a camera"
        )
        add_calibration(calibrate)
        calibrate.set_defaults(_command=calibrate_projector)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        try:
            status: int = args._command(args)
        except OSError as error:
            raise UserError(f"{error.filename}: {error.strerror}" if error.filename else str(error)) from None
        return status


def _check(args: argparse.Namespace) -> int:
    """Print what a sequence has."""
    from daidalos.industry.assistance.sequence import read_sequence

    sequence = read_sequence(args.sequence)
    for name, planned in sequence.devices.items():
        print(f"{name}: {planned.kind}")
    for number, step in enumerate(sequence.steps, 1):
        print(_line(number, len(sequence.steps), step))
    return 0


def _run(args: argparse.Namespace) -> int:
    """Lead through a sequence; return 0 when all its steps were confirmed."""
    from dataclasses import replace

    from daidalos.industry.assistance.broker import AssistBroker
    from daidalos.industry.assistance.runner import Runner, write_times
    from daidalos.industry.assistance.sequence import MQTT, read_sequence
    from daidalos.industry.lighting.device import MqttParameters

    sequence = read_sequence(args.sequence)
    if args.times is not None and args.times.exists():
        raise UserError(f"{args.times} exists; name another file for the times")
    if args.broker is not None:
        sequence = replace(sequence, mqtt=replace(sequence.mqtt or MqttParameters(), broker=args.broker))
    with ExitStack() as stack:
        devices = sequence.open_devices(stack)
        for name, device in devices.items():
            if device.url:
                print(f"{name}: fill the projector's screen with {device.url}", flush=True)
        announced: list[Callable[[int, Step | None], None]] = [_print_step(sequence)]

        def announce(number: int, step: Step | None) -> None:
            for one in announced:
                one(number, step)

        runner = Runner(sequence, devices, time.monotonic, announce, _report)
        signal.signal(signal.SIGTERM, lambda *_: runner.abort())
        if sequence.mqtt is not None:
            topics = [one.confirmation.name for one in sequence.steps if one.confirmation.kind == MQTT]
            broker = stack.enter_context(AssistBroker(sequence.mqtt, devices, topics, runner.confirm, _report))
            announced.append(lambda number, step: broker.announce(number, len(sequence.steps), step))
            print(f"broker {broker.url}", flush=True)
        stack.enter_context(_topics(sequence, runner))
        threading.Thread(target=_read_keys, args=(runner,), name="keys", daemon=True).start()
        times = runner.run()
    for one in times:
        print(f"{one.seconds:8.1f} s  {one.name}")
    if args.times is not None:
        write_times(args.times, times)
    return 0 if len(times) == len(sequence.steps) else 1


def _print_step(sequence: Sequence) -> Callable[[int, Step | None], None]:
    def announce(number: int, step: Step | None) -> None:
        if step is not None:
            print(_line(number, len(sequence.steps), step), flush=True)

    return announce


def _line(number: int, count: int, step: Step) -> str:
    from daidalos.industry.assistance.sequence import AFTER, BUTTON

    confirmation = step.confirmation
    how = {BUTTON: "Enter", AFTER: f"after {confirmation.seconds:g} s"}.get(
        confirmation.kind, f"{confirmation.kind} {confirmation.name}"
    )
    return f"{number} of {count}: {step.name} [{how}]"


def _read_keys(runner: Runner) -> None:
    """Confirm by each line of standard input; q aborts, and so does the end of it."""
    from daidalos.industry.assistance.sequence import Confirmation

    for line in sys.stdin:
        if line.strip() == "q":
            break
        runner.confirm(Confirmation())
    else:
        return  # other confirmations may still come
    runner.abort()


@contextmanager
def _topics(sequence: Sequence, runner: Runner) -> Iterator[None]:
    """Pass on what comes from ROS topics meanwhile."""
    from daidalos.nodes.sequence_inputs import SequenceInputs, is_needed

    if not is_needed(sequence):
        yield
        return
    import rclpy
    from rclpy.executors import ExternalShutdownException

    rclpy.init(args=[])
    node = SequenceInputs(sequence, runner, _report)

    def spin() -> None:
        try:
            rclpy.spin(node)
        except ExternalShutdownException:
            return

    thread = threading.Thread(target=spin, name="topics", daemon=True)
    thread.start()
    try:
        yield
    finally:
        rclpy.try_shutdown()
        thread.join()
        node.destroy_node()


def _report(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
