"""Convex decomposition: it covers the surface and leaves what is open free."""

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull, cKDTree

from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion.convex import hull_of_points
from daidalos.simulation.conversion.decomposition import MAX_PARTS, decompose, sample_surface


def mesh_of(shape: trimesh.Trimesh) -> TriangleMesh:
    return TriangleMesh(np.asarray(shape.vertices, dtype=float), np.asarray(shape.faces, dtype=np.int32))


def ring(inner: float, outer: float, height: float, sections: int) -> trimesh.Trimesh:
    return trimesh.creation.annulus(inner, outer, height, sections=sections)


def covered(parts: list[np.ndarray], points: np.ndarray) -> np.ndarray:
    inside = np.zeros(len(points), dtype=bool)
    for part in parts:
        planes = ConvexHull(part, qhull_options="QJ").equations
        inside |= (points @ planes[:, :3].T + planes[:, 3] <= 1e-9).all(axis=1)
    return inside


def test_a_convex_body_stays_whole():
    assert len(decompose(mesh_of(trimesh.creation.icosphere(radius=0.5)))) == 1


@pytest.mark.slow
def test_a_hexagonal_wall_leaves_its_middle_free_and_is_solid():
    wall = ring(2.5, 2.7, 0.5, 6)
    parts = decompose(mesh_of(wall))
    assert 6 <= len(parts) <= MAX_PARTS
    angles = np.linspace(0, 2 * np.pi, 60)
    middle = np.stack((2.0 * np.cos(angles), 2.0 * np.sin(angles), np.zeros(60)), axis=1)
    assert not covered(parts, middle).any()
    assert not covered(parts, np.zeros((1, 3))).any()
    corners = wall.vertices[np.linalg.norm(wall.vertices[:, :2], axis=1) > 2.65]
    corners = corners[corners[:, 2] > 0] * [2.6 / 2.7, 2.6 / 2.7, 0.0]
    corners = corners[np.argsort(np.arctan2(corners[:, 1], corners[:, 0]))]
    share = np.linspace(0.0, 1.0, 20)[:, None, None]
    solid = (share * corners + (1 - share) * np.roll(corners, 1, axis=0)).reshape(-1, 3)
    assert covered(parts, solid).mean() > 0.97


def test_an_open_box_keeps_its_opening():
    box = trimesh.creation.box((1.0, 1.0, 1.0))
    open_box = trimesh.Trimesh(box.vertices, box.faces[box.face_normals[:, 2] < 0.5], process=False)
    parts = decompose(mesh_of(open_box))
    assert not covered(parts, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.45], [0.3, 0.3, 0.2]])).any()
    surface = sample_surface(mesh_of(open_box), 0.05)
    sides = [sample_surface(hull_of_points(part), 0.02) for part in parts]
    nearest, _ = cKDTree(np.concatenate(sides)).query(surface)
    assert nearest.max() < 0.05


@pytest.mark.parametrize("corners", [((0, 0, 0), (4, 0, 0), (4, 0.02, 0)), ((0, 0, 0), (1, 0, 0), (0.3, 0.8, 0))])
def test_samples_are_as_near_as_wanted_and_slivers_have_few(corners):
    triangle = TriangleMesh(np.array(corners, dtype=float), np.array([[0, 1, 2]], dtype=np.int32))
    samples = sample_surface(triangle, 0.05)
    random = np.random.default_rng(1).dirichlet((1, 1, 1), 1000) @ triangle.vertices
    assert cKDTree(samples).query(random)[0].max() < 0.075  # at most one in a cell
    assert len(samples) < 300


@pytest.mark.slow
@pytest.mark.parametrize("size", [0.012, 30.0])
def test_the_tolerance_follows_the_size(size):
    wall = ring(0.8 * size, size, 0.3 * size, 12)
    parts = decompose(mesh_of(wall))
    assert 1 <= len(parts) <= MAX_PARTS
    assert covered(parts, np.zeros((1, 3))).any() == (size < 0.03)  # 1 cm of concavity does not matter


@pytest.mark.slow
def test_the_result_is_the_same_every_time():
    wall = mesh_of(ring(1.0, 1.3, 0.4, 9))
    for one, other in zip(decompose(wall), decompose(wall), strict=True):
        np.testing.assert_array_equal(one, other)
