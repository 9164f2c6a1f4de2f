"""Seams: points with the surface's normals and the process wrench, and the poses of the tool along them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError

TILT = np.radians(2.5)
"""Tilt of the tool against the surface's normal in friction stir welding [rad]; its tip is ahead."""

MIN_AHEAD = 0.1
"""Sine of the angle between tool and path below which the direction of the path across the tool is not defined."""

MIN_DISTANCE = 1e-6
"""Distance below which two points in a row are one [m]."""


@dataclass(frozen=True)
class Seam:
    """A seam to be welded.

    Attributes
    ----------
    positions : array of shape (n, 3)
        Points in the base of the robot [m].
    normals : array of shape (n, 3) or None
        Unit vectors out of the surface; None where `rotations` are known.
    rotations : array of shape (n, 3, 3) or None
        Orientations of the tool, z into the workpiece, where the input holds them.
    wrenches : array of shape (n, 6) or None
        That the tool exerts on the workpiece, in the tool's axes with x ahead [N, Nm]; None where the input has none.
    zones : tuple of str
        Name of the zone of each point; empty where there are none.
    feeds, spindle_speeds : array of shape (n,) or None
        Speed of the tool [m/s] and of its spindle [turns/s] at each point; None where the input has none.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64] | None = None
    rotations: NDArray[np.float64] | None = None
    wrenches: NDArray[np.float64] | None = None
    zones: tuple[str, ...] = field(default=())
    feeds: NDArray[np.float64] | None = None
    spindle_speeds: NDArray[np.float64] | None = None

    @property
    def distances(self) -> NDArray[np.float64]:
        """Return the length of the path up to each point (n,) [m]."""
        return path_lengths(self.positions)


def path_lengths(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the length of a polyline (n, 3) up to each of its points (n,), in the unit of the points."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def checked(seam: Seam, source: str) -> Seam:
    """Return a seam whose points are finite and apart.

    Raises
    ------
    UserError
        Where there are fewer than two points, or the message names the point that is wrong.
    """
    if len(seam.positions) < 2:
        raise UserError(f"{source}: the path has {len(seam.positions)} points, but at least two are needed")
    finite = np.isfinite(seam.positions).all(axis=1)
    if not finite.all():
        raise UserError(f"{source}: point {int(np.argmin(finite)) + 1} is not finite")
    apart = np.diff(seam.distances) > MIN_DISTANCE
    if not apart.all():
        first = int(np.argmin(apart)) + 1
        raise UserError(f"{source}: points {first} and {first + 1} are at the same place; remove one of them")
    return seam


def tool_poses(seam: Seam, tilt: float = TILT) -> NDArray[np.float64]:
    """Compute the desired poses of the tool.

    Its z axis points into the workpiece, tilted so that its tip is ahead; x lies in the plane of direction and normal.

    Parameters
    ----------
    seam : Seam
        The seam.
    tilt : float
        Angle between the tool's axis and the normal [rad]; not used where the seam has orientations.

    Returns
    -------
    array of shape (n, 4, 4)

    Raises
    ------
    UserError
        Where the path runs along the normal.
    """
    poses = np.tile(np.eye(4), (len(seam.positions), 1, 1))
    poses[:, :3, 3] = seam.positions
    if seam.rotations is not None:
        poses[:, :3, :3] = seam.rotations
        return poses
    assert seam.normals is not None
    poses[:, :3, :3] = _surface_axes(seam, seam.normals) @ _about_y(tilt)
    return poses


def tool_axes(seam: Seam, poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the axes (n, 3, 3) that wrenches and deviations refer to: x ahead, y across, z along the tool.

    Parameters
    ----------
    seam : Seam
        The seam.
    poses : array of shape (n, 4, 4)
        Desired poses of the tool on it, with any rotation about its axis.
    """
    down = poses[:, :3, 2]
    ahead = np.gradient(seam.positions, seam.distances, axis=0)
    ahead -= np.einsum("ni,ni->n", ahead, down)[:, None] * down
    lengths = np.linalg.norm(ahead, axis=1)
    if (lengths < MIN_AHEAD).any():
        raise UserError(f"point {int(np.argmin(lengths)) + 1}: the tool points along the path")
    ahead /= lengths[:, None]
    return np.stack([ahead, np.cross(down, ahead), down], axis=2)


def resampled(seam: Seam, count: int) -> Seam:
    """Return a seam with its points, normals and wrenches at equal distances along the polyline."""
    distances = seam.distances
    at = np.linspace(0.0, distances[-1], count)
    nearest = np.clip(np.searchsorted(distances, at, side="right") - 1, 0, len(distances) - 1)

    def along(values: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
        if values is None:
            return None
        if values.ndim == 1:
            return np.interp(at, distances, values)
        return np.stack([np.interp(at, distances, column) for column in values.T], axis=1)

    positions, normals = along(seam.positions), along(seam.normals)
    assert positions is not None
    if normals is not None:
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    rotations = None
    if seam.rotations is not None:
        from scipy.spatial.transform import Rotation, Slerp

        rotations = Slerp(distances, Rotation.from_matrix(seam.rotations))(at).as_matrix()
    zones = tuple(seam.zones[index] for index in nearest) if seam.zones else ()
    return Seam(
        positions, normals, rotations, along(seam.wrenches), zones, along(seam.feeds), along(seam.spindle_speeds)
    )


def _surface_axes(seam: Seam, normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return axes (n, 3, 3): x ahead on the surface, z into the workpiece."""
    ahead = np.gradient(seam.positions, seam.distances, axis=0)
    ahead -= np.einsum("ni,ni->n", ahead, normals)[:, None] * normals
    lengths = np.linalg.norm(ahead, axis=1)
    if (lengths < MIN_AHEAD).any():
        raise UserError(f"point {int(np.argmin(lengths)) + 1}: the path runs along the normal of the surface")
    ahead /= lengths[:, None]
    return np.stack([ahead, np.cross(-normals, ahead), -normals], axis=2)


def _about_y(angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
