"""Seams in CSV files: positions, normals or quaternions, wrenches and zones in columns with names."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_text
from daidalos.common.suggestions import hint
from daidalos.industry.welding.seam import Seam

WRENCH_COLUMNS = ("fx", "fy", "fz", "mx", "my", "mz")
_GROUPS = {
    "positions": ("x", "y", "z"),
    "normals": ("nx", "ny", "nz"),
    "quaternions": ("qx", "qy", "qz", "qw"),
    "wrenches": WRENCH_COLUMNS,
}
_KNOWN = (*(name for group in _GROUPS.values() for name in group), "x_mm", "y_mm", "z_mm", "zone")
MAX_ROWS = 200_000


def read_seam_csv(path: Path) -> Seam:
    """Return the seam in a CSV file.

    The first line names the columns: ``x, y, z`` in metres or ``x_mm, y_mm, z_mm``; ``nx, ny, nz`` or
    ``qx, qy, qz, qw`` where they are known, else the normal is z of the base; ``fx, fy, fz, mx, my, mz`` in N and Nm;
    ``zone``.

    Raises
    ------
    DocumentError
        Where it is none; the message names line and column.
    """
    columns, lines, zones = read_columns(path, _KNOWN)
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
    return Seam(factor * positions, None if rotations is not None else normals, rotations, groups["wrenches"], zones)


def read_columns(
    path: Path, known: tuple[str, ...], text_column: str = "zone"
) -> tuple[dict[str, NDArray[np.float64]], list[int], tuple[str, ...]]:
    """Return the columns of a CSV file by name, the line of each row, and the texts of one column.

    Raises
    ------
    DocumentError
        Where a column is not known, or a value is no finite number.
    """
    source = str(path)
    rows = csv.reader(io.StringIO(read_text(path)), skipinitialspace=True)
    try:
        head = [name.strip().lower() for name in next(rows, [])]
        if not any(head):
            raise DocumentError("is empty; a line with names of columns is expected", source)
        for number, name in enumerate(head, 1):
            if name not in known:
                raise DocumentError(f"column {number}: there is no column '{name}'{hint(name, known)}", source, 1)
            if head.index(name) != number - 1:
                raise DocumentError(f"column {number}: '{name}' is there twice", source, 1)
        table: list[list[float]] = []
        texts: list[str] = []
        lines: list[int] = []
        for row in rows:
            if not any(cell.strip() for cell in row):
                continue
            if len(row) != len(head):
                raise DocumentError(f"has {len(row)} values, but {len(head)} are expected", source, rows.line_num)
            if len(table) == MAX_ROWS:
                raise DocumentError(f"has more than {MAX_ROWS} points", source, rows.line_num)
            pairs = list(enumerate(zip(head, row, strict=True), 1))
            texts += [cell.strip() for _, (name, cell) in pairs if name == text_column]
            table.append([_number(cell, n, source, rows.line_num) for n, (name, cell) in pairs if name != text_column])
            lines.append(rows.line_num)
    except csv.Error as error:
        raise DocumentError(f"is no CSV: {error}", source, rows.line_num) from None
    names = [name for name in head if name != text_column]
    values = np.array(table, dtype=np.float64).reshape(len(table), len(names))
    return {name: values[:, index] for index, name in enumerate(names)}, lines, tuple(texts)


def _number(cell: str, column: int, source: str, line: int) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DocumentError(f"column {column}: '{cell.strip()}' is no finite number", source, line)
    return value


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
