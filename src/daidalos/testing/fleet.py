"""Fleets: all runs of a plan, on the processors of this machine or on a cluster."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import partial
from typing import TypeVar

from daidalos.testing.documents import read_scenario
from daidalos.testing.journal import Journal, Record
from daidalos.testing.plan import Plan
from daidalos.testing.processes import ScenarioProcess
from daidalos.testing.single import run_one

T = TypeVar("T")


def run_fleet(
    plan: Plan, journal: Journal, processes: int | None, on_result: Callable[[Record], None], ray: str | None = None
) -> None:
    """Carry out the runs of a plan that the journal does not have yet.

    Parameters
    ----------
    plan : Plan
    journal : Journal
        Gets the results.
    processes : int, optional
        How many run at the same time; by default one a processor of this machine, or of the cluster.
    on_result : callable
        Called with each result.
    ray : str, optional
        Address of a cluster of Ray, on which they run instead of on this machine; ``local`` starts one here.

    Raises
    ------
    UserError
        When the scenario is not valid, or the cluster cannot be used.
    """
    first = plan.runs()[0] if plan.count else None
    read_scenario(plan.scenario, None if first is None else first.parameters)  # a fault is better told at once
    missing = [run for run in plan.runs() if run.number not in journal.records]
    if ray is None or not missing:
        carry_out = partial(run_one, scenario=plan.scenario, folder=journal.folder)
        results = run_here(missing, lambda process, run: carry_out(process, run=run), processes)
    else:
        from daidalos.testing.cluster import run_on_cluster

        results = run_on_cluster(plan.scenario, missing, journal.folder, ray, processes)
    for record in results:
        journal.add(record)
        on_result(record)


def run_here(
    runs: Sequence[T], perform: Callable[[ScenarioProcess, T], Record], processes: int | None = None
) -> Iterator[Record]:
    """Yield the results of runs on this machine as they come.

    Parameters
    ----------
    runs : sequence
    perform : callable
        Carries out a run in a process of scenarios, and returns its result.
    processes : int, optional
        How many run at the same time; by default one a processor.
    """
    count = processes or default_processes()
    free: queue.SimpleQueue[ScenarioProcess] = queue.SimpleQueue()
    workers = [ScenarioProcess() for _ in range(max(1, min(count, len(runs))))]
    for worker in workers:
        free.put(worker)
    stop = threading.Event()

    def carry_out(run: T) -> Record | None:
        if stop.is_set():
            return None
        process = free.get()
        try:
            return perform(process, run)
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


def default_processes() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
