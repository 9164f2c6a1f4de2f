import contextlib
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image

from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import load_map, save_map
from daidalos.mapping.pose_graph_file import load_pose_graph

GOOD = """\
image: room.pgm
mode: trinary
resolution: 0.05
origin: [-1.0, -2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""

shapes = array_shapes(min_dims=2, max_dims=2, max_side=12)
coordinate = st.floats(-1e4, 1e4)
origins = st.tuples(coordinate, coordinate, st.floats(-3.2, 3.2))


def write(folder: Path, fields: str = GOOD, image: bytes = b"P5\n2 2\n255\n\x00\xfe\xcd\x64") -> Path:
    (folder / "room.pgm").write_bytes(image)
    path = folder / "room.yaml"
    path.write_text(fields)
    return path


@given(arrays(np.int8, shapes, elements=st.sampled_from([-1, 0, 100])), st.floats(1e-3, 10.0), origins)
def test_trinary_maps_survive(
    tmp_path_factory: pytest.TempPathFactory, data: np.ndarray, resolution: float, origin: tuple[float, float, float]
) -> None:
    grid = OccupancyGrid(data, resolution, origin)
    path, _ = save_map(grid, tmp_path_factory.mktemp("map") / "room")
    loaded = load_map(path)
    assert np.array_equal(loaded.data, data)
    assert (loaded.resolution, loaded.origin) == (resolution, origin)


@given(arrays(np.int8, shapes, elements=st.integers(-1, 100)))
def test_raw_maps_survive(tmp_path_factory: pytest.TempPathFactory, data: np.ndarray) -> None:
    path, _ = save_map(OccupancyGrid(data, 0.05, (0, 0, 0)), tmp_path_factory.mktemp("map") / "room", "raw")
    assert np.array_equal(load_map(path).data, data)


@given(arrays(np.int8, shapes, elements=st.integers(0, 100)))
def test_scaled_maps_survive(tmp_path_factory: pytest.TempPathFactory, data: np.ndarray) -> None:
    path, _ = save_map(OccupancyGrid(data, 0.05, (0, 0, 0)), tmp_path_factory.mktemp("map") / "room", "scale")
    assert np.abs(load_map(path).data - data.astype(int)).max() <= 1


@given(st.binary(max_size=60))
def test_no_bytes_crash_the_image_reader(tmp_path_factory: pytest.TempPathFactory, image: bytes) -> None:
    path = write(tmp_path_factory.mktemp("map"), image=b"P5\n" + image)
    with contextlib.suppress(MapFileError):
        assert load_map(path).data.ndim == 2


@given(st.text(max_size=80))
def test_no_text_crashes_the_yaml_reader(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.mktemp("map") / "room.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(MapFileError, match=r"room\.yaml"):
        load_map(path)


def test_files_are_those_that_map_server_writes(tmp_path: Path) -> None:
    data = np.array([[0, 100], [-1, 0], [100, 100]], np.int8)
    yaml_path, image_path = save_map(OccupancyGrid(data, 0.05, (-1.0, 2.0, 0.0)), tmp_path / "my.map")
    assert image_path == tmp_path / "my.map.pgm"
    assert image_path.read_bytes() == b"P5\n2 3\n255\n" + bytes([0, 0, 205, 254, 254, 0])
    assert yaml.safe_load(yaml_path.read_text()) == {
        "image": "my.map.pgm",
        "mode": "trinary",
        "resolution": 0.05,
        "origin": [-1.0, 2.0, 0.0],
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    assert sorted(path.name for path in tmp_path.iterdir()) == ["my.map.pgm", "my.map.yaml"]


def test_thresholds_and_negation_decide(tmp_path: Path) -> None:
    assert load_map(write(tmp_path)).data.tolist() == [[-1, -1], [100, 0]]
    assert load_map(write(tmp_path, GOOD.replace("negate: 0", "negate: 1"))).data.tolist() == [[100, -1], [0, 100]]
    scaled = load_map(write(tmp_path, GOOD.replace("trinary", "scale"))).data
    share = (255 - 0x64) / 255
    assert scaled[0, 1] == round(100 * (share - 0.196) / (0.65 - 0.196))


def test_numbers_may_have_an_exponent_without_a_dot(tmp_path: Path) -> None:
    grid = load_map(write(tmp_path, GOOD.replace("0.05", "5e-2").replace("-2.0", "1e-05")))
    assert (grid.resolution, grid.origin[1]) == (0.05, 1e-5)


@pytest.mark.parametrize("image_format", ["pgm", "png", "bmp"])
@pytest.mark.parametrize("mode", ["trinary", "raw"])
def test_other_images_and_thresholds(tmp_path: Path, image_format: str, mode: str) -> None:
    data = np.array([[0, 30, 70], [-1, 50, 100]], np.int8)
    grid = OccupancyGrid(data, 0.05, (-1.0, 2.0, 0.0))
    path, image = save_map(
        grid, tmp_path / "room", mode, image_format=image_format, occupied_thresh=0.5, free_thresh=0.3
    )
    assert image.name == f"room.{image_format}"
    expected = data if mode == "raw" else [[0, 0, 100], [-1, 100, 100]]
    assert np.array_equal(load_map(path).data, expected)
    with pytest.raises(MapFileError, match=r"free_thresh < occupied_thresh <= 1, found 0\.5 and 0\.5"):
        save_map(grid, tmp_path / "room", occupied_thresh=0.5, free_thresh=0.5)


def test_unknown_cells_of_a_scaled_map_are_transparent(tmp_path: Path) -> None:
    data = np.array([[0, 30, 70], [-1, 50, 100]], np.int8)
    path, image = save_map(OccupancyGrid(data, 0.05, (0.0, 0.0, 0.0)), tmp_path / "room", "scale", image_format="png")
    assert np.abs(load_map(path).data - data).max() <= 1
    assert load_map(path).data[1, 0] == -1
    with Image.open(image) as read:
        assert read.mode == "LA"
        assert np.asarray(read)[0, :, 1].tolist() == [0, 255, 255]


def test_colours_are_read_as_grey(tmp_path: Path) -> None:
    pixels = np.array([[[255, 255, 255], [0, 0, 0]], [[0, 0, 0], [205, 205, 205]]], np.uint8)
    path = write(tmp_path, GOOD.replace("room.pgm", "room.png"))
    Image.fromarray(pixels).save(tmp_path / "room.png")
    assert load_map(path).data.tolist() == [[100, -1], [0, 100]]


def test_text_images_and_other_white_values_are_read(tmp_path: Path) -> None:
    image = b"P2 # by hand\n2 2\n# white\n100\n0 100\n80 40"
    assert load_map(write(tmp_path, image=image)).data.tolist() == [[-1, -1], [100, 0]]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("image: room.pgm\n", "", "room.yaml: image: missing"),
        ("room.pgm", "gone.pgm", "gone.pgm: No such file"),
        ("trinary", "binary", "room.yaml: mode: expected trinary, scale or raw, found 'binary'"),
        ("0.05", "-1", "room.yaml: resolution: expected metres per cell above 0, found -1"),
        ("0.05", "fine", "room.yaml: resolution: expected a number, found 'fine'"),
        ("0.05", ".inf", "room.yaml: resolution: expected a number"),
        ("[-1.0, -2.0, 0.0]", "[0, 0]", r"room.yaml: origin: expected \[x, y, yaw\]"),
        ("-2.0", "south", r"room.yaml: origin\[1\]: expected a number, found 'south'"),
        ("negate: 0", "negate: maybe", "room.yaml: negate: expected 0 or 1"),
        ("0.65", "1.5", "room.yaml: occupied_thresh: expected a number from 0 to 1"),
        ("0.196", "0.7", "room.yaml: free_thresh: expected less than occupied_thresh"),
        ("image:", "image: [", "room.yaml: not a YAML file"),
    ],
)
def test_bad_fields_are_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(MapFileError, match=message) as caught:
        load_map(write(tmp_path, GOOD.replace(old, new)))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (b"\x89PNG\r\n\x1a\n", "header: expected a PGM, PNG or BMP image"),
        (b"P5\n2 x\n255\n", "header: expected 'P5' or 'P2'"),
        (b"P5\n2 2\n65535\n", "header: expected a largest grey value from 1 to 255, found 65535"),
        (b"P5\n0 2\n255\n", "header: expected at least one pixel"),
        (b"P5\n2 2\n255\n\x00", "pixels: expected 2 x 2 = 4, found 1"),
        (b"P2\n2 2\n255\n1 2 3 x", "pixels: expected numbers"),
        (b"P2\n2 2\n255\n1 2 3 300", "pixels: expected numbers"),
    ],
)
def test_bad_images_are_named(tmp_path: Path, image: bytes, message: str) -> None:
    with pytest.raises(MapFileError, match=rf"room\.pgm: {message}"):
        load_map(write(tmp_path, image=image))


def test_a_missing_map_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapFileError, match=r"gone\.yaml: No such file"):
        load_map(tmp_path / "gone.yaml")


def test_what_can_not_be_written_leaves_the_old_files(tmp_path: Path) -> None:
    grid = OccupancyGrid(np.zeros((2, 2), np.int8), 0.05, (0, 0, 0))
    save_map(grid, tmp_path / "room")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(MapFileError, match="scale cannot hold unknown cells"):
        save_map(OccupancyGrid(np.full((2, 2), -1, np.int8), 0.05, (0, 0, 0)), tmp_path / "room", "scale")
    with pytest.raises(MapFileError, match="no cells"):
        save_map(OccupancyGrid(np.zeros((0, 0), np.int8), 0.05, (0, 0, 0)), tmp_path / "room")
    with pytest.raises(MapFileError, match="No such file"):
        save_map(grid, tmp_path / "nowhere" / "room")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    (tmp_path / "folder.yaml").mkdir()
    with pytest.raises(MapFileError, match=r"folder\.yaml: is a folder"):
        save_map(grid, tmp_path / "folder")
    assert not (tmp_path / "folder.pgm").exists()


@pytest.mark.parametrize("name", ["a\0b", "x" * 300, "x/" * 3_000 + "x", "\ud800"])
def test_a_name_that_no_file_can_have_is_refused(tmp_path: Path, name: str) -> None:
    grid = OccupancyGrid(np.zeros((2, 2), np.int8), 0.05, (0.0, 0.0, 0.0))
    for use in (load_map, lambda path: save_map(grid, path), load_pose_graph):
        with pytest.raises(MapFileError):
            use(tmp_path / name)
