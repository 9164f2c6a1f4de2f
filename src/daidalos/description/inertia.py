"""Mass properties of solids, and plausibility checks of links' inertias."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Box, Cylinder, Ellipsoid, Empty, Geometry, Heightmap, Plane, Sphere
from daidalos.description.link import Collision, Inertial, Link, Visual
from daidalos.description.meshes import triangles_of

WATER = 1000.0
_LIGHTEST, _HEAVIEST = 5.0, 25_000.0  # hollow plastic, solid tungsten [kg/m^3]


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass [kg], centre (3,) [m] and inertia about it (3, 3) [kg m^2], in one frame."""

    mass: float
    center: Array
    inertia: Array


def solid_properties(geometry: Geometry, density: float = WATER) -> MassProperties:
    """Return the mass properties of a homogeneous solid in its own frame.

    Parameters
    ----------
    geometry : Geometry
        A plane, a heightmap and an empty shape weigh nothing.
    density : float
        [kg/m^3].

    Raises
    ------
    DescriptionError
        When a mesh is missing or cannot be read.
    """
    if isinstance(geometry, Plane | Heightmap | Empty):
        return MassProperties(0.0, np.zeros(3), np.zeros((3, 3)))
    closed_form = _closed_form(geometry)
    if closed_form is not None:
        volume, squares = closed_form
        xx, yy, zz = squares
        inertia = np.diag((yy + zz, xx + zz, xx + yy))
        return MassProperties(density * volume, np.zeros(3), density * volume * inertia)
    mesh = triangles_of(geometry)
    return _of_triangles(mesh.vertices[mesh.faces], density)


def combine(parts: Iterable[tuple[MassProperties, Pose]]) -> MassProperties:
    """Return the mass properties of several bodies fixed to one frame, each at its pose."""
    placed = [(p.mass, np.array(pose.transform(tuple(p.center))), _turn(p.inertia, pose)) for p, pose in parts]
    mass = sum(m for m, _, _ in placed)
    if mass <= 0:
        return MassProperties(0.0, np.zeros(3), np.zeros((3, 3)))
    center = sum((m * c for m, c, _ in placed), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for m, c, i in placed:
        arm = c - center
        inertia += i + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return MassProperties(mass, center, inertia)


def link_properties(link: Link, density: float = WATER, densities: Sequence[float] | None = None) -> Inertial:
    """Return the inertial of a link whose collisions are homogeneous solids.

    Parameters
    ----------
    link : Link
    density : float
        [kg/m^3].
    densities : sequence of float or None
        One for each collision instead.
    """
    each = [density] * len(link.collisions) if densities is None else densities
    parts = [
        (solid_properties(collision.geometry, rho), collision.pose)
        for collision, rho in zip(link.collisions, each, strict=True)
    ]
    whole = combine(parts)
    x, y, z = (float(value) for value in whole.center)
    i = whole.inertia
    moments = (i[0, 0], i[0, 1], i[0, 2], i[1, 1], i[1, 2], i[2, 2])
    xx, xy, xz, yy, yz, zz = (float(value) for value in moments)
    return Inertial(whole.mass, Pose((x, y, z)), (xx, xy, xz, yy, yz, zz))


def implausibilities(link: Link) -> list[str]:
    """Return sentences about implausible mass properties of a link, none if they are plausible."""
    inertial = link.inertial
    if inertial is None:
        return ["no inertial"] if link.collisions else []
    if inertial.mass == 0:
        return ["mass is zero"]
    xx, xy, xz, yy, yz, zz = inertial.inertia
    moments = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    found = []
    if moments[0] <= 0:
        found.append(f"moments of inertia {_words(moments)} should be positive")
    elif moments[2] > (moments[0] + moments[1]) * (1 + 1e-3):
        found.append(f"moments of inertia {_words(moments)}: the largest is more than the others together")
    return found + _compare_with_size(link, inertial, moments)


def _compare_with_size(link: Link, inertial: Inertial, moments: Array) -> list[str]:
    """Compare the mass properties with the link's visuals and collisions."""
    corners = _corners(link)
    if corners is None:
        return []
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    size = upper - lower
    found = []
    volume = float(np.prod(np.maximum(size, 1e-4)))
    density = inertial.mass / volume
    if not _LIGHTEST / 10 < density < _HEAVIEST:
        found.append(f"{inertial.mass:g} kg in a box of {_words(size)} m is {density:.3g} kg/m^3")
    center = np.array(inertial.pose.position)
    if (center < lower - 0.5 * size).any() or (center > upper + 0.5 * size).any():
        found.append(f"the centre of mass {_words(center)} is far outside the link")
    # No body reaches farther than its corners: I <= m r^2.
    reach = float(np.linalg.norm(corners - center, axis=1).max())
    if moments[2] > inertial.mass * reach**2 * 1.01:
        found.append(f"moment of inertia {moments[2]:.3g} is too large for {inertial.mass:g} kg within {reach:.3g} m")
    return found


def _corners(link: Link) -> Array | None:
    """Return corners (8 n, 3) of the bounding boxes of the link's shapes."""
    boxes = []
    parts: tuple[Collision | Visual, ...] = (*link.collisions, *link.visuals)
    for part in parts:
        try:
            vertices = triangles_of(part.geometry, segments=16).vertices
        except (TypeError, DescriptionError):
            continue
        lower, upper = vertices.min(axis=0), vertices.max(axis=0)
        box = np.array(np.meshgrid(*zip(lower, upper, strict=True))).reshape(3, -1).T
        boxes.append(box @ rotation_matrix(part.pose.orientation).T + part.pose.position)
    return np.concatenate(boxes) if boxes else None


def _closed_form(geometry: Geometry) -> tuple[float, Array] | None:
    """Return volume and the mean squares of x, y and z over it; None without a closed form."""
    if isinstance(geometry, Box):
        return float(np.prod(geometry.size)), np.square(geometry.size) / 12
    if isinstance(geometry, Sphere):
        return 4 / 3 * np.pi * geometry.radius**3, np.full(3, geometry.radius**2 / 5)
    if isinstance(geometry, Ellipsoid):
        return 4 / 3 * np.pi * float(np.prod(geometry.radii)), np.square(geometry.radii) / 5
    if isinstance(geometry, Cylinder):
        across = geometry.radius**2 / 4
        volume = np.pi * geometry.radius**2 * geometry.length
        return volume, np.array((across, across, geometry.length**2 / 12))
    return None


def _of_triangles(corners: Array, density: float) -> MassProperties:
    """Integrate over the tetrahedra between the origin and each triangle (m, 3, 3) of a closed surface."""
    a, b, c = corners.transpose(1, 0, 2)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    mass = float(volumes.sum())
    if mass <= 0:
        return MassProperties(0.0, np.zeros(3), np.zeros((3, 3)))
    total = a + b + c
    center = (volumes[:, None] * total).sum(axis=0) / (4 * mass)
    products = sum(np.einsum("k,ki,kj->ij", volumes, v, v) for v in (a, b, c, total)) / 20
    second = products - mass * np.outer(center, center)
    inertia = np.trace(second) * np.eye(3) - second
    return MassProperties(density * mass, center, density * inertia)


def _turn(inertia: Array, pose: Pose) -> Array:
    rotation = rotation_matrix(pose.orientation)
    turned: Array = rotation @ inertia @ rotation.T
    return turned


def _words(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
