"""Workpieces as height fields: surface, target and region, with files and figures of the deviation."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError
from daidalos.common.errors import UserError
from daidalos.industry.columns import read_columns

RESOLUTION = 0.25e-3
MAX_CELLS = 16_000_000


@dataclass(frozen=True)
class Workpiece:
    """Workpiece on a grid in its own frame, z out of the material.

    Attributes
    ----------
    surface, target : array of shape (rows, columns)
        Heights as they are and as they shall be, rows along y [m].
    region : bool array of shape (rows, columns)
        Where the target counts.
    origin : array of shape (2,)
        x and y of the cell [0, 0] [m].
    resolution : float
        Edge of a cell [m].
    pose : array of shape (4, 4)
        Of the workpiece in the base of the robot.
    """

    surface: NDArray[np.float64]
    target: NDArray[np.float64]
    region: NDArray[np.bool_]
    origin: NDArray[np.float64]
    resolution: float
    pose: NDArray[np.float64]

    @property
    def x(self) -> NDArray[np.float64]:
        """Return x of the columns [m]."""
        places: NDArray[np.float64] = self.origin[0] + self.resolution * np.arange(self.surface.shape[1])
        return places

    @property
    def y(self) -> NDArray[np.float64]:
        """Return y of the rows [m]."""
        places: NDArray[np.float64] = self.origin[1] + self.resolution * np.arange(self.surface.shape[0])
        return places

    @property
    def excess(self) -> NDArray[np.float64]:
        """Return by how much the surface is above the target (rows, columns) [m]."""
        return self.surface - self.target

    def with_surface(self, surface: NDArray[np.float64]) -> Workpiece:
        """Return the workpiece with another surface."""
        return replace(self, surface=surface)

    def index(self, x: float, y: float) -> tuple[int, int]:
        """Return row and column of the cell nearest to a place, inside the field."""
        rows, columns = self.surface.shape
        row = round((y - float(self.origin[1])) / self.resolution)
        column = round((x - float(self.origin[0])) / self.resolution)
        return min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)

    def slopes(self, x: float, y: float, span: float = 2e-3) -> tuple[float, float]:
        """Return the slopes of the target along x and y about a place, over twice a span [m]."""
        row, column = self.index(x, y)
        steps = max(round(span / self.resolution), 1)
        rows, columns = self.target.shape
        low, high = max(row - steps, 0), min(row + steps, rows - 1)
        left, right = max(column - steps, 0), min(column + steps, columns - 1)
        return (
            float(self.target[row, right] - self.target[row, left]) / max((right - left) * self.resolution, 1e-12),
            float(self.target[high, column] - self.target[low, column]) / max((high - low) * self.resolution, 1e-12),
        )


@dataclass(frozen=True)
class Deviation:
    """Figures of how far a surface is above its target in the region.

    Attributes
    ----------
    mean, std, low, high : float
        Mean, standard deviation, 0.5 and 99.5 percent quantiles [m].
    within : float
        Share of the cells within the tolerance.
    excess_volume : float
        Volume above the target [m^3].
    """

    mean: float
    std: float
    low: float
    high: float
    within: float
    excess_volume: float

    def as_json(self) -> dict[str, float]:
        """Return the figures in micrometres, percent and cubic millimetres."""
        return {
            "mean_um": round(1e6 * self.mean, 2),
            "std_um": round(1e6 * self.std, 2),
            "low_um": round(1e6 * self.low, 1),
            "high_um": round(1e6 * self.high, 1),
            "within_percent": round(100.0 * self.within, 2),
            "excess_mm3": round(1e9 * self.excess_volume, 2),
        }


def deviation(workpiece: Workpiece, tolerance: float) -> Deviation:
    """Return the figures of a workpiece's deviation from its target."""
    excess = workpiece.excess[workpiece.region]
    low, high = np.quantile(excess, [0.005, 0.995])
    within = float((np.abs(excess) <= tolerance).mean())
    volume = float(np.maximum(excess, 0.0).sum()) * workpiece.resolution**2
    return Deviation(float(excess.mean()), float(excess.std()), float(low), float(high), within, volume)


def scanned(workpiece: Workpiece, noise: float, rng: np.random.Generator) -> Workpiece:
    """Return a workpiece as a scanner sees it: with noise of a deviation [m], and the median of 3 x 3 cells."""
    from scipy.ndimage import median_filter

    seen = workpiece.surface + rng.normal(0.0, noise, workpiece.surface.shape) if noise else workpiece.surface
    return workpiece.with_surface(median_filter(seen, size=3, mode="nearest") if noise else seen.copy())


def as_arrays(workpiece: Workpiece) -> dict[str, NDArray[Any]]:
    """Return what `read_workpiece` expects in an ``.npz`` file."""
    return {
        "surface": workpiece.surface.astype(np.float64),
        "target": workpiece.target.astype(np.float64),
        "region": workpiece.region,
        "origin": workpiece.origin,
        "resolution": np.array(workpiece.resolution),
        "pose": workpiece.pose,
    }


def read_workpiece(path: Path) -> Workpiece:
    """Return the workpiece in an ``.npz`` file, or on the grid of a ``.csv`` with x_mm, y_mm, z_mm and target_mm.

    Raises
    ------
    UserError
        Where it is none; the message names what is wrong.
    """
    if not path.is_file():
        raise UserError(f"{path}: there is no such file")
    if path.suffix.lower() == ".csv":
        return _from_columns(path)
    try:
        with np.load(path, allow_pickle=False) as file:
            content = {name: np.asarray(file[name]) for name in file.files}
    except (OSError, ValueError, zipfile.BadZipFile, EOFError, AttributeError, TypeError) as error:
        raise UserError(f"{path}: is no workpiece (.npz): {str(error).splitlines()[0]}") from None
    return _checked(content, path)


def _checked(content: dict[str, NDArray[Any]], path: Path) -> Workpiece:
    missing = [name for name in ("surface", "target", "region", "origin", "resolution") if name not in content]
    if missing:
        raise UserError(f"{path}: has no array '{missing[0]}'")
    surface = content["surface"]
    if surface.ndim != 2 or min(surface.shape) < 3 or surface.size > MAX_CELLS:
        raise UserError(f"{path}: 'surface' has the shape {surface.shape}, but rows and columns of cells are expected")
    for name, shape in (("target", surface.shape), ("region", surface.shape), ("origin", (2,)), ("resolution", ())):
        if content[name].shape != shape:
            raise UserError(f"{path}: '{name}' has the shape {content[name].shape}, but {shape} is expected")
    pose = content.get("pose", np.eye(4))
    if pose.shape != (4, 4):
        raise UserError(f"{path}: 'pose' has the shape {pose.shape}, but (4, 4) is expected")
    numbers = {"surface": surface, "pose": pose} | {name: content[name] for name in ("target", "origin", "resolution")}
    for name, values in numbers.items():
        if values.dtype.kind not in "fiu" or not np.isfinite(values).all():
            raise UserError(f"{path}: '{name}' has values that are not finite numbers")
    if content["region"].dtype != np.bool_ or not content["region"].any():
        raise UserError(f"{path}: 'region' must hold booleans, at least one of them true")
    resolution = float(content["resolution"])
    if not resolution > 0.0:
        raise UserError(f"{path}: 'resolution' is {resolution:g}, but must be greater than 0 m")
    floats = {name: np.ascontiguousarray(values, dtype=np.float64) for name, values in numbers.items()}
    return Workpiece(
        floats["surface"], floats["target"], content["region"], floats["origin"], resolution, floats["pose"]
    )


def _from_columns(path: Path) -> Workpiece:
    names = ("x_mm", "y_mm", "z_mm", "target_mm")
    columns, lines, _ = read_columns(path, names)
    for name in names:
        if name not in columns:
            raise DocumentError(f"has no column '{name}'; {', '.join(names)} are expected", str(path), 1)
    x, y = np.unique(np.round(columns["x_mm"], 6)), np.unique(np.round(columns["y_mm"], 6))
    steps = np.concatenate([np.diff(x), np.diff(y)])
    if len(x) < 3 or len(y) < 3 or np.ptp(steps) > 1e-3 * steps.mean():
        raise UserError(f"{path}: x_mm and y_mm are no grid with equal steps of at least 3 x 3 points")
    step = float(steps.mean())
    row = np.round((columns["y_mm"] - y[0]) / step).astype(np.int64)
    column = np.round((columns["x_mm"] - x[0]) / step).astype(np.int64)
    surface, target = np.full((2, len(y), len(x)), np.nan)
    cells = row * len(x) + column
    _, first, counts = np.unique(cells, return_index=True, return_counts=True)
    if (counts > 1).any():
        again = np.flatnonzero(cells == cells[first[int(np.argmax(counts > 1))]])[1]
        raise DocumentError("has the same x_mm and y_mm as a line before", str(path), lines[int(again)])
    surface[row, column], target[row, column] = 1e-3 * columns["z_mm"], 1e-3 * columns["target_mm"]
    if np.isnan(surface).any():
        gap = np.argwhere(np.isnan(surface))[0]
        raise UserError(f"{path}: there is no point at x_mm {x[gap[1]]:g}, y_mm {y[gap[0]]:g}")
    region = np.ones(surface.shape, dtype=np.bool_)
    return Workpiece(surface, target, region, 1e-3 * np.array([x[0], y[0]]), 1e-3 * step, np.eye(4))
