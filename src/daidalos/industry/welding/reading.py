"""Seams from files of any kind that is known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.welding import seam_mesh, seam_step
from daidalos.industry.welding.krl import read_krl
from daidalos.industry.welding.rapid_paths import read_rapid
from daidalos.industry.welding.ros_path import read_ros_path
from daidalos.industry.welding.seam import Seam, checked
from daidalos.industry.welding.seam_csv import read_seam_csv

PROGRAMS = {
    ".mod": read_rapid,
    ".modx": read_rapid,
    ".prg": read_rapid,
    ".pgf": read_rapid,
    ".src": read_krl,
    ".yaml": read_ros_path,
    ".yml": read_ros_path,
}
KINDS = (".csv", *seam_mesh.SUFFIXES, *seam_step.SUFFIXES, *PROGRAMS)


def read_seam(
    path: Path,
    picks: list[tuple[float, float, float]] | None = None,
    mesh_unit: float = 1e-3,
    place: NDArray[np.float64] | None = None,
) -> Seam:
    """Return the seam in a CSV file, a mesh, a STEP model, a program in RAPID or KRL, or a path of ROS.

    Parameters
    ----------
    path : Path
        The file; its suffix says of which kind it is.
    picks : list of points
        Where the seam of a mesh or a STEP model runs, in the mesh's unit or in millimetres.
    mesh_unit : float
        Metres per unit of the mesh.
    place : array of shape (4, 4)
        Pose of the workpiece, in which the file's points are, in the base of the robot.

    Raises
    ------
    UserError
        Where there is no seam in it.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise UserError(f"{path}: is of no known kind; one of {', '.join(KINDS)} is expected")
    try:
        if not path.is_file():
            raise UserError(f"{path}: there is no such file")
        if kind == ".csv":
            found = read_seam_csv(path)
        elif kind in seam_mesh.SUFFIXES:
            found = seam_mesh.read_seam_mesh(path, picks or [], mesh_unit)
        elif kind in seam_step.SUFFIXES:
            found = seam_step.read_seam_step(path, picks or [])
        else:
            found = Seam(*_without_normals(*PROGRAMS[kind](path)))
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from None
    return checked(found if place is None else placed(found, place), str(path))


def placed(seam: Seam, place: NDArray[np.float64]) -> Seam:
    """Return a seam whose workpiece has another pose (4, 4) in the base."""
    turn = place[:3, :3]
    return replace(
        seam,
        positions=seam.positions @ turn.T + place[:3, 3],
        normals=None if seam.normals is None else seam.normals @ turn.T,
        rotations=None if seam.rotations is None else turn @ seam.rotations,
    )


def _without_normals(
    positions: NDArray[np.float64], rotations: NDArray[np.float64]
) -> tuple[NDArray[np.float64], None, NDArray[np.float64]]:
    return positions, None, rotations
