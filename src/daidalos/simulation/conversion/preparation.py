"""Preparation of the collision meshes of models: read, and split into convex parts in parallel processes."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, wait
from typing import Any

from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Cone, Geometry, Mesh, Polyline
from daidalos.description.meshes import TriangleMesh, triangles_of
from daidalos.description.world import Model
from daidalos.simulation.conversion.convex import content_key, convex_parts, split_pieces
from daidalos.simulation.conversion.splitting import SplittingProcess
from daidalos.simulation.errors import SimulationError

MAX_THREADS = 8
REPORT_DELAY = 1.0
"""Time [s] until the first report of progress."""
REPORT_PERIOD = 2.0
"""Time [s] between two reports."""
_CHECK_PERIOD = 0.1

Progress = Callable[[int, int], None]
"""Called with the number of meshes that are ready and of all of them."""

Parts = tuple[list[TriangleMesh], bool]
"""What `convex_parts` returns."""

PreparedMeshes = dict[tuple[str, bool], Parts]
"""Convex parts of meshes, from each mesh's `content_key` and whether it was to be decomposed."""

_Prepared = tuple[tuple[str, bool], Parts] | None
"""What is prepared of one shape; None for a mesh that can not be read."""


def is_decomposed(shape: Mesh | Cone | Polyline, static: bool) -> bool:
    """Return whether a shape is split into convex parts: a static one is, unless the description wishes otherwise."""
    optimization = getattr(shape, "optimization", "")
    return optimization == "convex_decomposition" or (static and optimization != "convex_hull")


def prepare_meshes(
    models: Iterable[Model], progress: Progress | None = None, is_cancelled: Callable[[], bool] = lambda: False
) -> PreparedMeshes:
    """Return the convex parts of all collision meshes of models.

    The work is done in one thread for each core, all but one of which split meshes in a process of their own; the
    calling thread only waits, and can be interrupted.

    Parameters
    ----------
    models : iterable of Model
    progress : callable or None
        Called in this thread after a second, and then every two seconds.
    is_cancelled : callable
        Asked ten times a second in this thread.

    Returns
    -------
    PreparedMeshes
        Meshes that can not be read are not in it.

    Raises
    ------
    SimulationError
        When it was cancelled.
    """
    # The largest first, so that no thread is left with it at the end.
    shapes = sorted(dict.fromkeys(_shapes(models)), key=lambda shape: _file_size(shape[0]), reverse=True)
    if not shapes:
        return {}
    cancelled = threading.Event()
    jobs = deque((Future[_Prepared](), shape, decompose) for shape, decompose in shapes)
    futures = [future for future, _, _ in jobs]
    splitters = [SplittingProcess() for _ in range(min(_cores(), MAX_THREADS, len(shapes)) - 1)]
    # Daemon threads, since the reading of a mesh cannot be interrupted: a process that ends leaves them behind.
    threads = [
        threading.Thread(target=_work, args=(jobs, split, cancelled), name=f"meshes_{number}", daemon=True)
        for number, split in enumerate((split_pieces, *(splitter.split for splitter in splitters)))
    ]
    try:
        for thread in threads:
            thread.start()
        _wait(futures, progress, is_cancelled)
        for thread in threads:
            thread.join()
        return dict(result for future in futures if (result := future.result()) is not None)
    finally:
        cancelled.set()
        for splitter in splitters:
            splitter.close()


def _work(
    jobs: deque[tuple[Future[_Prepared], Geometry, bool]], split: Callable[..., Any], cancelled: threading.Event
) -> None:
    """Prepare meshes until none is left or the preparation is cancelled."""
    while not cancelled.is_set():
        try:
            future, shape, decompose = jobs.popleft()
        except IndexError:
            return
        try:
            future.set_result(_prepare(shape, decompose, split, cancelled))
        except BaseException as problem:  # raised again where the result is taken
            future.set_exception(problem)


def _cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def _shapes(models: Iterable[Model]) -> Iterator[tuple[Geometry, bool]]:
    for model in models:
        for link in model.links.values():
            for collision in link.collisions:
                if isinstance(collision.geometry, Mesh):
                    yield collision.geometry, is_decomposed(collision.geometry, model.static or link.static)


def _file_size(shape: Geometry) -> int:
    path = getattr(shape, "path", None)
    try:
        return 0 if path is None else os.stat(path).st_size
    except OSError:
        return 0


def _prepare(shape: Geometry, decompose: bool, split: Callable[..., Any], cancelled: threading.Event) -> _Prepared:
    if cancelled.is_set():
        return None
    try:
        mesh = triangles_of(shape)
    except DescriptionError:
        return None  # reported where the collision is added
    key = content_key(mesh)
    return (key, decompose), convex_parts(mesh, key, decompose, cancelled.is_set, split)


def _wait(
    futures: list[Future[_Prepared]],
    progress: Progress | None,
    is_cancelled: Callable[[], bool],
) -> None:
    due = time.monotonic() + REPORT_DELAY
    waiting: set[Future[_Prepared]] = set(futures)
    while waiting:
        waiting = wait(waiting, _CHECK_PERIOD).not_done
        if waiting and is_cancelled():
            raise SimulationError("the preparation of the meshes of collisions was cancelled")
        if progress is not None and waiting and time.monotonic() >= due:
            progress(len(futures) - len(waiting), len(futures))
            due += REPORT_PERIOD
