"""Map of the seam ahead of the tool: what was measured of its edges, and robust parabolas through it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.profile_kernels import seam_at

CAPACITY = 4096
"""Measurements that are kept; 50 s at 12 ms."""
NODE_DISTANCE = 0.5e-3
"""Distance between the lengths at which the seam is fitted [m]."""
WINDOW = 7e-3
"""Distance from a length up to which measurements count for the seam there [m]."""
MIN_AGREEMENT = 0.5
"""Share of the measurements that must agree with the parabola through them."""


class SeamMap:
    """Edges along the path, from the lengths and places of measurements.

    Lengths must grow; a measurement that does not lie ahead of the last one is left out.
    """

    def __init__(self) -> None:
        self._places = np.zeros(2 * CAPACITY)
        self._edges = np.zeros((2, 2 * CAPACITY))
        self._weights = np.zeros(2 * CAPACITY)
        self._begin = self._end = 0
        self._nodes: list[float] = []
        self._first_node = 0.0

    @property
    def end(self) -> float:
        """Greatest length that was measured [m]; -infinity before the first."""
        return float(self._places[self._end - 1]) if self._end else -math.inf

    @property
    def known_end(self) -> float:
        """Greatest length up to which the seam is fitted [m]; -infinity before that."""
        return self._first_node + (len(self._nodes) - 1) * NODE_DISTANCE if self._nodes else -math.inf

    def add(self, s: float, right: float, left: float, weight: float) -> None:
        """Add a measurement: length, place of both edges [m] and weight."""
        if s <= self.end:
            return
        if self._end == len(self._places):
            self._forget()
        if not self._end:
            self._first_node = math.ceil(s / NODE_DISTANCE) * NODE_DISTANCE
        self._places[self._end] = s
        self._edges[:, self._end] = right, left
        self._weights[self._end] = weight
        self._end += 1
        if self._end - self._begin > CAPACITY:
            self._begin = self._end - CAPACITY
        self._fit()

    def raw(self, s: float) -> float:
        """Return the middle of the edges as it was measured nearest to a length [m]; NaN without measurements."""
        if not self._end:
            return math.nan
        index = self._begin + int(np.searchsorted(self._places[self._begin : self._end], s))
        index = min(max(index, self._begin), self._end - 1)
        return float(0.5 * self._edges[:, index].sum())

    def seam(self, s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the seam at lengths (n,) [m]; beyond what is known it stays as at the end. NaN where nothing is."""
        if not self._nodes:
            return np.full(len(s), math.nan)
        at = (np.asarray(s) - self._first_node) / NODE_DISTANCE
        nodes = np.array(self._nodes[max(int(at.min()) - 1, 0) : max(int(at.max()) + 3, 2)])
        shift = min(max(int(at.min()) - 1, 0), len(self._nodes) - 1)
        if not len(nodes):
            nodes = np.array(self._nodes[-1:])
        out: NDArray[np.float64] = np.interp(at - shift, np.arange(len(nodes)), nodes)
        return out

    def _fit(self) -> None:
        """Fit the seam at the lengths whose window is full."""
        while self._first_node + len(self._nodes) * NODE_DISTANCE + WINDOW <= self.end:
            at = self._first_node + len(self._nodes) * NODE_DISTANCE
            places = self._places[: self._end]
            begin = max(int(np.searchsorted(places, at - WINDOW)), self._begin)
            end = int(np.searchsorted(places, at + WINDOW))
            found = [seam_at(places, edge, self._weights, begin, end, at, WINDOW) for edge in self._edges]
            agreeing = min(float(one[2]) for one in found)
            value = 0.5 * float(found[0][0] + found[1][0])
            if agreeing < MIN_AGREEMENT:
                value = self._nodes[-1] if self._nodes else self.raw(at)
            self._nodes.append(value)

    def _forget(self) -> None:
        """Move the measurements that are kept to the beginning."""
        kept = slice(self._begin, self._end)
        count = self._end - self._begin
        for one in (self._places, self._weights, *self._edges):
            one[:count] = one[kept].copy()
        self._begin, self._end = 0, count
