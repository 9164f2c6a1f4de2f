from pathlib import Path

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.errors import RelationsError
from daidalos.mapping.evaluation import (
    Relations,
    aligned,
    compare_with_truth,
    poses_at,
    read_relations,
    relation_errors,
)
from daidalos.mapping.grid import OccupancyGrid

SECOND = 10**9


def test_relations_are_read_to_the_nanosecond(tmp_path: Path) -> None:
    file = tmp_path / "log.relations"
    file.write_text("# comment\n976052905.167303 976052911.8 0.5 -0.25 0 0 0 -1.5\n\n1 2 0 0 0 0 0 0\n")
    relations = read_relations(file)
    assert relations.stamps_ns.tolist() == [[976052905167303000, 976052911800000000], [SECOND, 2 * SECOND]]
    assert relations.poses[0] == pytest.approx([0.5, -0.25, -1.5])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("1 2 0 0 0 0 0 0\n1 2 3\n", "x.relations:2: expected eight numbers"),
        ("1 2 0 0 0 0 0 zero\n", "x.relations:1: expected eight numbers"),
        ("1 2 0 nan 0 0 0 0\n", "x.relations:1: expected finite numbers"),
        ("", "x.relations: no relations"),
        ("é", "x.relations: not a text file"),
    ],
)
def test_bad_relations_are_named_by_line(tmp_path: Path, content: str, message: str) -> None:
    file = tmp_path / "x.relations"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(RelationsError, match=message):
        read_relations(file)


def test_missing_relations_are_named(tmp_path: Path) -> None:
    with pytest.raises(RelationsError, match=r"gone\.relations: No such file"):
        read_relations(tmp_path / "gone.relations")


def test_the_truth_has_no_error_in_any_frame() -> None:
    rng = np.random.default_rng(0)
    stamps = np.arange(20) * SECOND
    poses = rng.uniform(-3.0, 3.0, (20, 3))
    pairs = rng.integers(0, 20, (50, 2))
    truth = Relations(stamps[pairs], pose2.between(poses[pairs[:, 0]], poses[pairs[:, 1]]))
    moved = pose2.compose((5.0, -2.0, 1.0), poses)
    errors = relation_errors(stamps, moved, truth)
    assert errors.translation.max() < 1e-9
    assert errors.rotation.max() < 1e-9


def test_errors_are_those_of_the_closed_form() -> None:
    """Two metres believed to be three, and a turn of 0.1 rad that was none."""
    stamps = np.array([0, SECOND])
    truth = Relations(np.array([[0, SECOND]]), np.array([[2.0, 0.0, 0.0]]))
    errors = relation_errors(stamps, np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.1]]), truth)
    assert errors.translation == pytest.approx([1.0])
    assert errors.rotation == pytest.approx([0.1])
    assert errors.summary()["rotation_mean_deg"] == pytest.approx(np.degrees(0.1))
    assert "translation 1.0000 +- 0.0000 m" in str(errors)


def test_relations_of_another_log_are_refused() -> None:
    with pytest.raises(ValueError, match="belong to another log"):
        relation_errors(
            np.array([0, SECOND]), np.zeros((2, 3)), Relations(np.array([[50 * SECOND, 51 * SECOND]]), np.zeros((1, 3)))
        )


def test_poses_between_stamps_are_interpolated_and_held_at_the_ends() -> None:
    stamps = np.array([0, SECOND, SECOND, 3 * SECOND])
    poses = np.array([[0.0, 0.0, 3.0], [1.0, 0.0, -3.0], [1.0, 0.0, -3.0], [3.0, 2.0, -3.0]])
    times = np.array([-SECOND, SECOND // 2, 2 * SECOND, 9 * SECOND])
    found = poses_at(stamps, poses, times)
    assert found[0] == pytest.approx(poses[0])
    assert abs(found[1, 2]) == pytest.approx(np.pi)
    assert found[2] == pytest.approx([2.0, 1.0, -3.0])
    assert found[3] == pytest.approx(poses[3])
    assert poses_at(stamps[:1], poses[:1], times) == pytest.approx(np.repeat(poses[:1], 4, axis=0))


def test_the_trajectory_error_does_not_see_the_frame() -> None:
    rng = np.random.default_rng(1)
    true = rng.uniform(-5.0, 5.0, (100, 3))
    moved = pose2.compose((3.0, 4.0, 2.0), true)
    assert aligned(moved, true)[:, :2] == pytest.approx(true[:, :2], abs=1e-9)
    assert pose2.between(true, aligned(moved, true))[:, 2] == pytest.approx(np.zeros(100), abs=1e-9)


def grid_with(cells: list[tuple[int, int]], origin: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> OccupancyGrid:
    data = np.zeros((20, 20), np.int8)
    for row, column in cells:
        data[row, column] = 100
    return OccupancyGrid(data, 0.1, origin)


def test_walls_count_as_found_within_two_cells() -> None:
    truth = grid_with([(5, 5), (5, 6), (15, 15)])
    mapped = grid_with([(5, 7), (15, 18), (0, 0)])
    agreement = compare_with_truth(mapped, truth)
    assert agreement.walls_found == pytest.approx(2 / 3)
    assert agreement.walls_true == pytest.approx(1 / 3)


def test_maps_are_compared_in_the_frame_of_the_truth() -> None:
    truth = grid_with([(5, 5), (8, 3)])
    turned = grid_with([(5, 5), (8, 3)], origin=(1.0, 2.0, 0.0))
    assert compare_with_truth(turned, truth).walls_true == 0.0
    assert compare_with_truth(turned, truth, map_pose=(-1.0, -2.0, 0.0)).walls_true == 1.0
    quarter = grid_with([(5, 5), (8, 3)], origin=(0.0, 0.0, np.pi / 2))
    assert compare_with_truth(quarter, truth, map_pose=(0.0, 0.0, -np.pi / 2)).walls_found == 1.0


def test_an_empty_map_finds_nothing() -> None:
    assert compare_with_truth(grid_with([]), grid_with([(1, 1)])).walls_found == 0.0
