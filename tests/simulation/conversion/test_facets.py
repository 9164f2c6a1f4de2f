"""Convex polygons of open surfaces: rooms become their walls, what is solid does not."""

import numpy as np
import pytest
import trimesh

from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion.decomposition import decompose
from daidalos.simulation.conversion.facets import convex_facets

CORNERS = [(0, 0), (6, 0), (6, 4), (3, 4), (3, 9), (0, 9)]
"""Of an L-shaped room [m]."""


def walls(corners: list[tuple[float, float]], height: float) -> TriangleMesh:
    """Return the walls between corners, without floor and ceiling."""
    count = len(corners)
    vertices = np.array([(x, y, z) for z in (0.0, height) for x, y in corners])
    faces = []
    for here in range(count):
        after = (here + 1) % count
        faces += [(here, after, count + after), (here, count + after, count + here)]
    return TriangleMesh(vertices, np.array(faces, dtype=np.int32))


def test_a_room_becomes_its_walls():
    parts = decompose(walls(CORNERS, 3.0))
    assert len(parts) == len(CORNERS)
    for part in parts:
        assert len(part) == 4
        assert np.ptp(part, axis=0).min() == pytest.approx(0)


def test_a_wall_with_a_doorway_keeps_it_open():
    outline = [(0, 0), (2, 0), (2, 2), (3, 2), (3, 0), (5, 0), (5, 3), (0, 3)]  # x, z
    triangles = [(0, 1, 2), (0, 2, 7), (2, 6, 7), (2, 3, 6), (3, 4, 5), (3, 5, 6)]
    wall = TriangleMesh(np.array([(x, 0.0, z) for x, z in outline]), np.array(triangles, dtype=np.int32))
    parts = convex_facets(wall)
    assert parts is not None
    assert 3 <= len(parts) <= 4
    for part in parts:
        low, high = part.min(axis=0), part.max(axis=0)
        assert not (low[0] < 2.5 < high[0] and low[2] < 1.0 < high[2])


def test_what_is_solid_is_none():
    box = trimesh.creation.box((1.0, 1.0, 0.05))
    faces = np.asarray(box.faces, dtype=np.int32)
    closed = TriangleMesh(np.asarray(box.vertices, dtype=float), faces)
    assert convex_facets(closed) is None
    assert convex_facets(TriangleMesh(closed.vertices, faces[1:])) is None  # a plate with a hole in its side
    many = trimesh.creation.icosphere(2)
    ball = TriangleMesh(np.asarray(many.vertices, dtype=float), np.asarray(many.faces[:-1], dtype=np.int32))
    assert convex_facets(ball) is None
