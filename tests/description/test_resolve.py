from pathlib import Path

import pytest

from daidalos.description.resolve import default_model_path, resolve_uri


@pytest.fixture
def tree(tmp_path):
    for name in ("share/robot/meshes/a.stl", "models/table/model.sdf", "here/b.stl", "here/with space.stl"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path


def test_each_kind_of_address(tree):
    def packages(name):
        return tree / "share" / name if name == "robot" else None

    def find(uri):
        return resolve_uri(uri, tree / "here", packages, [tree / "models"])

    mesh = tree / "share/robot/meshes/a.stl"
    assert find("package://robot/meshes/a.stl") == mesh
    assert find("model://robot/meshes/a.stl") == mesh
    assert find("model://table") == tree / "models/table"
    assert find("package://table/model.sdf") == tree / "models/table/model.sdf"
    assert find("b.stl") == tree / "here/b.stl"
    assert find("file://b.stl") == tree / "here/b.stl"
    assert find((tree / "here/with space.stl").as_uri()) == tree / "here/with space.stl"
    assert find(str(mesh)) == mesh


def test_packages_that_are_not_installed_are_found_around_the_file(tree):
    for name in ("src/arm/meshes/a.stl", "src/arm/urdf/deep/r.urdf", "src/wrist_v2/b.stl", "src/wrist_v2/sub/c.stl"):
        path = tree / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    (tree / "src/wrist_v2/package.xml").write_text("<package><name> wrist\n</name></package>")
    assert resolve_uri("package://arm/meshes/a.stl", tree / "src/arm/urdf/deep") == tree / "src/arm/meshes/a.stl"
    assert resolve_uri("model://arm/meshes/a.stl", tree / "src/wrist_v2") == tree / "src/arm/meshes/a.stl"
    assert resolve_uri("package://wrist/b.stl", tree / "src/wrist_v2/sub") == tree / "src/wrist_v2/b.stl"
    assert resolve_uri("package://wrist/b.stl", tree / "src/arm/urdf") is None
    assert resolve_uri("package://arm/meshes/a.stl", tree / "src/arm", lambda name: tree / "nowhere") is not None
    assert resolve_uri("package://arm/meshes/a.stl") is None
    assert resolve_uri("file://arm/meshes/a.stl", tree / "src/arm/urdf") == tree / "src/arm/meshes/a.stl"


def test_models_are_found_beside_the_folder_of_worlds(tree):
    (tree / "src/house/models/sofa").mkdir(parents=True)
    (tree / "src/house/worlds").mkdir()
    assert resolve_uri("model://sofa", tree / "src/house/worlds") == tree / "src/house/models/sofa"


@pytest.mark.parametrize("uri", ["package://nowhere/a.stl", "model://nowhere", "missing.stl", "https://x.org/a"])
def test_what_is_not_there_is_none(tree, uri):
    assert resolve_uri(uri, tree, lambda name: None, [tree]) is None


def test_gazebos_variables_give_the_model_path(monkeypatch, tmp_path):
    monkeypatch.setenv("GAZEBO_MODEL_PATH", f"{tmp_path}/a:{tmp_path}/b")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", f"{tmp_path}/c")
    assert default_model_path()[:3] == (tmp_path / "c", tmp_path / "a", tmp_path / "b")
    assert default_model_path()[-1] == Path.home() / ".gazebo" / "models"
