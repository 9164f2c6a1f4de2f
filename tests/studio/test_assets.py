"""Which files the page may fetch."""

import os

import pytest

from daidalos.studio.assets import AssetError, AssetResolver


@pytest.fixture
def share(tmp_path):
    folder = tmp_path / "share" / "my_robot"
    (folder / "meshes").mkdir(parents=True)
    (folder / "meshes" / "body part.stl").write_bytes(b"mesh")
    (folder / "secrets.txt").write_bytes(b"secret")
    (tmp_path / "share" / "outside.stl").write_bytes(b"outside")
    return folder


@pytest.fixture
def resolver(share):
    return AssetResolver(lambda package: share if package == "my_robot" else None)


def test_reads_a_mesh_of_a_package(resolver):
    assert resolver.read("package://my_robot/meshes/body%20part.stl") == b"mesh"


def test_a_texture_is_found_where_models_of_gazebo_keep_it(resolver, share):
    (share / "materials" / "textures").mkdir(parents=True)
    (share / "materials" / "textures" / "wood.png").write_bytes(b"picture")
    assert resolver.read("package://my_robot/meshes/wood.png") == b"picture"


@pytest.mark.parametrize(
    "uri",
    [
        "package://my_robot/../outside.stl",
        "package://my_robot/meshes/../../outside.stl",
        "package://my_robot/%2e%2e/outside.stl",
        "package://my_robot/..%2foutside.stl",
        "package://my_robot/..\\outside.stl",
        "package://my_robot/secrets.txt",
        "package://my_robot/meshes",
        "package://my_robot/missing.stl",
        "package://my_robot/meshes/a\0.stl",
        "package://unknown/a.stl",
        "package://",
        "file:///etc/passwd",
        "file:///etc/hosts.stl",
        "http://localhost/a.stl",
        "a.stl",
        "",
        "http://[",
    ],
)
def test_refuses_what_is_outside_absent_or_no_mesh(resolver, uri):
    with pytest.raises(AssetError) as caught:
        resolver.read(uri)
    assert str(caught.value).startswith(uri)


def test_files_are_read_from_the_folders_that_the_caller_allows(share, tmp_path):
    part = tmp_path / "elsewhere" / "part.stl"
    part.parent.mkdir()
    part.write_bytes(b"part")
    (part.parent / "key.txt").write_bytes(b"key")
    lines = []
    resolver = AssetResolver(lambda _: share, lambda path: path.is_relative_to(part.parent.resolve()), lines.append)
    assert resolver.read(part.as_uri()) == b"part"
    with pytest.raises(AssetError, match="not a mesh"):
        resolver.read((part.parent / "key.txt").as_uri())
    assert not lines
    outside = f"file://{part.parent}/../share/outside.stl"
    with pytest.raises(AssetError, match="outside of"):
        resolver.read(outside)
    assert len(lines) == 1
    assert outside in lines[0]


def linked(link, target):
    try:
        os.symlink(target, link)
    except OSError:
        pytest.skip("this system makes no links")


def test_a_link_out_of_a_package_needs_an_allowed_target(share, tmp_path):
    sources = tmp_path / "src"
    sources.mkdir()
    (sources / "mesh.stl").write_bytes(b"source")
    (tmp_path / "private.png").write_bytes(b"private")
    (sources / "key.txt").write_bytes(b"key")
    linked(share / "meshes" / "linked.stl", sources / "mesh.stl")
    linked(share / "meshes" / "private.png", tmp_path / "private.png")
    linked(share / "meshes" / "key.png", sources / "key.txt")
    linked(share / "meshes" / "up", tmp_path)
    linked(share / "meshes" / "loop.png", share / "meshes" / "loop.png")
    resolver = AssetResolver(lambda _: share, lambda path: path.is_relative_to(sources.resolve()))
    assert resolver.read("package://my_robot/meshes/linked.stl") == b"source"
    for refused in ("private.png", "key.png", "up/private.png", "loop.png"):
        with pytest.raises(AssetError):
            resolver.read(f"package://my_robot/meshes/{refused}")


@pytest.mark.parametrize(
    "uri", ["file://server/share/a.png", "file:a.png", "package://my_robot/" + "a" * 5000 + ".png"]
)
def test_no_path_of_another_machine_nor_a_relative_one(share, uri):
    with pytest.raises(AssetError):
        AssetResolver(lambda _: share, lambda path: True).read(uri)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_read(share):
    os.mkfifo(share / "meshes" / "pipe.png")
    with pytest.raises(AssetError, match="not a file"):
        AssetResolver(lambda _: share).read("package://my_robot/meshes/pipe.png")
