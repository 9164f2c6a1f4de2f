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


def test_files_need_a_description_that_names_them(resolver, tmp_path):
    part = tmp_path / "elsewhere" / "part.stl"
    part.parent.mkdir()
    part.write_bytes(b"part")
    (part.parent / "texture.png").write_bytes(b"texture")
    (part.parent / "key.txt").write_bytes(b"key")
    with pytest.raises(AssetError):
        resolver.read(part.as_uri())
    resolver.allow_meshes_of(f'<mesh filename="{part.as_uri()}"/><mesh filename="file:///etc/passwd"/>')
    assert resolver.read(part.as_uri()) == b"part"
    assert resolver.read((part.parent / "texture.png").as_uri()) == b"texture"
    for refused in [part.parent / "key.txt", part.parent / ".." / "share" / "outside.stl"]:
        with pytest.raises(AssetError):
            resolver.read("file://" + str(refused))
    with pytest.raises(AssetError):
        resolver.read("file:///etc/passwd")


def test_what_a_simulator_shows_may_be_read(resolver, tmp_path):
    part = tmp_path / "world" / "rock.png"
    part.parent.mkdir()
    part.write_bytes(b"rock")
    for uri in ("", "model://rock", part.with_suffix(".txt").as_uri()):
        resolver.allow(uri)
    with pytest.raises(AssetError):
        resolver.read(part.as_uri())
    resolver.allow(part.as_uri())
    assert resolver.read(part.as_uri()) == b"rock"


def test_follows_links_that_a_symlinked_install_makes(resolver, share, tmp_path):
    source = tmp_path / "source.stl"
    source.write_bytes(b"source")
    try:
        os.symlink(source, share / "meshes" / "linked.stl")
    except OSError:
        pytest.skip("this system makes no links")
    assert resolver.read("package://my_robot/meshes/linked.stl") == b"source"
