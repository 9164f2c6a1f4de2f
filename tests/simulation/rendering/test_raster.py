"""The compiled rasteriser against a readable twin that asks every pixel for itself."""

import numpy as np
import pytest

from daidalos.simulation.rendering.raster import EDGES, NOTHING, PROJECTED, draw
from daidalos.simulation.rendering.scene import planes_of

LENS = np.array((40.0, 42.0, 31.5, 23.5))
SHAPE = (48, 64)
NEAR, FAR = 0.2, 50.0


def rasterise(vertices, faces, two_sided=True):
    inverse = np.full(SHAPE, 1 / FAR, dtype=np.float32)
    triangles = np.full(SHAPE, NOTHING, dtype=np.int32)
    radius = float(np.abs(vertices).max() * 2)
    draw(
        np.ones(1, dtype=bool), np.eye(4)[None, :3], np.array([[0.0, 0.0, 0.0, radius]]), np.array([[0, len(faces)]]),
        np.zeros(1, dtype=np.int64), np.array([[0, len(vertices)]]), np.full(1, two_sided), vertices, faces,
        planes_of(vertices[faces]), LENS, NEAR, FAR, np.zeros((len(vertices), PROJECTED)),
        np.zeros((len(faces), EDGES)), np.zeros(len(faces), dtype=bool), inverse, triangles,
    )  # fmt: skip
    return inverse, triangles


def twin(vertices, faces, two_sided=True):
    """Cut the ray of every pixel with the plane of every triangle and ask barycentric coordinates."""
    depths, seen = np.full(SHAPE, FAR), np.full(SHAPE, NOTHING)
    rows, columns = np.indices(SHAPE)
    rays = np.stack(((columns - LENS[2]) / LENS[0], (rows - LENS[3]) / LENS[1], np.ones(SHAPE)), axis=-1)
    for number, (a, b, c) in enumerate(vertices[faces]):
        ab, ac, normal = b - a, c - a, np.cross(b - a, c - a)
        towards = -rays @ normal
        depth = -(a @ normal) / towards
        offset = rays * depth[..., None] - a
        u, v = np.cross(offset, ac) @ normal / (normal @ normal), np.cross(ab, offset) @ normal / (normal @ normal)
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (depth > NEAR) & (depth < depths) & (two_sided | (towards > 0))
        depths[hit], seen[hit] = depth[hit], number
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


@pytest.mark.parametrize("two_sided", [True, False])
def test_small_triangles_are_seen_where_rays_hit_them(two_sided):
    """Those of a few pixels are filled in another way than large ones."""
    random = np.random.default_rng(9)
    middles = random.uniform((-1.5, -1, 1.5), (1.5, 1, 4), (200, 3))
    vertices = (middles[:, None] + random.uniform(-0.12, 0.12, (200, 3, 3))).reshape(-1, 3)
    faces = np.arange(600, dtype=np.int32).reshape(-1, 3)
    inverse, triangles = rasterise(vertices, faces, two_sided)
    depths, seen = twin(vertices, faces, two_sided)
    assert (seen != NOTHING).sum() > (150 if two_sided else 75)
    assert (triangles != seen).sum() <= 2
    alike = triangles == seen
    assert 1 / inverse[alike] == pytest.approx(depths[alike], rel=1e-3)


@pytest.mark.parametrize("count", [2, 5, 10])
def test_a_wall_of_triangles_has_no_gap_and_no_pixel_twice(count):
    """Every vertex lies in the middle of a pixel, where the rule for edges decides; some are small, some large."""
    columns = np.concatenate(([10.0], np.linspace(30, 40, count).round()))
    rows = np.linspace(5, 40, count + 1).round()
    places = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    rays = np.column_stack(((places - LENS[2:]) / LENS[:2], np.ones(len(places))))
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    right, below, across = corner + 1, corner + count + 1, corner + count + 2
    halves = np.stack((corner, below, across), 1), np.stack((corner, across, right), 1)
    faces = np.concatenate(halves).astype(np.int32)
    seen = rasterise(2 * rays, faces)[1] >= 0
    times = sum((rasterise(2 * rays, face[None])[1] >= 0).astype(int) for face in faces)
    # Where six edges meet in a vertex, rounding decides.
    vertices = places[:, 1].astype(int), places[:, 0].astype(int)
    seen[vertices] = times[vertices] = 1
    assert seen[6:40, 11:40].all()
    assert times.max() == 1


def test_triangles_that_share_an_edge_leave_no_gap():
    vertices = np.array([(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], dtype=float)
    _, triangles = rasterise(vertices, np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32))
    rows, columns = np.nonzero(triangles >= 0)
    area = (np.ptp(rows) + 1) * (np.ptp(columns) + 1)
    assert (triangles >= 0).sum() == area


def test_what_is_too_near_is_not_seen():
    vertices = np.array([(-1, -1, 0.1), (1, -1, 0.1), (0, 1, 0.1)])
    assert (rasterise(vertices, np.array([(0, 1, 2)], dtype=np.int32))[1] == NOTHING).all()
