import tracemalloc

import numpy as np
import pytest
import trimesh

from daidalos.description.geometry import Box, Polyline, Sphere
from daidalos.description.meshes import TriangleMesh, triangles_of
from daidalos.simulation.conversion import decomposition
from daidalos.simulation.conversion.convex import connected_pieces, content_key, convex_parts

L_SHAPE = Polyline((((0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)),), 1.0)


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("DAIDALOS_CACHE", str(tmp_path))
    return tmp_path


def parts_of(mesh, decompose=True):
    return convex_parts(mesh, content_key(mesh), decompose)


def volume(mesh):
    return trimesh.Trimesh(mesh.vertices, mesh.faces).volume


def several(*meshes):
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return TriangleMesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(faces).astype(np.int32))


def shifted(mesh, x):
    return TriangleMesh(mesh.vertices + np.array([x, 0, 0]), mesh.faces)


BOX = triangles_of(Box((1, 2, 3)))


def test_what_is_convex_stays_whole():
    parts, concave = parts_of(BOX)
    assert not concave
    (part,) = parts
    assert volume(part) == pytest.approx(6)


def test_pieces_come_apart():
    mesh = several(BOX, shifted(BOX, 5), shifted(BOX, 10))
    assert [len(piece.faces) for piece in connected_pieces(mesh)] == [12, 12, 12]
    for decompose in (True, False):
        parts, concave = parts_of(mesh, decompose)
        assert not concave
        assert [volume(part) for part in parts] == pytest.approx([6, 6, 6])


@pytest.mark.slow
def test_concave_pieces_are_split_and_kept(own_cache, monkeypatch):
    corner = triangles_of(L_SHAPE)
    parts, concave = parts_of(corner)
    assert concave
    assert len(parts) >= 2
    assert sum(volume(part) for part in parts) == pytest.approx(5, rel=0.15)
    assert len(list((own_cache / "convex").iterdir())) == 1
    monkeypatch.setattr(decomposition, "decompose", None)
    again, _ = parts_of(corner)
    assert [len(part.vertices) for part in again] == [len(part.vertices) for part in parts]


@pytest.mark.slow
def test_a_broken_cache_is_made_again(own_cache):
    corner = triangles_of(L_SHAPE)
    parts_of(corner)
    (file,) = (own_cache / "convex").iterdir()
    file.write_bytes(b"half a file")
    assert len(parts_of(corner)[0]) >= 2


def test_what_moves_gets_hulls():
    (hull,), concave = parts_of(triangles_of(L_SHAPE), decompose=False)
    assert concave
    assert volume(hull) == pytest.approx(7, rel=1e-6)
    crumbs = several(*(shifted(BOX, 2 * i) for i in range(30)))
    parts, concave = parts_of(crumbs, decompose=False)
    assert len(parts) == 1
    assert concave


@pytest.mark.slow
def test_a_hull_of_very_many_vertices_needs_little_memory():
    ball = triangles_of(Sphere(1), segments=300)
    tracemalloc.start()
    (hull,), concave = parts_of(ball, decompose=False)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert not concave
    assert volume(hull) == pytest.approx(4 / 3 * np.pi, rel=1e-3)
    assert peak < 100 * ball.vertices.nbytes


@pytest.mark.parametrize(
    "vertices",
    [
        [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
        [(0, 0, 0), (1, 1, 1), (0, 1, 1)],
        [(0, 0, 0), (1, 0, 0), (2, 0, 0)],
        [(0, 0, 5), (1, 0, 5), (1, 1, 5)],
    ],
)
def test_flat_things_get_a_thickness(vertices):
    flat = TriangleMesh(np.array(vertices, dtype=float), np.array([(0, 1, 2)], dtype=np.int32))
    (part,), _ = parts_of(flat)
    assert 0 < volume(part) < 0.01
    np.testing.assert_allclose(np.ptp(part.vertices, axis=0), np.ptp(flat.vertices, axis=0), atol=0.01)


@pytest.mark.slow
def test_a_damaged_cache_does_not_count(own_cache):
    corner = triangles_of(L_SHAPE)
    expected = [part.vertices.tolist() for part in parts_of(corner)[0]]
    (file,) = (own_cache / "convex").iterdir()
    whole = file.read_bytes()
    middle = len(whole) // 2
    for damaged in (b"", whole[:9], whole[:middle], whole[:-9], whole[:middle] + b"\xff" * 9 + whole[middle + 9 :]):
        file.write_bytes(damaged)
        assert [part.vertices.tolist() for part in parts_of(corner)[0]] == expected
        assert file.read_bytes() == whole
    assert list((own_cache / "convex").iterdir()) == [file]
