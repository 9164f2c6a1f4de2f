"""The compiled rasteriser against a readable twin that asks every pixel for itself."""

import numpy as np
import pytest

from daidalos.simulation.rendering.raster import EDGES, NOTHING, draw

LENS = np.array((40.0, 42.0, 31.5, 23.5))
SHAPE = (48, 64)
NEAR, FAR = 0.2, 50.0


def rasterise(vertices, faces):
    transformed = np.zeros_like(vertices)
    inverse = np.full(SHAPE, 1 / FAR, dtype=np.float32)
    triangles = np.full(SHAPE, NOTHING, dtype=np.int32)
    radius = float(np.abs(vertices).max() * 2)
    draw(
        np.ones(1, dtype=bool), np.eye(4)[None, :3], np.array([[0.0, 0.0, 0.0, radius]]), np.array([[0, len(faces)]]),
        np.array([[0, len(vertices)]]), np.ones(1, dtype=bool), vertices, faces, LENS, NEAR, FAR, transformed,
        np.zeros((len(faces), EDGES)), np.zeros(len(faces), dtype=bool), inverse, triangles,
    )  # fmt: skip
    return inverse, triangles


def twin(vertices, faces):
    """Cut the ray of every pixel with every triangle (Möller and Trumbore)."""
    depths = np.full(SHAPE, FAR)
    seen = np.full(SHAPE, NOTHING)
    for row, column in np.ndindex(SHAPE):
        ray = np.array(((column - LENS[2]) / LENS[0], (row - LENS[3]) / LENS[1], 1.0))
        for number, (a, b, c) in enumerate(vertices[faces]):
            matrix = np.stack((b - a, c - a, -ray), axis=1)
            if abs(np.linalg.det(matrix)) < 1e-12:
                continue
            u, v, depth = np.linalg.solve(matrix, -a)
            if u >= 0 and v >= 0 and u + v <= 1 and NEAR < depth < depths[row, column]:
                depths[row, column], seen[row, column] = depth, number
    return depths, seen


@pytest.mark.parametrize("seed", range(4))
def test_random_triangles_are_seen_where_rays_hit_them(seed):
    """Some reach behind the camera."""
    random = np.random.default_rng(seed)
    vertices = random.uniform((-2, -2, -0.5), (2, 2, 5), (18, 3))
    faces = np.arange(18, dtype=np.int32).reshape(-1, 3)
    inverse, triangles = rasterise(vertices, faces)
    depths, seen = twin(vertices, faces)
    alike = triangles == seen
    assert alike.mean() > 0.998  # an edge may pass through a pixel's middle
    assert 1 / inverse[alike] == pytest.approx(depths[alike], rel=1e-3)


def test_triangles_that_share_an_edge_leave_no_gap():
    vertices = np.array([(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], dtype=float)
    _, triangles = rasterise(vertices, np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32))
    rows, columns = np.nonzero(triangles >= 0)
    area = (np.ptp(rows) + 1) * (np.ptp(columns) + 1)
    assert (triangles >= 0).sum() == area


def test_what_is_too_near_is_not_seen():
    vertices = np.array([(-1, -1, 0.1), (1, -1, 0.1), (0, 1, 0.1)])
    assert (rasterise(vertices, np.array([(0, 1, 2)], dtype=np.int32))[1] == NOTHING).all()
