"""Shapes of URDF and SDF, in metres and in their own frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from daidalos.common.pose3 import Vector
from daidalos.description.errors import DescriptionError


@dataclass(frozen=True)
class Box:
    """Box centred on its frame."""

    size: Vector


@dataclass(frozen=True)
class Sphere:
    """Sphere centred on its frame."""

    radius: float


@dataclass(frozen=True)
class Cylinder:
    """Cylinder along z, centred on its frame."""

    radius: float
    length: float


@dataclass(frozen=True)
class Capsule:
    """Cylinder along z of `length` with a half sphere on each end, centred on its frame."""

    radius: float
    length: float


@dataclass(frozen=True)
class Ellipsoid:
    """Ellipsoid centred on its frame, with its three half axes."""

    radii: Vector


@dataclass(frozen=True)
class Cone:
    """A cone along z, its tip up, its frame in the middle between tip and base."""

    radius: float
    length: float


@dataclass(frozen=True)
class Plane:
    """Plane through its frame's origin; infinite for collision, `size` [m] for display."""

    normal: Vector = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True)
class Mesh:
    """Triangles of a mesh file.

    Parameters
    ----------
    uri : str
        As written in the description.
    path : Path or None
        The file that `uri` means here; None when its package or model is not known.
    scale : tuple of 3 floats
        Applied in the mesh's own frame; a negative number mirrors.
    submesh : str
        Take only this part of the file; empty for all of it.
    center : bool
        Move the part's centre to the frame's origin.
    optimization : str
        ``convex_hull`` or ``convex_decomposition`` for how it collides (SDF); empty leaves that to the
        simulator.
    where : str
        The place in the description, for errors.
    """

    uri: str
    path: Path | None = None
    scale: Vector = (1.0, 1.0, 1.0)
    submesh: str = ""
    center: bool = False
    optimization: str = ""
    where: str = field(default="", compare=False)


@dataclass(frozen=True)
class Heightmap:
    """Terrain from a grey image or elevation file, centred on `position`.

    Parameters
    ----------
    uri, path, where : str, Path or None, str
        As in `Mesh`.
    size : tuple of 3 floats
        Extent in x and y, and height of the brightest over the darkest value.
    position : tuple of 3 floats
        Offset of the terrain in its frame.
    texture : str
        The diffuse image's uri, empty when none.
    """

    uri: str
    path: Path | None
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    texture: str = ""
    where: str = field(default="", compare=False)


@dataclass(frozen=True)
class Polyline:
    """Closed outlines in the x-y plane, filled by the even-odd rule and extruded by `height` along z."""

    outlines: tuple[tuple[tuple[float, float], ...], ...]
    height: float


@dataclass(frozen=True)
class Empty:
    """No shape (SDF's ``<empty/>``)."""


Geometry = Box | Sphere | Cylinder | Capsule | Ellipsoid | Cone | Plane | Mesh | Heightmap | Polyline | Empty


def require_size(geometry: Geometry) -> None:
    """Raise an error if a shape has no extent.

    Raises
    ------
    DescriptionError
        When a length of it is zero or negative.
    """
    lengths = _lengths(geometry)
    if min(lengths, default=1.0) <= 0:
        words = ", ".join(f"{length:g}" for length in lengths)
        raise DescriptionError(f"a {type(geometry).__name__.lower()} needs positive sizes, got {words}")


def _lengths(geometry: Geometry) -> tuple[float, ...]:
    """Return the lengths of a shape that must be positive."""
    match geometry:
        case Box(size):
            return size
        case Sphere(radius):
            return (radius,)
        case Cylinder(radius, length) | Capsule(radius, length) | Cone(radius, length):
            return (radius, length)
        case Ellipsoid(radii):
            return radii
        case Mesh(scale=scale):
            return tuple(abs(factor) for factor in scale)
        case Polyline(height=height):
            return (height,)
        case Heightmap(size=(width, depth, _)):
            return (width, depth)
    return ()
