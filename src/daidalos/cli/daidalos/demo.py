"""`daidalos demo`: a mapping and navigating robot, in the browser or as a headless test."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos import lockstep
from daidalos.cli.daidalos.overlays import leave_overlays
from daidalos.common.errors import UserError
from daidalos.lockstep import options
from daidalos.workspaces.orphans import guard

if TYPE_CHECKING:
    from daidalos.lockstep.run import Run
    from daidalos.lockstep.session import Child
    from daidalos.nodes.daidalos_demo._measuring import Load, LoadRecorder
    from daidalos.nodes.daidalos_demo.trial import TrialReport

EPILOG = """It is nothing but `ros2 launch daidalos_demo demo.launch.py`; copy that file to begin a robot of
your own. With --headless the robot gets three goals all over the arena and its driving is measured: the exit
status is 0 only if it reached them all and touched nothing. With --lockstep the same seed gives the same drive,
bit for bit."""

_LAUNCH = ("daidalos_demo", "demo.launch.py")
_TRIAL_DOMAIN = 97
_PICTURES = "^/camera/"
"""Topics that the recording leaves out unless others are named: they would be gigabytes, and depend on the renderer."""
_END_S = 5.0


class DemoVerb:
    """A robot that maps an arena and drives where it is sent."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos demo`."""
        parser.epilog = EPILOG
        parser.add_argument("--headless", action="store_true", help="no browser: drive to goals and report")
        parser.add_argument("--seed", type=int, default=0, metavar="N", help="of all random numbers (default: 0)")
        parser.add_argument("--goals", type=int, default=3, metavar="N", help="how many, headless (default: 3)")
        parser.add_argument("--json", action="store_true", help="print the report as JSON, headless")
        parser.add_argument("--port", type=int, default=8765, metavar="N", help="of the studio (default: 8765)")
        parser.add_argument("--no-browser", action="store_true", help="print the studio's address, open nothing")
        options.add_arguments(parser, seed=False)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the demonstration."""
        options.check(args, seed=False)
        if args.lockstep and not args.headless:
            raise UserError("--lockstep needs --headless: a browser follows the real time")
        leave_overlays()
        if args.lockstep:
            return _restart_in_lockstep(args)
        return _try_out(args) if args.headless else _show(args)


def _show(arguments: argparse.Namespace) -> int:
    """Launch everything in the foreground."""
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    from daidalos.cli.daidalos.launching import run_launch
    from daidalos.cli.ros2.launch import find_launch_file

    settings = {
        "seed": str(arguments.seed),
        "port": str(arguments.port),
        "open_browser": str(not arguments.no_browser).lower(),
    }
    source = AnyLaunchDescriptionSource(str(find_launch_file(*_LAUNCH)))
    return run_launch(IncludeLaunchDescription(source, launch_arguments=list(settings.items())))


def _restart_in_lockstep(arguments: argparse.Namespace) -> int:
    """Run the same command in place of this process, with all that it launches, under the stepped clock."""
    from daidalos.lockstep.start import replace_process

    words = ["--headless", "--seed", str(arguments.seed), "--goals", str(arguments.goals)]
    command = ["daidalos", "demo", *words, *(["--json"] if arguments.json else [])]
    run = options.Options.of(arguments)
    return replace_process(command, run if run.exclude is not None else replace(run, exclude=_PICTURES))


def _try_out(arguments: argparse.Namespace) -> int:
    """Launch without the studio, run the test drive and report its results."""
    run = lockstep.current_run
    if run is None:
        # A domain of its own: the trial neither disturbs nor is disturbed by what runs beside it.
        os.environ.setdefault("ROS_DOMAIN_ID", str(_TRIAL_DOMAIN))
    handle, log = _log_file()
    launched = _launched(arguments.seed, handle) if run is None else _launched_in(run, arguments.seed, handle)
    try:
        with launched as process:
            load = _load_recorder(process)
            with _progress(arguments.json or run is not None) as say:
                report = _run_trial(arguments, say, process)
            used = load.stop() if load is not None else None
    except KeyboardInterrupt:
        log.unlink(missing_ok=True)
        raise
    if report is None:
        what = "the robot did not start" if run is None else "the run ended before the drive did"
        print(f"daidalos demo: {what}; see {log}", file=sys.stderr)
        print(_last_lines(log), file=sys.stderr)
        return 2
    log.unlink(missing_ok=True)
    if run is not None:
        simulated, real = run.elapsed_s
        report = replace(report, real_time_factor=simulated / real)
    _print_json(report, used) if arguments.json else _print_table(report, used)
    return 0 if report.passed else 1


def _load_recorder(process: subprocess.Popen[bytes] | Child) -> LoadRecorder | None:
    """Return a started recorder of what a child process costs; None for one in lock-step, which has none of its own."""
    if not isinstance(process, subprocess.Popen):
        return None
    from daidalos.nodes.daidalos_demo._measuring import LoadRecorder

    load = LoadRecorder(process.pid)
    load.start()
    return load


@contextlib.contextmanager
def _launched(seed: int, handle: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run the demo's launch file; its output goes to an open file."""
    command = [sys.executable, "-m", "daidalos.cli.ros2", *_launch_words(seed)]
    with os.fdopen(handle, "wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
    guard.watch(process.pid)
    try:
        yield process
    finally:
        _end(process)
        guard.release(process.pid)


@contextlib.contextmanager
def _launched_in(run: Run, seed: int, handle: int) -> Iterator[Child]:
    """Run the demo's launch file as a program of a lock-step run; its output goes to an open file."""
    from daidalos.lockstep.session import Child

    with os.fdopen(handle, "wb") as output:
        child = Child(run, ["ros2", *_launch_words(seed)], lambda fd, data: output.write(data))
        try:
            yield child
        finally:
            child.send_signal(signal.SIGINT)
            child.wait()


def _log_file() -> tuple[int, Path]:
    handle, name = tempfile.mkstemp(prefix="daidalos-demo-", suffix=".log")
    return handle, Path(name)


def _launch_words(seed: int) -> list[str]:
    return ["launch", *_LAUNCH, "studio:=false", "look_around:=false", f"seed:={seed}"]


def _end(process: subprocess.Popen[bytes]) -> None:
    """Stop the launch with all its processes, as Ctrl-C does."""
    previous = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(timeout=_END_S)
            except subprocess.TimeoutExpired:
                _kill(process)
    finally:
        signal.signal(signal.SIGINT, previous)


def _kill(process: subprocess.Popen[bytes]) -> None:
    import psutil

    children = psutil.Process(process.pid).children(recursive=True)
    process.kill()
    for child in children:
        with contextlib.suppress(psutil.Error):
            child.kill()
    process.wait()


def _run_trial(
    arguments: argparse.Namespace, say: Callable[[str], None], launch: subprocess.Popen[bytes] | Child
) -> TrialReport | None:
    """Return the report, None if the launch ended before."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.parameter import Parameter

    from daidalos.nodes.daidalos_demo.trial import Trial

    rclpy.init(args=[])
    overrides: list[Parameter[int]] = [
        Parameter("seed", value=arguments.seed),
        Parameter("goals", value=arguments.goals),
    ]
    node = Trial(say, parameter_overrides=overrides)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    task = executor.create_task(node.run)
    try:
        while not task.done() and launch.poll() is None:
            executor.spin_until_future_complete(task, timeout_sec=0.5)
            if not rclpy.ok():  # the interrupt that ended it reached code that could not pass it on
                raise KeyboardInterrupt
        return task.result() if task.done() else None
    finally:
        task.cancel()
        node.destroy_node()
        rclpy.try_shutdown()


@contextlib.contextmanager
def _progress(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Show the progress: on a terminal in one updated line, else line by line on standard error."""
    if quiet or not sys.stderr.isatty():
        yield lambda line: print(line, file=sys.stderr, flush=True)
        return
    from rich.console import Console

    console = Console(stderr=True)
    with console.status("starting") as status:

        def say(line: str) -> None:
            if line.startswith(" "):
                console.print(line)
            else:
                status.update(line)

        yield say


def _print_json(report: TrialReport, used: Load | None) -> None:
    summary: dict[str, Any] = asdict(report) | (asdict(used) if used else {}) | {"passed": report.passed}
    print(json.dumps(summary))


def _print_table(report: TrialReport, used: Load | None) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("goal", "reached", "off [cm]", "off [deg]", "time [s]", "path [m]")
    for goal in report.goals:
        x, y, yaw = goal.goal
        table.add_row(
            f"{x:.2f} {y:.2f} {yaw:.2f}",
            "[green]yes" if goal.reached else f"[red]{goal.reason}",
            f"{100 * goal.position_error_m:.1f}",
            f"{57.2958 * goal.yaw_error_rad:.1f}",
            f"{goal.time_s:.1f}",
            f"{goal.path_length_m:.2f}",
        )
    console = Console()
    console.print(table)
    console.print(f"contacts: {report.contacts}" + "".join(f"\n  {name}" for name in report.contact_names))
    if report.map is not None:
        shares = f"{report.map.walls_found:.1%} of the walls found, {report.map.walls_true:.1%} of the found are walls"
        console.print(f"map: {report.map.width} x {report.map.height} cells of {report.map.resolution_m:g} m, {shares}")
    console.print(
        f"localization: {1000 * report.localization_rmse_m:.0f} mm rms, "
        f"real-time factor {report.real_time_factor:.2f}"
        + (
            f", {used.cpu_percent:.0f} % of a core, {used.peak_rss_mb:.0f} MB in {used.processes} processes"
            if used
            else ""
        )
    )


def _last_lines(log: Path, count: int = 15) -> str:
    return "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-count:])
