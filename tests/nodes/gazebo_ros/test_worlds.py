"""Where worlds are found."""

import pytest

from daidalos.nodes.gazebo_ros._worlds import find_world


def test_worlds_are_found_where_packages_keep_them(tmp_path, monkeypatch):
    assert find_world("empty.sdf") is None
    assert find_world("arena.world").name == "arena.world"
    (tmp_path / "shop.sdf").write_text("")
    (tmp_path / "worlds").mkdir()
    (tmp_path / "worlds" / "hall.world").write_text("")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    assert find_world("shop.sdf") == tmp_path / "shop.sdf"
    assert find_world("hall.world") == find_world("worlds/hall.world") == tmp_path / "worlds" / "hall.world"
    with pytest.raises(FileNotFoundError, match=r"no world file 'none\.sdf'"):
        find_world("none.sdf")
