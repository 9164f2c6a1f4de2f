"""`daidalos rapid`: programs of ABB robots."""

from __future__ import annotations

import argparse
import difflib
import json
import sys
from collections.abc import Iterator
from pathlib import Path

from daidalos.cli.daidalos.rapid_calibrate import add_calibrate
from daidalos.cli.daidalos.rapid_serve import add_serve_arguments, serve_program
from daidalos.cli.daidalos.rapid_target import add_target
from daidalos.common.errors import UserError


class RapidVerb:
    """Check, format, run, trace and write programs of ABB robots."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos rapid`."""
        commands = parser.add_subparsers(
            title="commands",
            required=True,
            metavar="check | format | run | serve | trace | write | draw | calibrate | server | debug",
        )
        check = commands.add_parser("check", help="find errors; exit status 0 without errors, else 2")
        check.add_argument("path", type=Path, help="a module, a program file (.pgf) or a folder")
        check.add_argument("--json", action="store_true", help="print a list of files with their errors")
        check.add_argument(
            "--io",
            type=Path,
            action="append",
            default=[],
            metavar="EIO.cfg",
            help="configuration that declares signals",
        )
        check.set_defaults(_command=_check)
        format_ = commands.add_parser("format", help="indent modules and put one instruction on a line")
        format_.add_argument("path", nargs="+", type=Path, help="a module, a program file (.pgf) or a folder")
        format_.add_argument("--check", action="store_true", help="write nothing; exit status 1 if a file would change")
        format_.add_argument("--diff", action="store_true", help="write nothing; print what would change")
        format_.set_defaults(_command=_format)

        run = commands.add_parser("run", help="run a program; exit status 0 at its end, 2 after an error")
        _add_program(run)
        run.add_argument("--fast", action="store_true", help="do not let real time pass with the robot's")
        run.add_argument("--save", action="store_true", help="write the values of persistents back into the modules")
        run.add_argument(
            "--robot",
            action="append",
            metavar="[TASK=]ARM",
            help="arm that moves, of all tasks or of one, such as irb120 (default: one without joints)",
        )
        run.add_argument("--sim", action="store_true", help="move the arm of `bringup.launch.py` in the simulator too")
        run.add_argument("--action", metavar="NAME", help="move a real arm by this FollowJointTrajectory action")
        add_target(run)
        run.set_defaults(_command=_run)

        serve = commands.add_parser("serve", help="run a program on a controller with ABB's Robot Web Services")
        _add_program(serve)
        add_serve_arguments(serve)
        serve.set_defaults(_command=_serve_program)

        trace = commands.add_parser("trace", help="run a program on an arm, and write a report of its motion")
        _add_program(trace)
        trace.add_argument("--robot", default="irb120", metavar="ARM", help="arm that moves (default: irb120)")
        trace.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.html", help="the report")
        trace.add_argument("--force", action="store_true", help="replace an existing report")
        trace.set_defaults(_command=_trace)

        write = commands.add_parser("write", help="write the program that draws a text with a pen")
        _add_text(write)
        write.add_argument("text", metavar="TEXT", help="one line")
        write.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.mod", help="the program")
        write.add_argument("--force", action="store_true", help="replace an existing file")
        write.add_argument(
            "--at",
            type=float,
            nargs=3,
            metavar=("X", "Y", "Z"),
            help="left end of the base line in the robot's base [mm] (default: in the middle before the robot)",
        )
        write.add_argument("--pen", type=float, default=120.0, metavar="MM", help="length of the pen (default: 120)")
        write.add_argument("--speed", type=float, default=100.0, metavar="MM/S", help="speed (default: 100)")
        write.set_defaults(_command=_write)

        draw = commands.add_parser("draw", help="run a program on an arm, and write what its pen draws as a picture")
        _add_program(draw)
        draw.add_argument("--robot", default="irb120", metavar="ARM", help="arm that moves (default: irb120)")
        draw.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.svg", help="the picture")
        draw.add_argument("--force", action="store_true", help="replace an existing picture")
        draw.add_argument("--sheet", metavar="NAME", help="work object of the sheet (default: the program's first)")
        draw.add_argument(
            "--sim", action="store_true", help="draw with the arm of `bringup.launch.py`, on a sheet there"
        )
        draw.add_argument("--text", metavar="TEXT", help="letters that the drawing is compared with")
        _add_text(draw)
        draw.set_defaults(_command=_draw)

        add_calibrate(commands)

        server = commands.add_parser("server", help="language server for editors, on standard input and output")
        server.set_defaults(_command=_serve)

        debug = commands.add_parser("debug", help="debug adapter for editors, on standard input and output")
        debug.set_defaults(_command=_debug)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        status: int = args._command(args)
        return status


def _add_program(parser: argparse.ArgumentParser) -> None:
    """Declare which program runs, and with what around it."""
    parser.add_argument("path", type=Path, help="a module, a program file (.pgf) or a folder")
    parser.add_argument(
        "--task",
        action="append",
        default=[],
        metavar="NAME",
        help="which program of a folder, such as T_ROB1; given several times, they run together",
    )
    parser.add_argument("--proc", default="main", metavar="NAME", help="procedure to run (default: main)")
    parser.add_argument(
        "--io", type=Path, action="append", default=[], metavar="EIO.cfg", help="configuration that declares signals"
    )
    parser.add_argument(
        "--signal", action="append", default=[], metavar="NAME=VALUE", help="value that a signal begins with"
    )
    parser.add_argument(
        "--home", type=Path, metavar="FOLDER", help="folder that HOME: stands for (default: that of the program)"
    )
    parser.add_argument(
        "--sensor",
        action="append",
        default=[],
        metavar="NAME=CONDITION",
        help="input that is 1 where the tool's position in the base is so, such as diTouch=z<120 [mm]",
    )
    parser.add_argument(
        "--external",
        action="append",
        default=[],
        metavar="AXIS",
        help="external axis of the arm, such as a=linear,0,4000,1000 or b=turn,-180,180,90: range and speed [mm, deg]",
    )
    parser.add_argument("--manual", action="store_true", help="manual mode: the tool is no faster than 250 mm/s")
    parser.add_argument("--max-time", type=float, metavar="S", help="end after so many seconds of robot time")


def _check(args: argparse.Namespace) -> int:
    from daidalos.industry.rapid.inspection import inspect, read_signals

    signals = [name for file in args.io for name in read_signals(file)]
    reports = inspect(args.path, signals)
    errors = sum(len(report.errors) for report in reports)
    warnings = sum(len(report.warnings) for report in reports)
    if args.json:
        print(json.dumps([report.as_json() for report in reports], indent=1))
    else:
        for report in reports:
            for problem in sorted((*report.errors, *report.warnings)):
                print(problem.text(report.file))
        print(
            f"{_count(len(reports), 'file')}, {_count(errors, 'error')}, {_count(warnings, 'warning')}", file=sys.stderr
        )
    return 2 if errors else 0


def _format(args: argparse.Namespace) -> int:
    from daidalos.industry.rapid.formatting import format_source
    from daidalos.industry.rapid.sources import find_programs, read_source, write_source

    changed = failed = 0
    paths = [file for path in args.path for program in find_programs(path) for file in program.files]
    for path in dict.fromkeys(paths):
        try:
            source = read_source(path)
            text = format_source(source)
        except UserError as error:
            print(f"error: {error}", file=sys.stderr)
            failed += 1
            continue
        if text == source.text:
            continue
        changed += 1
        if args.diff:
            sys.stdout.writelines(_diff(str(path), source.text, text))
        elif args.check:
            print(f"would format {path}")
        else:
            write_source(path, text, source.encoding)
            print(f"formatted {path}")
    return 2 if failed else int(changed > 0 and args.check)


def _run(args: argparse.Namespace) -> int:
    from daidalos.cli.daidalos.rapid_run import run_program

    return run_program(args)


def _serve_program(args: argparse.Namespace) -> int:
    return serve_program(args)


def _trace(args: argparse.Namespace) -> int:
    from daidalos.cli.daidalos.rapid_run import trace_program

    return trace_program(args)


def _add_text(parser: argparse.ArgumentParser) -> None:
    """Declare what letters look like."""
    parser.add_argument("--font", type=Path, metavar="FILE.ttf", help="font (default: a single-stroke alphabet)")
    parser.add_argument("--height", type=float, default=40.0, metavar="MM", help="height of capitals (default: 40)")


def _write(args: argparse.Namespace) -> int:
    from daidalos.cli.daidalos.rapid_letters import write_letters

    return write_letters(args)


def _draw(args: argparse.Namespace) -> int:
    from daidalos.cli.daidalos.rapid_letters import draw_program

    return draw_program(args)


def _serve(args: argparse.Namespace) -> int:
    from daidalos.industry.rapid.editing.server import serve

    serve()
    return 0


def _debug(args: argparse.Namespace) -> int:
    from daidalos.cli.daidalos.rapid_debug import debug_programs

    return debug_programs()


def _diff(name: str, before: str, after: str) -> Iterator[str]:
    old, new = (text.splitlines(keepends=True) for text in (before, after))
    for line in difflib.unified_diff(old, new, name, name):
        yield line if line.endswith("\n") else f"{line}\n"


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'' if number == 1 else 's'}"
