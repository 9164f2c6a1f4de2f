"""A small kit to build coloured meshes from plain shapes and write them as compact COLLADA files."""

from __future__ import annotations

import datetime
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import collada
import numpy as np
import shapely
import trimesh
from shapely import affinity

DECIMALS = 5  # of lengths: a hundredth of a millimetre


@dataclass(frozen=True)
class Paint:
    """A colour with how much it shines."""

    name: str
    rgb: tuple[float, float, float]
    shine: float = 0.15


@dataclass(frozen=True)
class Part:
    """A closed surface in one colour; edges sharper than `crease` [rad] stay edges."""

    mesh: trimesh.Trimesh
    paint: Paint
    crease: float = 0.6

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Part:
        """Return the part shifted [m]."""
        mesh = self.mesh.copy()
        mesh.apply_translation((x, y, z))
        return Part(mesh, self.paint, self.crease)

    def turned(self, angle: float, axis: Sequence[float]) -> Part:
        """Return the part turned about an axis through the origin [rad]."""
        mesh = self.mesh.copy()
        mesh.apply_transform(trimesh.transformations.rotation_matrix(angle, axis))
        return Part(mesh, self.paint, self.crease)


def rounded_rectangle(width: float, depth: float, radius: float, segments: int = 6) -> shapely.Polygon:
    """Draw the outline of a plate, centred on the origin."""
    core = shapely.box(-width / 2 + radius, -depth / 2 + radius, width / 2 - radius, depth / 2 - radius)
    return core.buffer(radius, quad_segs=segments)


def disc(x: float, y: float, radius: float, segments: int = 4) -> shapely.Polygon:
    """Draw a round hole or outline; `segments` for a quarter of it."""
    return shapely.Point(x, y).buffer(radius, quad_segs=segments)


def slot(x: float, y: float, length: float, width: float, angle: float = 0.0) -> shapely.Polygon:
    """Draw a long hole with round ends."""
    half = (length - width) / 2
    line = shapely.LineString([(-half, 0), (half, 0)]).buffer(width / 2, quad_segs=3)
    return affinity.translate(affinity.rotate(line, angle, origin=(0, 0), use_radians=True), x, y)


def extrude(outline: shapely.Polygon, height: float, paint: Paint, bottom: float = 0.0) -> Part:
    """Raise an outline with its holes."""
    triangles = shapely.constrained_delaunay_triangles(shapely.geometry.polygon.orient(outline))
    corners = np.array([t.exterior.coords[:3] for t in triangles.geoms])[:, :, :2].reshape(-1, 2)
    vertices, index = np.unique(corners.round(8), axis=0, return_inverse=True)
    mesh = trimesh.creation.extrude_triangulation(vertices, index.reshape(-1, 3), height=height)
    mesh.apply_translation((0, 0, bottom))
    return Part(mesh, paint)


def box(size: Sequence[float], center: Sequence[float], paint: Paint, radius: float = 0.0, segments: int = 3) -> Part:
    """Build a box, its upright edges rounded when `radius` is given."""
    x, y, z = center
    if radius:
        outline = affinity.translate(rounded_rectangle(size[0], size[1], radius, segments), x, y)
        return extrude(outline, size[2], paint, z - size[2] / 2)
    mesh = trimesh.creation.box(extents=size)
    mesh.apply_translation(center)
    return Part(mesh, paint)


def revolve(profile: Sequence[tuple[float, float]], paint: Paint, segments: int = 40) -> Part:
    """Turn a profile of (radius, height) points about the z axis."""
    return Part(trimesh.creation.revolve(np.array(profile, dtype=float), sections=segments), paint)


def rod(start: Sequence[float], end: Sequence[float], radius: float, paint: Paint, segments: int = 12) -> Part:
    """Build a round bar between two points."""
    return Part(trimesh.creation.cylinder(radius=radius, segment=[list(start), list(end)], sections=segments), paint)


def save(parts: Sequence[Part], path: Path) -> None:
    """Write parts as one COLLADA file, one material and triangle set for each paint."""
    document = collada.Collada()
    document.assetInfo.created = document.assetInfo.modified = datetime.datetime(2025, 1, 1)
    document.assetInfo.upaxis = collada.asset.UP_AXIS.Z_UP
    document.assetInfo.unitname, document.assetInfo.unitmeter = "meter", 1.0
    paints = list({part.paint.name: part.paint for part in parts}.values())
    nodes = []
    for paint in paints:
        material = _material(document, paint)
        geometry = _geometry(document, paint.name, [part for part in parts if part.paint == paint])
        placed = collada.scene.GeometryNode(geometry, [collada.scene.MaterialNode(paint.name, material, inputs=[])])
        nodes.append(collada.scene.Node(paint.name, children=[placed]))
    document.scene = collada.scene.Scene("scene", nodes)
    document.scenes.append(document.scene)
    document.write(str(path))


def _material(document: collada.Collada, paint: Paint) -> collada.material.Material:
    effect = collada.material.Effect(
        f"{paint.name}-effect",
        [],
        "phong",
        diffuse=(*paint.rgb, 1.0),
        ambient=(*paint.rgb, 1.0),
        specular=(paint.shine, paint.shine, paint.shine, 1.0),
        shininess=10.0 + 60.0 * paint.shine,
    )
    material = collada.material.Material(f"{paint.name}-material", paint.name, effect)
    document.effects.append(effect)
    document.materials.append(material)
    return material


def _geometry(document: collada.Collada, name: str, parts: Sequence[Part]) -> collada.geometry.Geometry:
    """Collect corners with their normals; positions and normals are each stored once."""
    corners = np.concatenate([part.mesh.triangles.reshape(-1, 3) for part in parts])
    normals = np.concatenate([_corner_normals(part) for part in parts])
    points, point_index = np.unique(corners.round(DECIMALS), axis=0, return_inverse=True)
    directions, direction_index = np.unique(normals.round(2) + 0.0, axis=0, return_inverse=True)
    sources = [
        collada.source.FloatSource(f"{name}-points", points.ravel(), ("X", "Y", "Z")),
        collada.source.FloatSource(f"{name}-normals", directions.ravel(), ("X", "Y", "Z")),
    ]
    geometry = collada.geometry.Geometry(document, f"{name}-mesh", name, sources)
    inputs = collada.source.InputList()
    inputs.addInput(0, "VERTEX", f"#{name}-points")
    inputs.addInput(1, "NORMAL", f"#{name}-normals")
    indices = np.stack((point_index.ravel(), direction_index.ravel()), axis=1).ravel()
    geometry.primitives.append(geometry.createTriangleSet(indices, inputs, name))
    document.geometries.append(geometry)
    return geometry


def _corner_normals(part: Part) -> np.ndarray:
    """Return a normal for every corner of every triangle: smooth over flat edges, sharp over creases."""
    mesh = part.mesh
    mesh.merge_vertices()
    mesh.fix_normals()
    corners = mesh.faces.ravel()
    face_of_corner = np.repeat(np.arange(len(mesh.faces)), 3)
    order = np.argsort(corners, kind="stable")
    starts = np.searchsorted(corners[order], np.arange(len(mesh.vertices) + 1))
    weighted = mesh.face_normals * mesh.area_faces[:, None]
    normals = np.empty((len(corners), 3))
    limit = np.cos(part.crease)
    for first, last in itertools.pairwise(starts):
        here = order[first:last]
        faces = face_of_corner[here]
        alike = mesh.face_normals[faces] @ mesh.face_normals[faces].T >= limit
        normals[here] = alike @ weighted[faces]
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(lengths == 0, 1, lengths)
