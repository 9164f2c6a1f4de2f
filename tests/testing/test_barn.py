"""The BARN benchmark: its worlds, its score, and a run."""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest

from daidalos.cli.daidalos import main
from daidalos.common.errors import UserError
from daidalos.description import sdf
from daidalos.testing.barn import BarnWorld, optimal_time, random_world, read_worlds
from daidalos.testing.barn_fields import random_field, shortest_way, widened


def write(path: Path, **changes: object) -> Path:
    """Write a file of two worlds, 7 and 8, of one post and of two."""
    arrays = {
        "cylinder_xy": np.array([[-2.0, 7.0], [-3.0, 6.0], [-1.0, 6.0]], dtype=np.float32),
        "offsets": np.array([0, 1, 3]),
        "radius": np.array(0.075),
        "path_007": np.array([[17.0, 0.0], [17.0, 29.0]]),
        "path_008": np.array([[17.0, 0.0], [21.0, 3.0], [17.0, 29.0]]),
    }
    np.savez(path, **{name: value for name, value in (arrays | changes).items() if value is not None})
    return path


def test_worlds_of_a_file(tmp_path: Path) -> None:
    worlds = read_worlds(write(tmp_path / "worlds.npz"))
    assert sorted(worlds) == [7, 8]
    assert worlds[7].posts.tolist() == [[-2.0, 7.0]]
    assert len(worlds[8].posts) == 2
    way = math.hypot(0.025, 2.075) + 29 * 0.15 + math.hypot(0.025, 13.0 - 5.075 - 29 * 0.15)
    assert worlds[7].optimal_time == pytest.approx(way / 2.0)


def test_the_worlds_of_the_benchmark(shared_data: Path) -> None:
    worlds = read_worlds(shared_data / "barn" / "barn_000_099.npz")
    assert sorted(worlds) == list(range(100))
    assert sum(len(world.posts) for world in worlds.values()) == 22835
    assert all(5.0 < world.optimal_time < 8.0 for world in worlds.values())


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"radius": None}, "expected an array 'radius'"),
        ({"offsets": np.array([0, 1])}, "an offset more than paths"),
        ({"offsets": np.array([0, 1, 9])}, "offsets that rise from 0 to 3"),
        ({"path_008": np.zeros((2, 3))}, "'path_008' should have two columns"),
        ({"cylinder_xy": np.full((3, 2), np.nan)}, "'cylinder_xy' should be finite"),
        ({"radius": np.array(-1.0)}, "'radius' should be positive"),
    ],
)
def test_files_that_are_wrong(tmp_path: Path, changes: dict[str, object], expected: str) -> None:
    with pytest.raises(UserError, match=expected):
        read_worlds(write(tmp_path / "worlds.npz", **changes))


def test_files_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "text.npz").write_text("not one")
    for name in ("text.npz", "absent.npz"):
        with pytest.raises(UserError, match=name):
            read_worlds(tmp_path / name)


@pytest.mark.parametrize(
    ("time", "score", "strict"), [(1.0, 0.25, 0.5), (20.0, 0.25, 0.25), (30.0, 1 / 6, 1 / 6), (90.0, 0.125, 0.125)]
)
def test_the_score(time: float, score: float, strict: float) -> None:
    world = BarnWorld(0, np.zeros((1, 2)), 0.075, optimal_time=5.0)
    assert world.score(time, 4.0) == pytest.approx(score)
    assert world.score(time, 2.0) == pytest.approx(strict)


def test_the_world_as_sdf(tmp_path: Path) -> None:
    path = tmp_path / "world.sdf"
    path.write_text(random_world(3).sdf())
    world = sdf.load(path)
    (posts,) = (model for model in world.models if model.name == "posts")
    assert len(posts.links["link"].collisions) == len(random_world(3).posts)


@pytest.mark.parametrize("seed", range(10))
def test_random_fields_have_a_way(seed: int) -> None:
    filled, path = random_field(seed)
    columns, rows = path.astype(int).T
    assert not widened(filled, 2)[rows, columns].any()
    assert (rows[0], rows[-1]) == (0, 29)
    assert np.abs(np.diff(path, axis=0)).max() == 1
    again, _ = random_field(seed)
    assert (again == filled).all()


def test_the_shortest_way_goes_around() -> None:
    blocked = np.zeros((5, 7), dtype=bool)
    blocked[2, :6] = True
    way = shortest_way(blocked)
    assert way is not None
    assert (6, 2) in {(int(x), int(y)) for x, y in way}
    blocked[2] = True
    assert shortest_way(blocked) is None


def test_the_optimal_time_of_a_straight_way() -> None:
    straight = np.stack([np.full(30, 2.575 / 0.15), np.arange(30)], axis=-1)
    assert optimal_time(straight) == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--worlds", "absent.npz"], "absent.npz: "),
        (["--first", "5", "--last", "4"], "--first not above --last"),
        (["--runs", "5"], "--runs is for scenarios"),
        (["--params-file", "absent.yaml"], "there is no parameter file 'absent.yaml'"),
        (["--processes", "0"], "--processes should be 1 or more"),
    ],
)
def test_arguments_that_are_wrong(words: list[str], expected: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "barn", *words]) == 2
    error = capsys.readouterr().err
    assert expected in error
    assert len(error.strip().splitlines()) == 1


def test_a_world_that_is_not_in_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(tmp_path / "worlds.npz")
    assert main(["bench", "barn", "--worlds", str(file), "--last", "9"]) == 2
    assert "there is no world 9; it has 7 to 8" in capsys.readouterr().err


def test_arguments_of_barn_for_a_scenario(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "crate.scenario.yaml", "--first", "1"]) == 2
    assert "--first is for `daidalos bench barn`" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")
def test_a_jackal_crosses_one_world_and_touches_something_in_the_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    posts = np.array([(-2.3, 7.0), (-2.2, 3.1), (-1.8, 3.1)])
    file = write(tmp_path / "worlds.npz", cylinder_xy=posts, offsets=np.array([0, 1, 3]))
    scores = tmp_path / "scores.json"
    results = tmp_path / "results"
    words = ["bench", "barn", "--worlds", str(file), "--results", str(results), "--processes", "1"]
    assert main([*words, "--last", "7", "--json", str(scores)]) == 0
    first = json.loads(scores.read_text())
    assert (first["worlds"], first["reached"], first["score"], first["strict_score"]) == (1, 1, 0.25, 0.5)
    assert first["results"][0]["time_s"] < 2.0 * first["results"][0]["optimal_time_s"]
    capsys.readouterr()
    assert main([*words, "--json", str(scores)]) == 1
    written = capsys.readouterr()
    assert "1 of 2 runs are there already" in written.err
    assert "reached 1 of 2, touched something in 1" in written.out
    both = json.loads(scores.read_text())
    assert both["results"][0] == first["results"][0]
    assert both["score"] == pytest.approx(0.125)
    assert not both["results"][1]["success"]
    assert (results / "failures" / "barn-008" / "failure.png").stat().st_size > 1000
