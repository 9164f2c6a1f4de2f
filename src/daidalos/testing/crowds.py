"""People who walk about in a simulated world, and keep away from each other, from obstacles and from robots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.testing.pictures import outlines
from daidalos.testing.social_forces import Bodies, accelerations, walk

if TYPE_CHECKING:
    from daidalos.simulation import Simulation

STEP_S = 0.02
PERSON_RADIUS = 0.25
ROBOT_RADIUS = 0.24

_CELL = 0.1
_LOOK_AHEAD_CELLS = 4
_ARRIVED_M = 0.4
_PATIENCE_S = 4.0
_CLEARANCE = 0.1
_APART_M = 1.2


class Grounds:
    """Ground of a world: where people can be, and the ways between places.

    Parameters
    ----------
    shapes : sequence of arrays (n, 2)
        Outlines of the obstacles [m].
    """

    def __init__(self, shapes: Sequence[Any]) -> None:
        from scipy import ndimage, sparse
        from shapely import Polygon, contains_xy, unary_union

        solid = unary_union([Polygon(shape) for shape in shapes])
        left, low, right, high = solid.bounds
        self._origin = np.array([left, low])
        self.shape = (math.ceil((high - low) / _CELL) + 1, math.ceil((right - left) / _CELL) + 1)
        rows, columns = np.indices(self.shape)
        centres = self._origin + _CELL * (np.stack([columns, rows], axis=-1) + 0.5)
        blocked = contains_xy(solid.buffer(0.5 * _CELL), centres[..., 0], centres[..., 1])
        self.distance: Array = ndimage.distance_transform_edt(~blocked) * _CELL
        self._slope = np.stack(np.gradient(self.distance, _CELL)[::-1], axis=-1)
        self.free = self._largest_room(self.distance > PERSON_RADIUS + _CLEARANCE)
        self._centres = centres
        self._graph = sparse.csr_matrix(_steps(self.free))

    def _largest_room(self, free: Any) -> Any:
        """Return the largest connected part of free cells."""
        from scipy import ndimage

        labels, count = ndimage.label(free)
        sizes = np.bincount(labels.ravel(), minlength=count + 1)
        sizes[0] = 0
        return np.asarray(labels == int(np.argmax(sizes)))

    def places(self) -> Array:
        """Return the centres (n, 2) of all cells where a person can be [m]."""
        centres: Array = self._centres[self.free]
        return centres

    def ways_to(self, place: Array) -> Array:
        """Return the length of the shortest way from each cell to a place, shape of the ground."""
        from scipy.sparse.csgraph import dijkstra

        row, column = self._cells(place[None])[0]
        lengths: Array = dijkstra(self._graph, indices=int(row * self.shape[1] + column))
        return lengths.reshape(self.shape)

    def directions(self, positions: Array, ways: Sequence[Array]) -> Array:
        """Return unit vectors (n, 2) along the shortest ways from some positions, one way each."""
        reach = np.arange(-_LOOK_AHEAD_CELLS, _LOOK_AHEAD_CELLS + 1)
        found = np.zeros_like(positions)
        for index, (row, column) in enumerate(self._cells(positions)):
            rows = np.clip(row + reach, 0, self.shape[0] - 1)
            columns = np.clip(column + reach, 0, self.shape[1] - 1)
            window = ways[index][np.ix_(rows, columns)]
            best = np.unravel_index(int(np.argmin(window)), window.shape)
            ahead = self._centres[rows[best[0]], columns[best[1]]] - positions[index]
            found[index] = ahead / max(float(np.hypot(*ahead)), 1e-6)
        return found

    def walls(self, positions: Array) -> tuple[Array, Array]:
        """Return the distances (n,) to the nearest obstacles [m], and the directions (n, 2) away from them."""
        rows, columns = self._cells(positions).T
        normals = self._slope[rows, columns]
        lengths = np.maximum(np.hypot(normals[:, 0], normals[:, 1]), 1e-6)
        return self.distance[rows, columns], normals / lengths[:, None]

    def _cells(self, positions: Array) -> Any:
        """Return rows and columns (n, 2) of the cells of some positions."""
        cells = np.floor((positions - self._origin) / _CELL).astype(int)[:, ::-1]
        return np.clip(cells, 0, np.array(self.shape) - 1)


def _steps(free: Any) -> Any:
    """Return the matrix of steps between free cells that are side by side or corner to corner."""
    from scipy import sparse

    number = np.arange(free.size).reshape(free.shape)
    height, width = free.shape
    ends = []
    for i, j in ((0, 1), (1, 0), (1, 1), (1, -1)):
        first = (slice(0, height - i), slice(max(0, -j), width - max(0, j)))
        second = (slice(i, height), slice(max(0, j), width + min(0, j)))
        both = free[first] & free[second]
        ends.append((number[first][both], number[second][both], np.full(both.sum(), math.hypot(i, j))))
    rows, columns, lengths = (np.concatenate(parts) for parts in zip(*ends, strict=True))
    shape = (free.size, free.size)
    one_way = sparse.coo_matrix((lengths, (rows, columns)), shape)
    return one_way + one_way.T


class Crowd:
    """People who walk from place to place.

    Parameters
    ----------
    names : sequence of str
        Of their models.
    ground : Grounds
    robots : sequence of str
        Models that they keep away from.
    speeds : tuple of two floats
        Slowest and fastest of them [m/s].
    seed : int
    keep_clear : array (n, 2)
        Places [m] where nobody begins.
    """

    def __init__(
        self,
        names: Sequence[str],
        ground: Grounds,
        robots: Sequence[str],
        speeds: tuple[float, float],
        seed: int,
        keep_clear: Array,
    ) -> None:
        self.names = tuple(names)
        self._ground = ground
        self._robots = tuple(robots)
        self._stream = np.random.default_rng(seed)
        self._places = ground.places()
        self._speeds = self._stream.uniform(*speeds, len(names))
        self.positions = self._first_places(keep_clear)
        self._velocities = np.zeros_like(self.positions)
        self._goals = self.positions.copy()
        self._ways: list[Array] = [np.zeros(ground.shape) for _ in names]
        self._headings = np.zeros(len(names))
        self._patience = np.zeros(len(names))

    def _first_places(self, keep_clear: Array) -> Array:
        """Return places for all, apart from each other and from those that are kept clear."""
        taken = keep_clear.reshape(-1, 2)
        chosen: list[Array] = []
        apart = _APART_M
        while len(chosen) < len(self.names):
            others = np.concatenate([taken, *(one[None] for one in chosen)])
            place = self._places[self._stream.integers(len(self._places))]
            if others.size == 0 or np.hypot(*(others - place).T).min() > apart:
                chosen.append(place)
            else:
                apart = max(0.998 * apart, 2.0 * PERSON_RADIUS + 0.05)
        return np.array(chosen)

    def move(self, robots: Array) -> None:
        """Walk for a step, given where the robots are (n, 2) [m]."""
        self._choose_goals()
        people = Bodies(self.positions, np.full(len(self.names), PERSON_RADIUS))
        others = Bodies(robots.reshape(-1, 2), np.full(len(robots), ROBOT_RADIUS))
        wanted = self._speeds[:, None] * self._ground.directions(self.positions, self._ways)
        distances, normals = self._ground.walls(self.positions)
        push = accelerations(people, self._velocities, wanted, others, distances, normals)
        self._velocities = walk(people, self._velocities, push, self._speeds, others, STEP_S)
        after = self.positions + STEP_S * self._velocities
        ahead, _ = self._ground.walls(after)
        stopped = (ahead < PERSON_RADIUS) & (ahead < distances)
        self._velocities[stopped] = 0.0
        self.positions = np.where(stopped[:, None], self.positions, after)
        speed = np.hypot(*self._velocities.T)
        self._patience = np.where(speed < 0.3 * self._speeds, self._patience - STEP_S, _PATIENCE_S)
        headings = np.arctan2(self._velocities[:, 1], self._velocities[:, 0])
        self._headings = np.where(speed > 0.1, headings, self._headings)

    def _choose_goals(self) -> None:
        """Choose another goal for all who have arrived, or have stood for too long."""
        away = np.hypot(*(self._goals - self.positions).T)
        for index in np.flatnonzero((away < _ARRIVED_M) | (self._patience < 0.0)):
            self._goals[index] = self._places[self._stream.integers(len(self._places))]
            self._ways[index] = self._ground.ways_to(self._goals[index])
            self._patience[index] = _PATIENCE_S

    def step(self, simulation: Simulation) -> None:
        """Walk for a step in a simulation that has the models."""
        places = [simulation.pose(name).position[:2] for name in self._robots]
        self.move(np.array(places, dtype=float).reshape(-1, 2))
        data, model = simulation.physics.data, simulation.physics.model
        for name, (x, y), yaw in zip(self.names, self.positions.tolist(), self._headings.tolist(), strict=True):
            body = int(model.body(name).mocapid[0])
            qx, qy, qz, qw = Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw)).orientation
            data.mocap_pos[body] = (x, y, 0.0)
            data.mocap_quat[body] = (qw, qx, qy, qz)


def ground_of(simulation: Simulation, without: Sequence[str]) -> Grounds:
    """Return the ground of a simulation, with all models but some as obstacles."""
    shapes = [shape for owner, shape in outlines(simulation) if owner not in without and len(shape) > 2]
    return Grounds(shapes)
