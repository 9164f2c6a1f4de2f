import numpy as np
import pytest
import trimesh

from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Box, Cone, Cylinder, Empty, Heightmap, Mesh, Plane, Sphere
from daidalos.description.link import Material, Visual
from daidalos.description.meshes import triangles_of
from daidalos.description.visuals import GREY, _flat, visual_parts

RED = Material("red", (1, 0, 0, 1))


def test_shapes_have_normals_of_length_one_that_look_outwards():
    for shape in (Box((1, 2, 3)), Sphere(1), Cylinder(1, 2)):
        (part,) = visual_parts(Visual(shape))
        np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1, atol=1e-5)
        assert (np.einsum("ij,ij->i", part.normals, part.vertices) > 0).all()
        assert part.color == GREY


def test_edges_stay_sharp_and_round_things_smooth():
    (box,) = visual_parts(Visual(Box((1, 1, 1))))
    assert set(np.abs(box.normals).max(axis=1).round(5)) == {1.0}
    (sphere,) = visual_parts(Visual(Sphere(2)))
    np.testing.assert_allclose(sphere.normals, sphere.vertices / 2, atol=0.08)


def test_materials_and_transparency():
    (part,) = visual_parts(Visual(Box((1, 1, 1)), material=RED, transparency=0.25))
    assert part.color == (1, 0, 0, 0.75)
    assert visual_parts(Visual(Empty())) == ()


@pytest.fixture
def painted(tmp_path):
    pytest.importorskip("PIL")
    box = trimesh.creation.box((1, 1, 1))
    box.visual = trimesh.visual.TextureVisuals(
        material=trimesh.visual.material.PBRMaterial(baseColorFactor=[0, 255, 0, 255])
    )
    box.export(tmp_path / "green.glb")
    trimesh.creation.box((1, 1, 1)).export(tmp_path / "plain.stl")
    return tmp_path


def test_meshes_keep_their_colours_unless_sdf_overrides_them(painted):
    green = Mesh("g", painted / "green.glb", scale=(1, 1, 2))
    assert visual_parts(Visual(green))[0].color == pytest.approx((0, 1, 0, 1))
    assert visual_parts(Visual(green, material=RED))[0].color == pytest.approx((0, 1, 0, 1))
    overriding = Material("r", (1, 0, 0, 1), ambient=(1, 0, 0, 1))
    assert visual_parts(Visual(green, material=overriding))[0].color == (1, 0, 0, 1)
    assert np.ptp(visual_parts(Visual(green))[0].vertices[:, 2]) == pytest.approx(2)
    plain = Mesh("p", painted / "plain.stl")
    assert visual_parts(Visual(plain, material=RED))[0].color == (1, 0, 0, 1)


@pytest.mark.filterwarnings("error")
def test_a_scale_of_zero_leaves_nothing_to_draw(painted):
    flat = Mesh("green.glb", painted / "green.glb", scale=(1, 0, 1), where="r.urdf:7")
    with pytest.raises(DescriptionError, match=r"r.urdf:7: mesh green.glb has a scale of zero"):
        visual_parts(Visual(flat))


def test_textures(tmp_path):
    image = pytest.importorskip("PIL.Image")
    picture = tmp_path / "t.png"
    image.fromarray(np.array([[[255, 0, 0], [0, 255, 0]]], dtype=np.uint8)).save(picture)
    material = Material(texture="t.png", texture_path=picture)
    (part,) = visual_parts(Visual(Plane(size=(2, 4)), material=material))
    assert part.texture.tolist() == [[[255, 0, 0, 255], [0, 255, 0, 255]]]
    assert part.uv.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    picture.write_text("no image")
    with pytest.raises(DescriptionError, match="cannot be read"):
        visual_parts(Visual(Plane(), material=material))


def test_terrains(tmp_path):
    image = pytest.importorskip("PIL.Image")
    ramp = np.tile(np.linspace(0, 255, 17).astype(np.uint8), (17, 1))
    image.fromarray(ramp).save(tmp_path / "h.png")
    (part,) = visual_parts(Visual(Heightmap("h", tmp_path / "h.png", (10, 10, 5), (0, 0, 1))))
    east = part.vertices[part.vertices[:, 0] > 4.99]
    np.testing.assert_allclose(east[:, 2], 6, atol=1e-5)
    middle = part.normals[len(part.normals) // 2]
    np.testing.assert_allclose(middle, np.array([-0.5, 0, 1]) / np.hypot(0.5, 1), atol=0.02)


def test_missing_meshes_are_named():
    with pytest.raises(DescriptionError, match=r"w\.sdf:3: mesh x not found"):
        visual_parts(Visual(Mesh("x", None, where="w.sdf:3")))


def test_an_stl_keeps_its_edges(tmp_path):
    """Corners of a cube have the normals of their faces, not means over three of them."""
    path = tmp_path / "cube.stl"
    trimesh.creation.box((1, 1, 1)).export(path)
    (part,) = visual_parts(Visual(Mesh("cube.stl", path)))
    assert np.abs(part.normals).max(axis=1) == pytest.approx(1.0)
    corners = part.vertices[part.faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.einsum("ij,ij->i", flat, part.normals[part.faces[:, 0]]) == pytest.approx(1.0)


def test_a_place_where_very_many_triangles_meet_stays_quick():
    fan = triangles_of(Cone(1.0, 1.0), 4000)
    part = _flat(fan.vertices, fan.faces)
    assert np.linalg.norm(part.normals, axis=1) == pytest.approx(1.0, abs=1e-5)


def test_a_mesh_has_the_texture_that_the_model_keeps_beside_its_meshes(tmp_path):
    image = pytest.importorskip("PIL.Image")
    meshes, textures = tmp_path / "meshes", tmp_path / "materials" / "textures"
    meshes.mkdir()
    textures.mkdir(parents=True)
    image.fromarray(np.array([[[255, 0, 0], [0, 255, 0]]], dtype=np.uint8)).save(textures / "wood.png")
    (meshes / "plate.mtl").write_text("newmtl wood\nmap_Kd wood.png\n")
    (meshes / "plate.obj").write_text(
        "mtllib plate.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3\n"
    )
    (part,) = visual_parts(Visual(Mesh("plate.obj", meshes / "plate.obj")))
    assert part.texture[..., :3].tolist() == [[[255, 0, 0], [0, 255, 0]]]
