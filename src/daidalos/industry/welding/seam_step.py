"""Seams along the edges of STEP models, with the normals of their faces (extra `cad`)."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.welding.seam import Seam
from daidalos.industry.welding.seam_mesh import SHARP_ANGLE, check_picks, seam_along

SUFFIXES = (".step", ".stp")
SPACING = 1.0
"""Greatest distance of the points of an edge [mm]."""
_UNIT = 1e-3
"""Metres per unit of a model that was read: files name their unit, and are converted to millimetres."""
_DECIMALS = 4


def read_seam_step(path: Path, picks: list[tuple[float, float, float]]) -> Seam:
    """Return the seam along the edges of a STEP model between points picked on them.

    The normals are those of that face at each edge which looks more upwards (z of the model).

    Parameters
    ----------
    path : Path
        A STEP file.
    picks : list of points
        At least two [mm]; the seam leads along edges from the point nearest to the first to that nearest to the second,
        and so on.

    Raises
    ------
    UserError
        Where it is no STEP file, the extra is missing, or no edges connect the points.
    """
    shape = _load(path)
    vertices, edges, normals, ends = _sharp_edges(shape)
    if not len(edges):
        raise UserError(f"{path}: has no edge with more than {math.degrees(SHARP_ANGLE):g} deg between its faces")
    check_picks(picks, ends, str(path))
    return seam_along(vertices, edges, normals, picks, _UNIT, str(path))


def _load(path: Path) -> Any:
    try:
        from OCP.IFSelect import IFSelect_RetDone
        from OCP.Message import Message
        from OCP.STEPControl import STEPControl_Reader
    except ImportError:
        raise UserError(f"{path}: STEP files need cadquery-ocp-novtk; run: pip install 'daidalos[cad]'") from None
    # What it has to say would come between our own output.
    messenger = Message.DefaultMessenger_s()
    for printer in list(messenger.Printers()):
        messenger.RemovePrinter(printer)
    reader = STEPControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_RetDone or reader.TransferRoots() < 1:
        raise UserError(f"{path}: is no STEP file with a shape")
    return reader.OneShape()


def _sharp_edges(
    shape: Any,
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Return what the sharp edges of a shape are.

    Returns
    -------
    vertices : array of shape (n, 3)
        Points on them [mm].
    pieces : array of shape (m, 2)
        Of the edges between two points.
    normals : array of shape (m, 3)
        Of that face at each piece which looks more upwards.
    ends : array of shape (k, 2, 3)
        Of the edges as they are in the model [mm].
    """
    from OCP.BRep import BRep_Tool

    found: dict[tuple[float, float, float], int] = {}
    pieces: list[tuple[int, int]] = []
    normals: list[NDArray[np.float64]] = []
    ends: list[NDArray[np.float64]] = []
    for edge, faces in _edges_with_faces(shape):
        if BRep_Tool.Degenerated_s(edge) or len(faces) != 2:
            continue
        points, at = _points(edge)
        one, two = (np.array([_normal(edge, face, t) for t in at]) for face in faces)
        cosines = np.clip(np.einsum("ni,ni->n", one, two), -1.0, 1.0)
        if np.arccos(cosines).max() <= SHARP_ANGLE:
            continue
        ends.append(points[[0, -1]])
        indices = [found.setdefault(tuple(np.round(point, _DECIMALS).tolist()), len(found)) for point in points]
        for number, (first, second) in enumerate(itertools.pairwise(indices)):
            if first != second:
                pieces.append((first, second))
                normals.append(one[number] if one[number, 2] >= two[number, 2] else two[number])
    return (
        np.array(list(found), dtype=np.float64).reshape(len(found), 3),
        np.array(pieces, dtype=np.int64).reshape(len(pieces), 2),
        np.array(normals).reshape(len(normals), 3),
        np.array(ends).reshape(len(ends), 2, 3),
    )


def _edges_with_faces(shape: Any) -> list[tuple[Any, list[Any]]]:
    """Return each edge with its faces."""
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    at: dict[int, list[tuple[Any, list[Any]]]] = {}
    faces = TopExp_Explorer(shape, TopAbs_FACE)
    while faces.More():
        face = TopoDS.Face(faces.Current())
        edges = TopExp_Explorer(face, TopAbs_EDGE)
        while edges.More():
            edge = TopoDS.Edge(edges.Current())
            same = at.setdefault(hash(edge), [])
            for other, of in same:
                if other.IsSame(edge):
                    of.append(face)
                    break
            else:
                same.append((edge, [face]))
            edges.Next()
        faces.Next()
    return [entry for entries in at.values() for entry in entries]


def _points(edge: Any) -> tuple[NDArray[np.float64], list[float]]:
    """Return points (n, 3) along an edge [mm], and the parameters of the middles between them."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.GCPnts import GCPnts_AbscissaPoint

    curve = BRepAdaptor_Curve(edge)
    begin, end = curve.FirstParameter(), curve.LastParameter()
    count = max(math.ceil(GCPnts_AbscissaPoint.Length_s(curve) / SPACING), 1)
    parameters = np.linspace(begin, end, count + 1)
    points = [curve.Value(float(one)) for one in parameters]
    middles = 0.5 * (parameters[:-1] + parameters[1:])
    return np.array([[one.X(), one.Y(), one.Z()] for one in points]), middles.tolist()


def _normal(edge: Any, face: Any, parameter: float) -> NDArray[np.float64]:
    """Return the normal (3,) out of a face at a parameter of one of its edges."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
    from OCP.BRepLProp import BRepLProp_SLProps
    from OCP.TopAbs import TopAbs_REVERSED

    place = BRepAdaptor_Curve2d(edge, face).Value(parameter)
    properties = BRepLProp_SLProps(BRepAdaptor_Surface(face), place.X(), place.Y(), 1, 1e-6)
    if not properties.IsNormalDefined():
        return np.array([0.0, 0.0, 1.0])
    normal = properties.Normal()
    sign = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
    return sign * np.array([normal.X(), normal.Y(), normal.Z()])
