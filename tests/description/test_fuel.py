"""Where models of Gazebo Fuel are looked for."""

from pathlib import Path

import pytest

from daidalos.description.fuel import fuel_candidates


@pytest.fixture
def cache(tmp_path, monkeypatch):
    for variable in ("GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    for version in (3, 12, 9):
        (tmp_path / f".gz/fuel/fuel.gazebosim.org/openrobotics/models/x3 uav/{version}").mkdir(parents=True)
    return tmp_path / ".gz/fuel/fuel.gazebosim.org/openrobotics/models/x3 uav"


@pytest.mark.parametrize("server", ["fuel.gazebosim.org", "fuel.ignitionrobotics.org"])
@pytest.mark.parametrize(
    ("tail", "place"),
    [
        ("X3 UAV", "12"),
        ("X3%20UAV/", "12"),
        ("x3 uav/tip", "12"),
        ("X3 UAV/9", "9"),
        ("X3 UAV/4", "4"),
        ("X3 UAV/tip/files/meshes/a%20b.dae", "12/meshes/a b.dae"),
        ("X3 UAV/3/files/meshes/a.dae", "3/meshes/a.dae"),
    ],
)
def test_the_newest_or_the_wanted_version_comes_first(cache, server, tail, place):
    found = list(fuel_candidates(f"https://{server}/1.0/OpenRobotics/models/{tail}"))
    assert next(path for path in found if cache in path.parents) == cache / place


def test_every_cache_is_looked_into(cache, monkeypatch):
    monkeypatch.setenv("GZ_FUEL_CACHE_PATH", "/new")
    monkeypatch.setenv("IGN_FUEL_CACHE_PATH", "/old")
    found = list(fuel_candidates("https://models.example.org/1.0/Me/models/Box/2", [Path("/mine")]))
    part = "models.example.org/me/models/box/2"
    home = cache.parents[5]
    assert found == [
        *(Path(place, part) for place in ("/new", "/old", home / ".gz/fuel", home / ".ignition/fuel")),
        Path("/mine/Box"),
        Path("/mine/box"),
    ]


@pytest.mark.parametrize("uri", ["https://example.org", "https://example.org/model.sdf", "model://box"])
def test_other_addresses_have_no_place(uri):
    assert not list(fuel_candidates(uri, [Path("/mine")]))
