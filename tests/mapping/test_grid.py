import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.mapping.grid import FREE, OCCUPIED, UNKNOWN, ScanGrid
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from properties import examples

from .worlds import arena, raster, room_scan

coordinate = st.floats(-3.0, 3.0)


def beam(end: tuple[float, float], *, hit: bool = True, origin: tuple[float, float] = (0.0, 0.0)) -> Cloud:
    none, some = np.empty((0, 2)), np.array([end], dtype=np.float64)
    return Cloud(none, none, some if hit else none, none if hit else some, np.array(origin))


def states(grid: ScanGrid, **options: float) -> dict[tuple[int, int], int]:
    """State by column and row of every known cell."""
    found = grid.classify(**options)
    column, row = (round(value / found.resolution) for value in found.origin[:2])
    known = np.argwhere(found.data != UNKNOWN)
    return {(int(c) + column, int(r) + row): int(found.data[r, c]) for r, c in known}


def test_a_beam_frees_its_way_and_occupies_its_end() -> None:
    grid = ScanGrid(1.0)
    grid.add(beam((3.5, 0.0), origin=(0.5, 0.0)), np.array([0.0, 0.5, 0.0]))
    assert states(grid, min_pass_through=1) == {(0, 0): FREE, (1, 0): FREE, (2, 0): FREE, (3, 0): OCCUPIED}


def test_a_beam_that_is_too_long_only_frees() -> None:
    grid = ScanGrid(1.0)
    grid.add(beam((2.0, 0.0), hit=False), np.array([0.5, 0.5, np.pi / 2]))
    assert states(grid, min_pass_through=1) == {(0, 0): FREE, (0, 1): FREE, (0, 2): FREE}


@examples(200)
@given(st.tuples(coordinate, coordinate), st.tuples(coordinate, coordinate), st.floats(-4.0, 4.0))
def test_the_cells_of_a_beam_are_those_that_its_line_crosses(
    origin: tuple[float, float], end: tuple[float, float], yaw: float
) -> None:
    """Twin: cut the beam at every border between cells and look at the middles of the pieces."""
    pose = np.array([0.3, -0.7, yaw])
    grid = ScanGrid(0.25)
    grid.add(beam(end, origin=origin), pose)
    rotation = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    start, stop = (rotation @ np.array(point) + pose[:2] for point in (origin, end))
    cuts = [0.0, 1.0]
    for axis in (0, 1):
        low, high = sorted((start[axis] / 0.25, stop[axis] / 0.25))
        if high - low > 1e-9:
            borders = np.arange(np.ceil(low), np.floor(high) + 1) * 0.25
            cuts += list((borders - start[axis]) / (stop[axis] - start[axis]))
    cuts = np.unique(np.clip(cuts, 0.0, 1.0))
    wide = np.flatnonzero(np.diff(cuts) > 1e-7)
    middles = start + (0.5 * (cuts[wide] + cuts[wide + 1]))[:, None] * (stop - start)
    expected = {(int(x), int(y)) for x, y in np.floor(middles / 0.25)}
    found = states(grid, min_pass_through=1)
    assert expected <= set(found)
    last = tuple(int(value) for value in np.floor(stop / 0.25))
    assert found[last] == OCCUPIED
    # A beam through a corner may step around it by either neighbour.
    assert (
        len(found) == abs(last[0] - int(np.floor(start[0] / 0.25))) + abs(last[1] - int(np.floor(start[1] / 0.25))) + 1
    )


def test_a_removed_scan_leaves_no_trace() -> None:
    grid = ScanGrid(0.05)
    clouds = [to_cloud(room_scan([x, -0.5, 0.3], noise=0.01, seed=k), 20.0) for k, x in enumerate((0.0, 0.4))]
    poses = np.array([[0.0, -0.5, 0.3], [0.4, -0.5, 0.3]])
    grid.add(clouds[0], poses[0])
    before = grid.classify(min_pass_through=1)
    grid.add(clouds[1], poses[1])
    assert not np.array_equal(grid.classify(min_pass_through=1).data, before.data)
    grid.remove(clouds[1], poses[1])
    after = grid.classify(min_pass_through=1)
    rows, columns = before.data.shape
    down, left = (round((b - a) / 0.05) for a, b in zip(after.origin[1::-1], before.origin[1::-1], strict=True))
    assert np.array_equal(after.data[down : down + rows, left : left + columns], before.data)
    assert np.count_nonzero(after.data != UNKNOWN) == np.count_nonzero(before.data != UNKNOWN)


def test_the_grid_grows_in_every_direction_and_forgets_nothing() -> None:
    grid = ScanGrid(0.1)
    ends = [(5.0, 0.0), (-40.0, 0.0), (0.0, 35.0), (0.0, -50.0), (60.0, 60.0)]
    for end in ends:
        grid.add(beam(end), np.array([0.05, 0.05, 0.0]))
    found = states(grid, min_pass_through=1)
    for x, y in ends:
        assert found[(int(np.floor((x + 0.05) / 0.1)), int(np.floor((y + 0.05) / 0.1)))] == OCCUPIED


def test_thresholds_decide_by_the_share_of_hits() -> None:
    grid = ScanGrid(1.0)
    for _ in range(3):
        grid.add(beam((2.0, 0.0)), np.array([0.5, 0.5, 0.0]))
    grid.add(beam((3.0, 0.0)), np.array([0.5, 0.5, 0.0]))
    assert states(grid, occupancy_threshold=0.5, min_pass_through=1)[(2, 0)] == OCCUPIED
    assert states(grid, occupancy_threshold=0.8, min_pass_through=1)[(2, 0)] == FREE
    assert (3, 0) not in states(grid, min_pass_through=2)


def test_an_empty_grid_has_no_cells() -> None:
    assert ScanGrid(0.05).classify().data.shape == (0, 0)


def test_scans_of_a_room_draw_its_walls() -> None:
    grid = ScanGrid(0.05)
    for x, y in [(0.0, -0.5), (-3.0, 2.0), (3.0, 0.5), (-0.5, -2.2)]:
        pose = np.array([x, y, 0.2])
        grid.add(to_cloud(room_scan(pose, beams=1500), 20.0), pose)
    found = grid.classify()
    truth = raster(arena(), 0.05)
    walls = np.argwhere(truth.data == OCCUPIED) * 0.05 + np.array(truth.origin[1::-1])
    occupied = np.argwhere(found.data == OCCUPIED) * 0.05 + np.array(found.origin[1::-1])
    apart = np.linalg.norm(walls[:, None] - occupied[None], axis=2)
    assert apart.min(axis=0).max() < 0.11
    assert np.mean(apart.min(axis=1) < 0.11) > 0.9


def test_the_free_part_of_a_room_is_free() -> None:
    grid = ScanGrid(0.05)
    scan = LaserScanData(np.full(720, 2.0), -np.pi, 2 * np.pi / 720)
    grid.add(to_cloud(scan, 20.0), np.zeros(3))
    found = grid.classify()
    y, x = (np.indices(found.data.shape) + 0.5) * 0.05 + np.array(found.origin[1::-1])[:, None, None]
    radius = np.hypot(x, y)
    assert np.all(found.data[radius < 1.5] == FREE)
    assert np.all(found.data[radius > 2.1] == UNKNOWN)
    assert found.data[(radius > 1.96) & (radius < 2.04)].max() == OCCUPIED
    assert found.origin == pytest.approx((-2.0, -2.0, 0.0), abs=0.051)
