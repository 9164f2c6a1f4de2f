"""Models of one simple shape, for insertion into a world by hand."""

from __future__ import annotations

from daidalos.common.pose3 import Vector
from daidalos.description.geometry import Box, Cylinder, Geometry, Sphere
from daidalos.description.inertia import link_properties
from daidalos.description.link import Collision, Link, Material, Rgba, Visual
from daidalos.description.world import Model

SHAPES = ("box", "sphere", "cylinder")


def primitive(shape: str, size: Vector, mass: float = 1.0, color: Rgba = (0.6, 0.6, 0.6, 1.0)) -> Model:
    """Return a model with one link at the centre of its shape.

    Parameters
    ----------
    shape : str
        One of `SHAPES`.
    size : tuple of 3 floats
        Extents of a box [m]; of what is round the first is the diameter, the third a cylinder's height.
    mass : float
        [kg]; with 0 it never moves.
    color : tuple of 4 floats
        Red, green, blue, alpha in 0..1.

    Raises
    ------
    ValueError
        When the shape is unknown, or a size or mass makes no sense.
    """
    if mass < 0:
        raise ValueError(f"a mass should not be negative, got {mass:g}")
    geometry = _geometry(shape, size)
    link = Link("link", collisions=(Collision(geometry, name="collision"),))
    volume = link_properties(link, densities=[1.0])
    inertial = link_properties(link, densities=[mass / volume.mass]) if mass > 0 else None
    visual = Visual(geometry, material=Material(shape, color, ambient=color), name="visual")
    link = Link("link", inertial=inertial, visuals=(visual,), collisions=link.collisions)
    return Model(shape, links={"link": link}, static=mass == 0)


def _geometry(shape: str, size: Vector) -> Geometry:
    wanted = {"box": size, "sphere": size[:1], "cylinder": (size[0], size[2])}.get(shape)
    if wanted is None:
        raise ValueError(f"there is no shape {shape!r}; known are {', '.join(SHAPES)}")
    if min(wanted) <= 0:
        raise ValueError(f"a {shape} needs positive sizes, got {', '.join(f'{length:g}' for length in wanted)}")
    if shape == "box":
        return Box(size)
    return Sphere(size[0] / 2) if shape == "sphere" else Cylinder(size[0] / 2, size[2])
