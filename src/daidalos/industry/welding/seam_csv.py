"""Seams in CSV files: positions, normals or quaternions, wrenches and zones in columns with names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError
from daidalos.industry.columns import read_columns
from daidalos.industry.welding.seam import Seam

PROCESS_COLUMNS = {"feed_mm_min": 60e3, "spindle_rpm": 60.0}
"""Columns of feed and spindle speed, with how many of their units are 1 m/s or one turn a second."""
WRENCH_COLUMNS = ("fx", "fy", "fz", "mx", "my", "mz")
_GROUPS = {
    "positions": ("x", "y", "z"),
    "normals": ("nx", "ny", "nz"),
    "quaternions": ("qx", "qy", "qz", "qw"),
    "wrenches": WRENCH_COLUMNS,
}
_KNOWN = (*(name for group in _GROUPS.values() for name in group), "x_mm", "y_mm", "z_mm", "zone", *PROCESS_COLUMNS)


def read_seam_csv(path: Path) -> Seam:
    """Return the seam in a CSV file.

    The first line names the columns: ``x, y, z`` in metres or ``x_mm, y_mm, z_mm``; ``nx, ny, nz`` or
    ``qx, qy, qz, qw`` where they are known, else the normal is z of the base; ``fx, fy, fz, mx, my, mz`` in N and Nm;
    ``zone``; ``feed_mm_min`` and ``spindle_rpm``.

    Raises
    ------
    DocumentError
        Where it is none; the message names line and column.
    """
    columns, lines, zones = read_columns(path, _KNOWN, "zone")
    factor = 1.0
    if "x_mm" in columns:
        factor = 1e-3
        columns.update({axis: columns.pop(f"{axis}_mm") for axis in "xyz" if f"{axis}_mm" in columns})
    groups = {name: _group(columns, name, names, str(path)) for name, names in _GROUPS.items()}
    positions = groups["positions"]
    if positions is None:
        raise DocumentError("has no columns x, y, z or x_mm, y_mm, z_mm in its first line", str(path), 1)
    normals, rotations = groups["normals"], None
    if groups["quaternions"] is not None:
        from scipy.spatial.transform import Rotation

        _unit(groups["quaternions"], "quaternion", lines, path)
        rotations = Rotation.from_quat(groups["quaternions"]).as_matrix()
    elif normals is None:
        normals = np.tile([0.0, 0.0, 1.0], (len(positions), 1))
    else:
        normals = _unit(normals, "normal", lines, path)
    process = {name: _positive(columns, name, lines, path) for name in PROCESS_COLUMNS}
    return Seam(
        factor * positions,
        None if rotations is not None else normals,
        rotations,
        groups["wrenches"],
        zones,
        process["feed_mm_min"],
        process["spindle_rpm"],
    )


def _positive(
    columns: dict[str, NDArray[np.float64]], name: str, lines: list[int], path: Path
) -> NDArray[np.float64] | None:
    """Return a column of the process in m/s or turns a second; None where there is none."""
    values = columns.get(name)
    if values is None:
        return None
    wrong = values <= 0.0
    if wrong.any():
        row = int(np.argmax(wrong))
        raise DocumentError(f"{name} is {values[row]:g}, but must be greater than 0", str(path), lines[row])
    return values / PROCESS_COLUMNS[name]


def _group(
    columns: dict[str, NDArray[np.float64]], title: str, names: tuple[str, ...], source: str
) -> NDArray[np.float64] | None:
    there = [name for name in names if name in columns]
    if not there:
        return None
    if len(there) != len(names):
        missing = ", ".join(name for name in names if name not in columns)
        raise DocumentError(f"has {', '.join(there)} of the {title}, but not {missing}", source, 1)
    return np.stack([columns[name] for name in names], axis=1)


def _unit(values: NDArray[np.float64], title: str, lines: list[int], path: Path) -> NDArray[np.float64]:
    """Return vectors (n, m) of length 1."""
    lengths = np.linalg.norm(values, axis=1)
    wrong = np.abs(lengths - 1.0) > 1e-2
    if wrong.any():
        first = int(np.argmax(wrong))
        raise DocumentError(
            f"the {title} has the length {lengths[first]:.4g}, but must have 1", str(path), lines[first]
        )
    unit: NDArray[np.float64] = values / lengths[:, None]
    return unit
