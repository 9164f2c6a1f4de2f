"""Runs of a fleet on a cluster of Ray, whose machines see the same folders."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError
from daidalos.testing.journal import Record
from daidalos.testing.plan import Run
from daidalos.testing.processes import ScenarioProcess
from daidalos.testing.single import run_one

MAX_TRIES = 3
"""How often a run is begun whose worker is lost."""

CONNECT_TIMEOUT_S = 10.0

_PASSED_ON = ("AMENT_", "CMAKE_PREFIX_PATH", "COLCON_", "GAZEBO_", "GZ_", "PYTHONPATH", "RMW_", "ROS_")


class ClusterWorker:
    """Process of the scenarios on a machine of the cluster.

    Parameters
    ----------
    scenario, results : Path
        The scenario's file and the folder of the results, absolute.
    folder : str
        Working folder.
    environ : mapping of str
        Variables of the environment that the workspace of whoever asked needs.
    """

    def __init__(self, scenario: Path, results: Path, folder: str, environ: Mapping[str, str]) -> None:
        os.environ.update(environ)
        os.chdir(folder)
        added = environ.get("PYTHONPATH", "").split(os.pathsep)
        sys.path[:0] = [entry for entry in added if entry and entry not in sys.path]
        self._scenario, self._results = scenario, results
        self._process = ScenarioProcess()

    def run(self, run: Run) -> Record:
        """Carry out a run."""
        return run_one(self._process, self._scenario, run, self._results)


def run_on_cluster(
    scenario: Path, runs: Sequence[Run], results: Path, address: str, processes: int | None
) -> Iterator[Record]:
    """Yield the results of runs on a cluster as they come.

    Parameters
    ----------
    scenario : Path
    runs : sequence of Run
    results : Path
        Folder of the results, which gets the pictures of failures.
    address : str
        Of the cluster; ``auto`` for the one that runs on this machine, ``local`` to start one here.
    processes : int, optional
        How many run at the same time; by default one a processor of the cluster.

    Raises
    ------
    UserError
        When Ray is not installed, there is no such cluster, or it cannot carry out a run.
    """
    if find_spec("ray") is None:
        raise UserError("a cluster needs Ray: pip install 'daidalos[cluster]'")
    ray = _connected(address, processes)
    try:
        count = min(len(runs), processes or max(1, int(ray.cluster_resources().get("CPU", 1))))
        environ = {name: value for name, value in os.environ.items() if name.startswith(_PASSED_ON)}
        arguments = (scenario.resolve(), results.resolve(), os.getcwd(), environ)
        remote = ray.remote(num_cpus=1)(ClusterWorker)
        yield from _carry_out(ray, lambda: remote.remote(*arguments), runs, count)
    finally:
        ray.shutdown()


def _connected(address: str, processes: int | None) -> Any:
    """Return Ray, connected to a cluster."""
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")  # else it warns of its future
    import ray

    options: dict[str, Any] = {"address": address, "logging_level": "ERROR", "log_to_driver": False}
    if address == "local":
        options |= {"include_dashboard": False, "num_cpus": processes}
    host, _, port = address.rpartition("://")[2].rpartition(":")
    try:
        if host and port.isdigit():  # Ray itself waits for minutes
            socket.create_connection((host, int(port)), CONNECT_TIMEOUT_S).close()
        ray.init(**options)
    except (ConnectionError, ValueError, RuntimeError, OSError) as error:
        reason = str(error).strip().split("\n")[0]
        raise UserError(f"there is no cluster of Ray at '{address}' that can be used: {reason}") from error
    return ray


def _carry_out(ray: Any, make_worker: Callable[[], Any], runs: Sequence[Run], count: int) -> Iterator[Record]:
    """Yield the results of runs that `count` workers carry out; a run whose worker is lost is begun again."""
    waiting = list(reversed(runs))
    workers = [make_worker() for _ in range(count)]
    busy: dict[Any, tuple[Any, Run]] = {}
    tries: dict[int, int] = {}
    while waiting or busy:
        while workers and waiting:
            worker, run = workers.pop(), waiting.pop()
            tries[run.number] = tries.get(run.number, 0) + 1
            busy[worker.run.remote(run)] = worker, run
        for reference in ray.wait(list(busy), num_returns=1)[0]:
            worker, run = busy.pop(reference)
            try:
                record = ray.get(reference)
            except ray.exceptions.RayTaskError as error:
                raise UserError(f"a machine of the cluster cannot carry out run {run.number}: {error.cause}") from error
            except ray.exceptions.RayError as error:
                if tries[run.number] == MAX_TRIES:
                    raise UserError(
                        f"the cluster has lost run {run.number} {MAX_TRIES} times: {str(error).splitlines()[0]}"
                    ) from error
                with contextlib.suppress(ray.exceptions.RayError):
                    ray.kill(worker)
                workers.append(make_worker())
                waiting.append(run)
                continue
            workers.append(worker)
            yield record
