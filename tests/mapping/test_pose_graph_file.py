import os
import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from daidalos.mapping import pose_graph_file
from daidalos.mapping.errors import MapFileError
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.pose_graph_file import SavedGraph, load_pose_graph, save_pose_graph
from daidalos.mapping.scan import to_cloud
from properties import examples

from .worlds import room_scan


@cache
def graph(count: int = 3, shift: float = 0.0) -> SavedGraph:
    poses = np.array([[shift + 0.2 * k, 0.0, 0.1 * k] for k in range(count)])
    clouds = [to_cloud(room_scan(pose), 20.0) for pose in poses]
    edges = [Edge(k, k + 1, np.array([0.2, 0.0, 0.1]), np.eye(3), closure=k == 1) for k in range(count - 1)]
    return SavedGraph(clouds, poses, poses + 1.0, edges, 0.025)


def assert_same(found: SavedGraph, expected: SavedGraph) -> None:
    assert np.array_equal(found.poses, expected.poses)
    assert np.array_equal(found.odom_poses, expected.odom_poses)
    assert found.resolution == expected.resolution
    assert [(edge.first, edge.second, edge.closure) for edge in found.edges] == [
        (edge.first, edge.second, edge.closure) for edge in expected.edges
    ]
    for one, other in zip(found.clouds, expected.clouds, strict=True):
        for name in ("points", "normals", "ends", "cleared", "origin"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-5)


def test_a_graph_is_saved_and_read(tmp_path: Path) -> None:
    files = save_pose_graph(graph(), tmp_path / "office")
    assert [file.name for file in files] == ["office.posegraph", "office.data"]
    assert sorted(os.listdir(tmp_path)) == ["office.data", "office.posegraph"]
    for name in ("office", "office.posegraph", "office.data"):
        assert_same(load_pose_graph(tmp_path / name), graph())
    save_pose_graph(graph(1), tmp_path / "office")
    assert_same(load_pose_graph(tmp_path / "office"), graph(1))
    assert sorted(os.listdir(tmp_path)) == ["office.data", "office.posegraph"]


@pytest.mark.parametrize("crash_at", range(7))
def test_a_crash_while_saving_leaves_the_old_map_or_the_new_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, crash_at: int
) -> None:
    """The process ends before one of its calls that change the folder."""

    class Crash(BaseException):
        pass

    calls = 0

    def crashing(call):
        def wrapped(*arguments, **options):
            nonlocal calls
            calls += 1
            if calls == crash_at + 1:
                raise Crash
            return call(*arguments, **options)

        return wrapped

    save_pose_graph(graph(3), tmp_path / "map")
    with monkeypatch.context() as patch:
        patch.setattr(pose_graph_file.os, "replace", crashing(os.replace))
        patch.setattr(pose_graph_file.os, "fsync", crashing(os.fsync))
        patch.setattr(Path, "unlink", crashing(Path.unlink))
        try:
            save_pose_graph(graph(2, 5.0), tmp_path / "map")
        except Crash:
            pass
        else:
            assert crash_at >= calls
    found = load_pose_graph(tmp_path / "map")
    assert_same(found, graph(3) if len(found.clouds) == 3 else graph(2, 5.0))
    save_pose_graph(graph(1), tmp_path / "map")
    assert_same(load_pose_graph(tmp_path / "map"), graph(1))


def test_what_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapFileError, match=r"none\.posegraph: no such file"):
        load_pose_graph(tmp_path / "none")
    save_pose_graph(graph(), tmp_path / "a")
    save_pose_graph(graph(2, 1.0), tmp_path / "b")
    shutil.copy(tmp_path / "b.data", tmp_path / "a.data")
    with pytest.raises(MapFileError, match=r"a\.data: does not belong to a\.posegraph"):
        load_pose_graph(tmp_path / "a")
    (tmp_path / "a.data").unlink()
    with pytest.raises(MapFileError, match=r"a\.data: no such file"):
        load_pose_graph(tmp_path / "a")
    (tmp_path / "boost.posegraph").write_bytes(b"\x16\0\0\0\0\0\0\0serialization::archive\x11\0" + bytes(40))
    with pytest.raises(MapFileError, match=r"boost\.posegraph: an archive of the C\+\+ slam_toolbox"):
        load_pose_graph(tmp_path / "boost")
    later = (tmp_path / "b.posegraph").read_bytes().replace(b"pose-graph 1", b"pose-graph 9", 1)
    (tmp_path / "b.posegraph").write_bytes(later)
    with pytest.raises(MapFileError, match=r"expected version 1 of the format, found '9'"):
        load_pose_graph(tmp_path / "b")
    with pytest.raises(MapFileError, match="No such file"):
        save_pose_graph(graph(), tmp_path / "no folder" / "a")


@examples(40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from([".posegraph", ".data"]), st.integers(0, 10**6), st.integers(1, 255), st.booleans())
def test_a_damaged_file_is_never_taken(tmp_path: Path, suffix: str, at: int, change: int, cut: bool) -> None:
    save_pose_graph(graph(), tmp_path / "map")
    path = tmp_path / f"map{suffix}"
    content = bytearray(path.read_bytes())
    at %= len(content)
    if cut:
        del content[at:]
    else:
        content[at] ^= change
    path.write_bytes(content)
    with pytest.raises(MapFileError) as raised:
        load_pose_graph(tmp_path / "map")
    assert "\n" not in str(raised.value)
