"""Pose graphs in the plane in g2o's text format: `VERTEX_SE2`, `EDGE_SE2` and `FIX` lines."""

from collections import deque
from pathlib import Path

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.errors import GraphFileError
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.text_file import read_lines, write_lines

_UPPER = np.triu_indices(3)
_NUMBERS = {"VERTEX_SE2": 4, "EDGE_SE2": 11}


def read_g2o(path: str | Path) -> tuple[Array, list[Edge]]:
    """Read a pose graph.

    Edges between poses that do not follow each other are closures. Poses are numbered in the order of their ids; where
    the file has none, they are composed along the edges.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    tuple of ndarray, shape (n, 3), and list of Edge
        First guesses of the poses, and the measurements.

    Raises
    ------
    GraphFileError
        Naming the file and the line.
    """
    file = Path(path)
    poses: dict[int, Array] = {}
    edges: list[tuple[int, int, int, Array]] = []
    for number, line in read_lines(file, GraphFileError):
        kind, *words = line.split()
        if kind not in _NUMBERS:
            if kind != "FIX":
                raise GraphFileError(file, number, f"expected VERTEX_SE2, EDGE_SE2 or FIX, found '{kind[:40]}'")
            continue
        values = _values(file, number, kind, words)
        if kind == "VERTEX_SE2":
            poses[int(words[0])] = values[1:]
        else:
            edges.append((number, int(words[0]), int(words[1]), values[2:]))
    ends = {identifier for _, first, second, _ in edges for identifier in (first, second)}
    if not poses and not edges:
        raise GraphFileError(file, None, "no VERTEX_SE2 or EDGE_SE2 in the file")
    rows = {identifier: row for row, identifier in enumerate(sorted(poses or ends))}
    found = [_edge(file, *edge, rows) for edge in edges]
    if not poses:  # as some public files have it
        return composed_poses(len(rows), found), found
    return np.array([poses[identifier] for identifier in sorted(poses)]), found


def composed_poses(count: int, edges: list[Edge]) -> Array:
    """Return poses (count, 3) composed along the edges from the first one, each over the fewest edges."""
    neighbours: dict[int, list[tuple[int, Array]]] = {}
    for edge in edges:
        neighbours.setdefault(edge.first, []).append((edge.second, edge.measurement))
        neighbours.setdefault(edge.second, []).append((edge.first, pose2.inverse(edge.measurement)))
    poses, placed, waiting = np.zeros((count, 3)), {0}, deque([0])
    while waiting:
        place = waiting.popleft()
        for other, measurement in neighbours.get(place, []):
            if other not in placed:
                poses[other] = pose2.compose(poses[place], measurement)
                placed.add(other)
                waiting.append(other)
    return poses


def write_g2o(path: str | Path, poses: Array, edges: list[Edge]) -> None:
    """Write poses (n, 3) and edges; the first pose is fixed.

    Raises
    ------
    GraphFileError
        When the file cannot be written.
    """
    lines = [f"VERTEX_SE2 {k} {_text(pose)}\n" for k, pose in enumerate(poses)]
    lines.append("FIX 0\n")
    lines += [
        f"EDGE_SE2 {edge.first} {edge.second} {_text(edge.measurement)} {_text(edge.information[_UPPER])}\n"
        for edge in edges
    ]
    write_lines(Path(path), lines, GraphFileError)


def _values(file: Path, number: int, kind: str, words: list[str]) -> Array:
    expected = _NUMBERS[kind]
    try:
        values = np.array([float(word) for word in words])
        identifiers = [int(word) for word in words[: 1 if kind == "VERTEX_SE2" else 2]]
    except ValueError:
        values, identifiers = np.zeros(0), []
    if len(values) != expected or not np.isfinite(values).all() or min(identifiers) < 0:
        raise GraphFileError(file, number, f"expected {expected} finite numbers after {kind}")
    return values


def _edge(file: Path, number: int, first: int, second: int, values: Array, rows: dict[int, int]) -> Edge:
    for identifier in (first, second):
        if identifier not in rows:
            raise GraphFileError(file, number, f"there is no VERTEX_SE2 {identifier}")
    information = np.zeros((3, 3))
    information[_UPPER] = values[3:]
    information = information + np.triu(information, 1).T
    return Edge(rows[first], rows[second], values[:3], information, closure=abs(rows[second] - rows[first]) != 1)


def _text(values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)
