import numpy as np
import pytest
import trimesh

from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from daidalos.description.meshes import load_mesh, read_scene, triangles_of
from description.robots import SHARE

SQUARE = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
HOLE = ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0))


@pytest.mark.parametrize(
    ("shape", "volume", "extent"),
    [
        (Box((1, 2, 3)), 6, (1, 2, 3)),
        (Sphere(1), 4 / 3 * np.pi, (2, 2, 2)),
        (Sphere(1e-4), 4e-12 / 3 * np.pi, (2e-4, 2e-4, 2e-4)),
        (Ellipsoid((1, 2, 3)), 8 * np.pi, (2, 4, 6)),
        (Cylinder(1, 3), 3 * np.pi, (2, 2, 3)),
        (Capsule(0.5, 2), np.pi * 0.25 * 2 + np.pi / 6, (1, 1, 3)),
        (Cone(1, 3), np.pi, (2, 2, 3)),
        (Polyline((SQUARE,), 2), 8, (2, 2, 2)),
        (Polyline((SQUARE, HOLE), 2), 7.5, (2, 2, 2)),
    ],
)
def test_solids_have_their_volume(shape, volume, extent):
    mesh = triangles_of(shape, segments=200)
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces)
    assert solid.is_watertight
    assert solid.volume == pytest.approx(volume, rel=2e-3)
    assert tuple(np.ptp(mesh.vertices, axis=0)) == pytest.approx(extent, rel=1e-3)
    if not isinstance(shape, Polyline):
        np.testing.assert_allclose(mesh.vertices.max(axis=0) + mesh.vertices.min(axis=0), 0, atol=1e-9)


@pytest.mark.parametrize("shape", [Sphere(0), Box((1, 0, 1)), Cylinder(1, -1), Ellipsoid((1, 1, 0))])
def test_a_shape_needs_an_extent(shape):
    with pytest.raises(DescriptionError, match="needs positive sizes, got"):
        triangles_of(shape)


def test_a_plane_has_no_inside():
    with pytest.raises(TypeError, match="Plane has no closed surface"):
        triangles_of(Plane())


@pytest.fixture
def wedge(tmp_path):
    """A body without symmetry: a box with one corner pulled out."""
    solid = trimesh.creation.box((1, 1, 1))
    solid.vertices[np.argmax(solid.vertices.sum(axis=1))] *= 2
    return tmp_path, solid


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "glb", "dae", "ply"])
def test_formats_hold_the_same_solid(wedge, kind):
    folder, solid = wedge
    path = folder / f"w.{kind.partition('_')[0]}"
    path.write_bytes(b"")
    exported = solid.export(file_type=kind)
    path.write_bytes(exported.encode() if isinstance(exported, str) else exported)
    mesh = load_mesh(Mesh(path.name, path))
    assert len(mesh.vertices) == 8
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx(solid.volume, rel=1e-5)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n"),
        ("m.dae", b"<COLLADA><library_geometries><geometry/></library_geometries></COLLADA>"),
        ("m.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n"),
    ],
)
def test_a_damaged_file_is_explained(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(
        DescriptionError, match=f"{name} cannot be read: it is incomplete, damaged or no {name[2:]} file"
    ):
        load_mesh(Mesh(name, path))


def test_mirrored_meshes_still_look_outwards(wedge):
    folder, solid = wedge
    solid.export(folder / "w.stl")
    mesh = load_mesh(Mesh("w.stl", folder / "w.stl", scale=(1, -2, 1)))
    mirrored = trimesh.Trimesh(mesh.vertices, mesh.faces)
    assert mirrored.volume == pytest.approx(2 * solid.volume, rel=1e-5)
    assert mesh.vertices[:, 1].min() == pytest.approx(-2 * solid.vertices[:, 1].max())


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_a_collada_files_unit_counts_and_its_up_axis_does_not(wedge, up):
    folder, solid = wedge
    text = solid.export(file_type="dae").decode()
    head, tail = text.split("</modified>")[0], text.split("</asset>")[1]
    unit = f'<unit name="millimeter" meter="0.001"/><up_axis>{up}</up_axis>'
    (folder / "w.dae").write_text(f"{head}</modified>{unit}</asset>{tail}")
    mesh = load_mesh(Mesh("w.dae", folder / "w.dae"))
    np.testing.assert_allclose(mesh.vertices.max(axis=0), 0.001 * solid.vertices.max(axis=0), rtol=1e-5)
    np.testing.assert_allclose(mesh.vertices.min(axis=0), 0.001 * solid.vertices.min(axis=0), rtol=1e-5)


def test_parts_and_centring(tmp_path):
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), node_name="near", geom_name="near")
    far = trimesh.transformations.translation_matrix((5, 0, 0))
    scene.add_geometry(trimesh.creation.box((2, 2, 2)), node_name="far", geom_name="far", transform=far)
    scene.export(tmp_path / "two.glb")
    part = load_mesh(Mesh("two.glb", tmp_path / "two.glb", submesh="far"))
    assert part.vertices[:, 0].min() == pytest.approx(4)
    centred = load_mesh(Mesh("two.glb", tmp_path / "two.glb", submesh="far", center=True))
    assert centred.vertices[:, 0].min() == pytest.approx(-1)
    with pytest.raises(DescriptionError, match="has no part 'middle'"):
        load_mesh(Mesh("two.glb", tmp_path / "two.glb", submesh="middle"))


@pytest.mark.parametrize(("name", "content"), [("a.stl", b"solid nonsense"), ("a.dae", b"<x>"), ("a.glb", b"")])
def test_broken_files_are_named(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DescriptionError, match=name):
        load_mesh(Mesh(name, tmp_path / name, where="r.urdf:3"))


def test_missing_files_are_named_with_the_description():
    with pytest.raises(DescriptionError, match=r"r.urdf:3: mesh package://x/a.stl not found"):
        load_mesh(Mesh("package://x/a.stl", None, where="r.urdf:3"))


def test_unknown_formats_are_named(tmp_path):
    (tmp_path / "a.step").touch()
    with pytest.raises(DescriptionError, match="step format; known are stl, dae"):
        load_mesh(Mesh("a.step", tmp_path / "a.step"))


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("wheel", (0.066, 0.066, 0.018)),
        ("lidar", (0.07, 0.07, 0.041)),
        ("waffle_plate", (0.266, 0.266, 0.004)),
    ],
)
def test_the_turtlebots_meshes_have_their_size(name, size):
    path = SHARE / f"turtlebot3_description/meshes/{name}.dae"
    assert path.stat().st_size < 300_000
    assert np.ptp(load_mesh(Mesh(name, path)).vertices, axis=0) == pytest.approx(size, abs=1e-3)


def test_what_trimesh_complains_of_is_one_line_with_the_file(tmp_path, caplog):
    text = trimesh.creation.box().export(file_type="ply", encoding="ascii").decode()
    path = tmp_path / "box.ply"
    (tmp_path / "broken.png").write_text("nothing")
    path.write_text(text.replace("element vertex", "comment TextureFile broken.png\nelement vertex"))
    read_scene(path, "w.sdf:1", with_materials=True)
    (record,) = (one for one in caplog.records if one.name == "daidalos.description.meshes")
    assert record.getMessage().startswith(f"mesh {path}: unable to load image!: cannot identify image file")
    assert record.exc_info is None
