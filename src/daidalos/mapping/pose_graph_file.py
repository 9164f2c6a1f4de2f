"""Files of saved pose graphs: NAME.posegraph with poses and edges, NAME.data with the scans.

Each begins with a line that names its kind and version and a line with the SHA-256 of the rest, a NumPy archive. The
graph names the digest of the scans that it belongs to.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.mapping.errors import MapFileError
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.scan import Cloud

VERSION = 1
"""Version of the format that is written; others are refused."""

GRAPH_SUFFIX, DATA_SUFFIX = ".posegraph", ".data"

_KINDS = {GRAPH_SUFFIX: b"daidalos-pose-graph", DATA_SUFFIX: b"daidalos-scans"}
_BOOST_MARK = b"serialization::archive"
_POINT_SETS = ("points", "normals", "ends", "cleared")


@dataclass(frozen=True)
class SavedGraph:
    """Key scans and the pose graph between them.

    Attributes
    ----------
    clouds : list of Cloud
        The key scans.
    poses, odom_poses : ndarray, shape (n, 3)
        Where they were taken, in the map and in odometry's frame.
    edges : list of Edge
        The pose graph.
    resolution : float
        Side of a cell [m] of the map that was drawn.
    """

    clouds: list[Cloud]
    poses: Array
    odom_poses: Array
    edges: list[Edge]
    resolution: float = 0.05


def stem_of(name: str | Path) -> Path:
    """Return the path of a pose graph without the suffixes of its files.

    Raises
    ------
    MapFileError
        When no file can have that name.
    """
    if "\0" in str(name) or any(0xD800 <= ord(one) < 0xE000 for one in str(name)):
        raise MapFileError(Path(ascii(str(name))), None, "is a name that no file can have")
    try:
        path = Path(name).expanduser()
    except RuntimeError:
        raise MapFileError(Path(name), None, "names the home folder of an unknown user") from None
    return path.with_suffix("") if path.suffix in (GRAPH_SUFFIX, DATA_SUFFIX) else path


def save_pose_graph(graph: SavedGraph, name: str | Path) -> tuple[Path, Path]:
    """Write NAME.posegraph and NAME.data; a crash at any moment leaves the old pair or the new one readable.

    Returns
    -------
    tuple of Path
        The two files.

    Raises
    ------
    MapFileError
        When they cannot be written.
    """
    paths = graph_path, data_path = _paths(stem_of(name))
    data = _packed(DATA_SUFFIX, _scan_arrays(graph.clouds))
    graph_bytes = _packed(GRAPH_SUFFIX, _graph_arrays(graph, hashlib.sha256(data).hexdigest()))
    try:
        drafts = [_write_draft(data_path, data), _write_draft(graph_path, graph_bytes)]
        # The old scans stay readable beside the old graph until the new graph names the new scans.
        if data_path.exists():
            os.replace(data_path, _previous(data_path))
        os.replace(drafts[0], data_path)
        os.replace(drafts[1], graph_path)
        _previous(data_path).unlink(missing_ok=True)
    except OSError as error:
        path = Path(str(error.filename)) if error.filename else graph_path
        raise MapFileError(path, None, error.strerror or str(error)) from error
    return paths


def load_pose_graph(name: str | Path) -> SavedGraph:
    """Read a pose graph that `save_pose_graph` wrote.

    Parameters
    ----------
    name : str or Path
        Path of the files, with or without a suffix.

    Raises
    ------
    MapFileError
        Naming the file and what is wrong with it.
    """
    graph_path, data_path = _paths(stem_of(name))
    graph = _unpacked(graph_path, _read(graph_path))
    try:
        digest = str(graph["data"])
        data_path, data = next(
            ((path, data) for path, data in _candidates(data_path) if hashlib.sha256(data).hexdigest() == digest),
            (data_path, b""),
        )
        if not data:
            _unpacked(data_path, _read(data_path))  # a damaged file is reported as such
            raise MapFileError(data_path, None, f"does not belong to {graph_path.name}: the two were saved apart")
        scans = _unpacked(data_path, data)
        return _graph_of(graph_path, graph, _clouds_of(data_path, scans))
    except KeyError as error:
        raise MapFileError(graph_path, None, f"damaged: {error.args[0]}") from None


def _paths(stem: Path) -> tuple[Path, Path]:
    return stem.parent / f"{stem.name}{GRAPH_SUFFIX}", stem.parent / f"{stem.name}{DATA_SUFFIX}"


def _previous(path: Path) -> Path:
    return path.with_name(f"{path.name}~")


def _candidates(path: Path) -> list[tuple[Path, bytes]]:
    """Return the files that may hold the scans: those in place, and those of an interrupted save."""
    return [(one, _read(one)) for one in (path, _previous(path)) if one.exists()]


def _write_draft(path: Path, content: bytes) -> Path:
    draft = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with draft.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
    except OSError:
        draft.unlink(missing_ok=True)
        raise
    return draft


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise MapFileError(path, None, (error.strerror or str(error)).lower()) from error


def _packed(suffix: str, arrays: Mapping[str, Any]) -> bytes:
    buffer = BytesIO()
    np.savez_compressed(buffer, **arrays)
    body = buffer.getvalue()
    head = b"%s %d\n%s\n" % (_KINDS[suffix], VERSION, hashlib.sha256(body).hexdigest().encode())
    return head + body


def _unpacked(path: Path, content: bytes) -> dict[str, Any]:
    """Return the arrays of a file.

    Raises
    ------
    MapFileError
        When it is of another kind or version, or damaged.
    """
    import zipfile
    import zlib

    kind, _, rest = content.partition(b"\n")
    digest, _, body = rest.partition(b"\n")
    words = kind.split(b" ")
    if words[0] != _KINDS[path.suffix.rstrip("~")]:
        if _BOOST_MARK in content[:64]:
            raise MapFileError(
                path, None, "an archive of the C++ slam_toolbox, which cannot be read: save the map anew"
            )
        raise MapFileError(path, None, f"not a {path.suffix.rstrip('~')} file, or damaged at its beginning")
    if words[1:] != [b"%d" % VERSION]:
        found = b" ".join(words[1:]).decode("ascii", "replace")
        raise MapFileError(path, None, f"expected version {VERSION} of the format, found '{found[:20]}'")
    if hashlib.sha256(body).hexdigest().encode() != digest:
        raise MapFileError(path, None, "damaged or cut short: its contents do not match its checksum")
    try:
        with np.load(BytesIO(body), allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (ValueError, OSError, EOFError, MemoryError, KeyError, zipfile.BadZipFile, zlib.error) as error:
        raise MapFileError(path, None, f"damaged: {error}") from error


def _graph_arrays(graph: SavedGraph, data_digest: str) -> dict[str, Any]:
    edges = graph.edges
    return {
        "data": np.array(data_digest),
        "resolution": np.array(graph.resolution),
        "poses": graph.poses,
        "odom_poses": graph.odom_poses,
        "ends": np.array([(edge.first, edge.second) for edge in edges], np.int64).reshape(-1, 2),
        "measurements": np.array([edge.measurement for edge in edges]).reshape(-1, 3),
        "information": np.array([edge.information for edge in edges]).reshape(-1, 3, 3),
        "closure": np.array([edge.closure for edge in edges], np.bool_),
    }


def _graph_of(path: Path, arrays: dict[str, Any], clouds: list[Cloud]) -> SavedGraph:
    count = len(clouds)
    poses, odom_poses = arrays["poses"], arrays["odom_poses"]
    ends, measurements, information = arrays["ends"], arrays["measurements"], arrays["information"]
    closure, resolution = arrays["closure"], float(arrays["resolution"])
    edge_count = len(ends)
    shapes = {
        "poses": (poses, (count, 3)),
        "odom_poses": (odom_poses, (count, 3)),
        "ends": (ends, (edge_count, 2)),
        "measurements": (measurements, (edge_count, 3)),
        "information": (information, (edge_count, 3, 3)),
        "closure": (closure, (edge_count,)),
    }
    for name, (array, shape) in shapes.items():
        if array.shape != shape or not np.isfinite(array).all():
            raise MapFileError(path, name, f"expected {' x '.join(map(str, shape))} finite values")
    if count == 0 or not 0.0 < resolution < np.inf or (edge_count and not (0 <= ends.min() <= ends.max() < count)):
        raise MapFileError(path, None, "damaged: it names scans that it does not have")
    edges = [
        Edge(int(first), int(second), measurement, matrix, bool(is_closure))
        for (first, second), measurement, matrix, is_closure in zip(
            ends, measurements, information, closure, strict=True
        )
    ]
    return SavedGraph(clouds, poses, odom_poses, edges, resolution)


def _scan_arrays(clouds: list[Cloud]) -> dict[str, Any]:
    arrays: dict[str, Any] = {"origins": np.array([cloud.origin for cloud in clouds]).reshape(-1, 2)}
    for name in _POINT_SETS:
        sets = [getattr(cloud, name) for cloud in clouds]
        arrays[name] = np.concatenate([*sets, np.zeros((0, 2))]).astype(np.float32)
        arrays[f"{name}_counts"] = np.array([len(one) for one in sets], np.int64)
    return arrays


def _clouds_of(path: Path, arrays: dict[str, Any]) -> list[Cloud]:
    origins = arrays["origins"]
    sets = {}
    for name in _POINT_SETS:
        values, counts = arrays[name], arrays[f"{name}_counts"]
        whole = counts.shape == (len(origins),) and (counts >= 0).all() and counts.sum() == len(values)
        if not whole or values.shape[1:] != (2,) or not np.isfinite(values).all():
            raise MapFileError(path, name, "expected points of every scan")
        sets[name] = np.split(values.astype(np.float64), np.cumsum(counts)[:-1]) if len(counts) else []
    return [
        Cloud(
            **{name: np.ascontiguousarray(points[k]) for name, points in sets.items()},
            origin=np.array(origin, np.float64),
        )
        for k, origin in enumerate(origins)
    ]
