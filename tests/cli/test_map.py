"""The command `daidalos map`."""

import json
from pathlib import Path

import numpy as np
import pytest

from daidalos.cli.daidalos import main
from daidalos.mapping.map_file import load_map
from mapping.bags import write_bag


def call(*words: object) -> int:
    return main(["map", *map(str, words)])


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bags") / "tour"
    write_bag(folder)
    return folder


def write_relations(path: Path, bag_offset_s: float = 0.0) -> Path:
    lines = [f"{1.0 + bag_offset_s + k:.6f} {1.2 + bag_offset_s + k:.6f} 0.1 0 0 0 0 0" for k in range(5)]
    path.write_text("\n".join(lines))
    return path


@pytest.mark.slow
def test_a_bag_becomes_the_files_of_map_server(bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    relations = write_relations(tmp_path / "truth.relations")
    trajectory = tmp_path / "tour.tum"
    assert call(bag, "-o", tmp_path / "tour", "--relations", relations, "--trajectory", trajectory) == 0
    out, err = capsys.readouterr()
    assert err == ""  # no progress bar where no terminal is
    lines = out.splitlines()
    assert "times real time" in lines[0]
    assert str(tmp_path / "tour.yaml") in lines[1]
    assert lines[2].startswith("error of odometry: translation ")
    assert lines[3].startswith("error of slam:     translation ")
    grid = load_map(tmp_path / "tour.yaml")
    assert grid.data.shape[1] * grid.resolution == pytest.approx(8.1, abs=0.2)
    poses = np.loadtxt(trajectory)
    assert poses.shape[1] == 8
    assert np.hypot(poses[:, 6], poses[:, 7]) == pytest.approx(np.ones(len(poses)))
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "tour.pgm",
        "tour.tum",
        "tour.yaml",
        "truth.relations",
    ]


def test_json_holds_the_same(bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    relations = write_relations(tmp_path / "truth.relations")
    options = ("--json", "--resolution", "0.1", "--mode", "raw")
    assert call(bag, "-o", tmp_path / "tour", "--relations", relations, *options) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["scans"] > 50
    assert report["resolution"] == 0.1
    assert report["real_time_factor"] > 0.0
    assert report["slam_error"]["relations"] == 5
    assert set(report["odometry_error"]) == set(report["slam_error"])
    assert "mode: raw" in (tmp_path / "tour.yaml").read_text()


def test_the_name_is_that_of_the_bag_unless_told(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(bag, "--resolution", 0.2) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["tour.pgm", "tour.yaml"]
    assert "cells of 0.2 m" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["gone"], "gone: no such file or folder"),
        (["{bag}", "--scan-topic", "/sonar"], "no topic /sonar of type sensor_msgs/msg/LaserScan"),
        (["{bag}", "--odom-topic", "/scan"], "no topic /scan of type nav_msgs/msg/Odometry"),
        (["{broken}"], "broken.mcap: not a readable bag"),
        (["{bag}", "--relations", "gone.relations"], "gone.relations: No such file"),
        (["{bag}", "--relations", "{other}"], "other.relations: the relations belong to another log"),
        (["{bag}", "--relations", "{bad}"], "bad.relations:1: expected eight numbers"),
        (["{bag}", "-o", "nowhere/map"], "no such folder"),
        (["{bag}", "--trajectory", "nowhere/t.tum"], "no such folder"),
        (["{bag}", "--trajectory", "folder"], "folder: cannot be written"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_written(
    bag: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    message: str,
) -> None:
    inputs, outputs = tmp_path / "inputs", tmp_path / "outputs"
    inputs.mkdir()
    (outputs / "folder").mkdir(parents=True)
    (inputs / "broken.mcap").write_bytes(b"not a bag")
    (inputs / "bad.relations").write_text("1 2 3\n")
    write_relations(inputs / "other.relations", 1e6)
    names = {
        "bag": str(bag),
        "broken": str(inputs / "broken.mcap"),
        "other": str(inputs / "other.relations"),
        "bad": str(inputs / "bad.relations"),
    }
    monkeypatch.chdir(outputs)
    assert call(*(argument.format(**names) for argument in arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("daidalos map: ")
    assert err.count("\n") == 1
    assert message in err
    assert [path.name for path in outputs.iterdir()] == ["folder"]


def test_a_resolution_that_is_none_is_refused(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        call(bag, "--resolution", "-1")
    assert stopped.value.code == 2
    assert "--resolution" in capsys.readouterr().err


@pytest.mark.slow
def test_trajectories_are_compared(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("tour.tum", "tour.g2o"):
        assert call(bag, "-o", "tour", "--trajectory", name, "--resolution", 0.2) == 0
    assert (tmp_path / "tour.g2o").read_text().startswith("VERTEX_SE2 0 ")
    capsys.readouterr()
    assert call("--compare", bag, "tour.tum", "--json") == 0
    report = json.loads(capsys.readouterr().out)
    assert 0.01 < report["ate_rmse_m"] < 2.0, "of the odometry"
    assert call("--compare", "tour.tum", "tour.tum") == 0
    out = capsys.readouterr().out
    assert "rmse 0.0000 m" in out
    assert "RPE over 1 m: translation 0.0000" in out
    assert "clocks: the second is +0.00 s ahead" in out
    assert call("--compare", "tour.yaml", "tour.yaml") == 0
    assert "100.0 % of the second map's walls are in the first" in capsys.readouterr().out
    assert call("--compare", "tour.g2o", "tour.tum") == 2
    assert "without times both must have the same number of poses" in capsys.readouterr().err
    assert call() == 2
    assert "expected a bag to be mapped, or --compare A B" in capsys.readouterr().err
