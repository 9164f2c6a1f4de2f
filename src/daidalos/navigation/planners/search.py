"""Parts of all best-first searches: their limits, and the priority queue of the kernels."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, MAX_NON_OBSTACLE, NO_INFORMATION
from daidalos.navigation.errors import NoPath, PlanningCancelled, PlanningTimedOut

RUNNING, FOUND, EXHAUSTED = 0, 1, 2
"""States of a search: not ended, ended at the goal, ended without anything left to expand."""

Prices = NDArray[np.float32]


def prices(base: float, weight: float, *, quadratic: bool, allow_unknown: bool) -> Prices:
    """Return the price of a cell's length over a cell of each cost, ``base + weight * share``.

    Parameters
    ----------
    base, weight : float
        Of free ground, and what is added at the highest passable cost.
    quadratic : bool
        Whether `share` is the square of the cost over the highest passable one.
    allow_unknown : bool
        Whether unknown cells are passable, at the highest price.
    """
    share = np.arange(256) / MAX_NON_OBSTACLE
    price = (base + weight * (share**2 if quadratic else share)).astype(np.float32)
    price[INSCRIBED_INFLATED_OBSTACLE:] = np.inf
    if allow_unknown:
        price[NO_INFORMATION] = price[MAX_NON_OBSTACLE]
    return price


def run_search(
    advance: Callable[[int], int],
    interval: int,
    is_cancelled: Callable[[], bool],
    *,
    max_iterations: int = 0,
    max_planning_time: float = 0.0,
) -> int:
    """Advance a search until it ends, and return its state then.

    Parameters
    ----------
    advance : callable
        Expands at most so many nodes and returns the state of the search.
    interval : int
        Nodes between two looks at the clock and at `is_cancelled`.
    is_cancelled : callable
    max_iterations : int
        Nodes that may be expanded; 0 or less for any number.
    max_planning_time : float
        Longest time [s]; 0 or less for any.

    Raises
    ------
    NoPath, PlanningTimedOut, PlanningCancelled
    """
    begun = time.monotonic()
    expanded = 0
    while True:
        count = min(interval, max_iterations - expanded) if max_iterations > 0 else interval
        state = advance(count)
        if state != RUNNING:
            return state
        expanded += count
        if is_cancelled():
            raise PlanningCancelled("the plan is no longer wanted")
        if 0.0 < max_planning_time < time.monotonic() - begun:
            raise PlanningTimedOut(f"no path was found within max_planning_time, {max_planning_time:g} s")
        if 0 < max_iterations <= expanded:
            raise NoPath(f"no path was found within max_iterations, {max_iterations}")


@compiled
def push(keys: NDArray[np.float32], items: NDArray[np.int32], size: int, key: float, item: int) -> int:
    """Add an item to a binary heap in two arrays, the smallest key first, and return its new size."""
    at = size
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] <= key:
            break
        keys[at], items[at] = keys[above], items[above]
        at = above
    keys[at], items[at] = key, item
    return size + 1


@compiled
def pop(keys: NDArray[np.float32], items: NDArray[np.int32], size: int) -> int:
    """Remove the first item of the heap, which its reader took before, and return its new size."""
    size -= 1
    key, item = keys[size], items[size]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= size:
            break
        if below + 1 < size and keys[below + 1] < keys[below]:
            below += 1
        if keys[below] >= key:
            break
        keys[at], items[at] = keys[below], items[below]
        at = below
    keys[at], items[at] = key, item
    return size


def grown(array: NDArray[np.generic], capacity: int) -> NDArray[np.generic]:
    """Return an array of at least so many rows with the same first ones; the others are not set."""
    if array.shape[0] >= capacity:
        return array
    larger = np.empty((max(capacity, 2 * array.shape[0]), *array.shape[1:]), dtype=array.dtype)
    larger[: array.shape[0]] = array
    return larger
