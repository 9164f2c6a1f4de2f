"""Process in which scenarios run: ``python -m daidalos.testing.server [pytest]``.

It replaces threads and clocks, imports what most scenarios need once, and then carries out requests from its standard
input, each in a fork of its own, so that every scenario begins alike. A request is a pickled `Request`, preceded by its
length; the answer is the exit status. Where processes cannot be forked it carries out one request and ends.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
import select
import struct
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

LENGTH = struct.Struct("!q")

_real_select = select.select

PRELOADED = (
    "numpy.random",
    "rclpy.executors",
    "rclpy.action",
    "rosidl_runtime_py.utilities",
    "tf2_ros",
    "launch_ros.actions",
    "daidalos.cli.ros2.program",
    "daidalos.nodes.gazebo_ros.gzserver",
    "daidalos.nodes.gazebo_ros._host",
    "daidalos.simulation.simulation",
    "daidalos.testing.worlds",
    "rosbag2_py",
)


@dataclass(frozen=True)
class Request:
    """Request to carry out one scenario.

    Parameters
    ----------
    target : str
        ``module:function`` that carries it out; it takes the scenario and the arguments.
    arguments : dict
        Of the function.
    seed : int
    timeout : float
        Simulated time [s] after which the scenario fails.
    folder : str
        Where its bag and its pictures are written.
    cwd : str
        Working folder.
    environ : dict of str
        Environment.
    path : tuple of str
        ``sys.path``.
    parameters : dict
        Values that a fleet of runs varies.
    record : bool
        Whether to record a bag.
    pictures : bool
        Whether the bag has images and point clouds as well.
    quiet : bool
        Whether the output goes to the file ``output.txt`` of the folder.
    """

    target: str
    arguments: dict[str, Any]
    seed: int
    timeout: float
    folder: str
    cwd: str
    environ: dict[str, str]
    path: tuple[str, ...]
    parameters: dict[str, Any] = field(default_factory=dict)
    record: bool = True
    pictures: bool = False
    quiet: bool = False


def main() -> None:
    """Carry out requests until the input ends."""
    answers = os.dup(1)
    os.dup2(2, 1)
    from daidalos.testing.programs import ScenarioRun

    run = ScenarioRun()
    _preload()
    while True:
        data = _read_request()
        if data is None:
            os._exit(0)
        if not hasattr(os, "fork"):
            status = _carry_out(run, data)
            os.write(answers, LENGTH.pack(status))
            os._exit(0)
        os.write(answers, LENGTH.pack(_fork(run, data)))


def _preload() -> None:
    from importlib import import_module
    from importlib.metadata import entry_points

    for name in PRELOADED:
        import_module(name)
    if "pytest" in sys.argv[1:]:
        import_module("pytest")
        for plugin in entry_points(group="pytest11"):
            with contextlib.suppress(Exception):  # which pytest reports
                plugin.load()


def _read_request() -> bytes | None:
    head = _read(LENGTH.size)
    return None if head is None else _read(LENGTH.unpack(head)[0])


def _read(size: int) -> bytes | None:
    data = b""
    while len(data) < size:
        part = os.read(0, size - len(data))
        if not part:
            return None
        data += part
    return data


def _fork(run: Any, data: bytes) -> int:
    """Carry out a request in a fork; end it when the input ends meanwhile, as whoever asked is gone."""
    ended, ending = os.pipe()
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    child = os.fork()
    if child == 0:
        os.close(ended)
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        status = _carry_out(run, data)
        from daidalos.common.temporary_files import delete_temporary_files

        delete_temporary_files()
        os._exit(status & 0xFF)
    os.close(ending)
    readable, _, _ = _real_select([0, ended], [], [])
    if ended not in readable:
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, 9)
    os.close(ended)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


def _carry_out(run: Any, data: bytes) -> int:
    """Carry out a request in this process; return its exit status."""
    from importlib import import_module

    from daidalos.lockstep.run import exit_status
    from daidalos.lockstep.scheduler import LockstepError
    from daidalos.lockstep.session import install

    request: Request = pickle.loads(data)
    os.environ.clear()
    os.environ.update(request.environ)
    sys.path[:] = request.path
    os.chdir(request.cwd)
    if request.quiet:
        _write_output_to(os.path.join(request.folder, "output.txt"))
    run.reseed(request.seed)
    install(run)
    module, _, name = request.target.partition(":")
    status = 1

    def body() -> int:
        function: Callable[..., int] = getattr(import_module(module), name)
        scenario = _scenario(run, program, request)
        try:
            return function(scenario, **request.arguments)
        finally:
            scenario.end()

    program = run.create(body, ["scenario"])
    program.on_exit.append(lambda _: run.scheduler.stop())
    program.start()
    try:
        run.go()
        status = exit_status(run, program)
    except LockstepError as error:
        sys.stderr.write(f"[lockstep] {error}\n")
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(ValueError, io.UnsupportedOperation):
            stream.flush()
    return status


def _write_output_to(path: str) -> None:
    output = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    for descriptor in (1, 2):
        os.dup2(output, descriptor)
    os.close(output)


def _scenario(run: Any, program: Any, request: Request) -> Scenario:
    from pathlib import Path

    from daidalos.testing.scenario import Scenario

    scenario = Scenario(run, program, request.timeout, Path(request.folder), request.parameters)
    if request.record:
        scenario.record(pictures=request.pictures)
    scenario.start_timeout()
    return scenario


if __name__ == "__main__":
    main()
