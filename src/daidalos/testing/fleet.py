"""Fleets: all runs of a plan, on the processors of this machine or on a cluster."""

from __future__ import annotations

import os
import queue
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError
from daidalos.testing.documents import read_scenario
from daidalos.testing.journal import Journal, Record
from daidalos.testing.plan import Plan, Run
from daidalos.testing.processes import ScenarioProcess
from daidalos.testing.single import run_once

PICTURES = "failures"


def run_fleet(
    plan: Plan, journal: Journal, processes: int, on_result: Callable[[Record], None], ray: str | None = None
) -> None:
    """Carry out the runs of a plan that the journal does not have yet.

    Parameters
    ----------
    plan : Plan
    journal : Journal
        Gets the results.
    processes : int
        How many run at the same time on this machine.
    on_result : callable
        Called with each result.
    ray : str, optional
        Address of a cluster of Ray, on which they run instead; ``local`` starts one here.

    Raises
    ------
    UserError
        When the scenario is not valid, or Ray is not there.
    """
    first = plan.runs()[0] if plan.count else None
    read_scenario(plan.scenario, None if first is None else first.parameters)  # a fault is better told at once
    missing = [run for run in plan.runs() if run.number not in journal.records]
    results = _on_cluster(plan, missing, journal, ray) if ray is not None else _here(plan, missing, journal, processes)
    for record in results:
        journal.add(record)
        on_result(record)


def _here(plan: Plan, runs: Sequence[Run], journal: Journal, count: int) -> Iterator[Record]:
    """Yield the results of runs on this machine as they come."""
    free: queue.SimpleQueue[ScenarioProcess] = queue.SimpleQueue()
    workers = [ScenarioProcess() for _ in range(max(1, min(count, len(runs))))]
    for worker in workers:
        free.put(worker)
    stop = threading.Event()

    def carry_out(run: Run) -> Record | None:
        if stop.is_set():
            return None
        process = free.get()
        try:
            return run_one(process, plan.scenario, run, journal.folder)
        finally:
            free.put(process)

    with ThreadPoolExecutor(len(workers)) as pool:
        pending: set[Future[Record | None]] = {pool.submit(carry_out, run) for run in runs}
        try:
            while pending:
                done, pending = wait(pending, return_when=FIRST_COMPLETED)
                for future in done:
                    record = future.result()
                    if record is not None:
                        yield record
        finally:
            stop.set()
            for worker in workers:
                worker.close()


def run_one(process: ScenarioProcess, scenario: Path, run: Run, folder: Path) -> Record:
    """Carry out one run in a process; its picture is kept below a folder where it fails."""
    begun = time.perf_counter()
    document = read_scenario(scenario, run.parameters)
    result = run_once(process, document, run.seed, run.parameters, folder / PICTURES, record=False)
    return Record(
        run.number,
        run.seed,
        dict(run.parameters),
        result.passed,
        result.message,
        result.simulated_s,
        round(time.perf_counter() - begun, 3),
        dict(result.metrics),
        "" if result.folder is None else result.folder.relative_to(folder).as_posix(),
    )


def _on_cluster(plan: Plan, runs: Sequence[Run], journal: Journal, address: str) -> Iterator[Record]:
    """Yield the results of runs on a cluster of Ray as they come; all its machines see the same folders."""
    if find_spec("ray") is None:
        raise UserError("a cluster needs Ray: pip install 'daidalos[cluster]'")
    import ray

    ray.init(address=None if address == "local" else address, logging_level="ERROR", log_to_driver=False)

    class Worker:
        """Process of the scenarios on a machine of the cluster."""

        def __init__(self) -> None:
            self._process = ScenarioProcess()

        def run(self, run: Run) -> Record:
            """Carry out a run."""
            return run_one(self._process, plan.scenario.resolve(), run, journal.folder.resolve())

    remote: Any = ray.remote(Worker)
    workers: list[Any] = [remote.remote() for _ in range(max(1, int(ray.cluster_resources().get("CPU", 1))))]
    waiting = list(reversed(runs))
    busy: dict[Any, Any] = {}
    try:
        while waiting or busy:
            while workers and waiting:
                worker = workers.pop()
                busy[worker.run.remote(waiting.pop())] = worker
            done, _ = ray.wait(list(busy), num_returns=1)
            for reference in done:
                workers.append(busy.pop(reference))
                yield ray.get(reference)
    finally:
        ray.shutdown()


def default_processes() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
