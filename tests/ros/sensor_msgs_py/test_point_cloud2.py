"""Point clouds as arrays: against struct, and there and back."""

import struct
from array import array

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from sensor_msgs.msg import Image, PointCloud2, PointField
from sensor_msgs_py import numpy_compat, point_cloud2
from std_msgs.msg import Header

CODES = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 8: "d"}
NAN = float("nan")


def fields(names: str = "xyz", datatype: int = PointField.FLOAT32, size: int = 4) -> list[PointField]:
    return [PointField(name=name, offset=place * size, datatype=datatype, count=1) for place, name in enumerate(names)]


def packed(points: list[tuple[float, ...]], big: bool = False) -> PointCloud2:
    """A cloud of x, y and z made by hand."""
    data = b"".join(struct.pack((">" if big else "<") + "3f", *point) for point in points)
    return PointCloud2(
        height=1, width=len(points), fields=fields(), is_bigendian=big, point_step=12, row_step=len(data), data=data
    )


POINTS = [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, NAN, 9.0), (10.0, 11.0, NAN)]


# Reading


@pytest.mark.parametrize("big", [False, True])
def test_read_points(big: bool) -> None:
    cloud = packed(POINTS, big)
    before = bytes(cloud.data)
    for _ in range(2):  # reading must not turn the bytes of the message around
        points = point_cloud2.read_points(cloud)
        assert points.dtype.names == ("x", "y", "z")
        assert points.dtype["x"].isnative
        np.testing.assert_array_equal(points["x"], [1, 4, 7, 10])
        np.testing.assert_array_equal(points["y"], [2, 5, NAN, 11])
    assert bytes(cloud.data) == before


def test_what_is_read_shows_the_message() -> None:
    cloud = packed(POINTS)
    point_cloud2.read_points(cloud)["z"] = 0.5
    assert struct.unpack_from("<3f", cloud.data, 12) == (4.0, 5.0, 0.5)


def test_some_fields_in_another_order() -> None:
    points = point_cloud2.read_points(packed(POINTS), field_names=["z", "x"])
    assert points.dtype.names == ("z", "x")
    assert points[0].tolist() == (3.0, 1.0)


def test_skip_nans_looks_at_the_fields_that_are_asked_for() -> None:
    cloud = packed(POINTS)
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 2
    assert len(point_cloud2.read_points(cloud, ["x", "y"], skip_nans=True)) == 3
    cloud.is_dense = True  # then there are none by definition
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 4


@pytest.mark.parametrize("uvs", [[0, 3], (0, 3), np.array([0, 3]), iter([0, 3])])
def test_uvs(uvs: object) -> None:
    assert point_cloud2.read_points(packed(POINTS), uvs=uvs)["x"].tolist() == [1.0, 10.0]
    assert point_cloud2.read_points(packed(POINTS), uvs=[1], skip_nans=True)["x"].tolist() == [4.0]


def test_read_points_numpy() -> None:
    points = point_cloud2.read_points_numpy(packed(POINTS), ["x", "z"], uvs=[0, 1])
    assert points.dtype == np.float32
    np.testing.assert_array_equal(points, [[1, 3], [4, 6]])


def test_read_points_numpy_needs_one_type() -> None:
    mixed = [*fields("xy"), PointField(name="ring", offset=8, datatype=PointField.UINT16, count=1)]
    cloud = point_cloud2.create_cloud(Header(), mixed, [(1.0, 2.0, 3)])
    with pytest.raises(AssertionError, match="same datatype"):
        point_cloud2.read_points_numpy(cloud)
    np.testing.assert_array_equal(point_cloud2.read_points_numpy(cloud, ["x", "y"]), [[1, 2]])


def test_read_points_list() -> None:
    points = point_cloud2.read_points_list(packed(POINTS), skip_nans=True)
    assert [point._asdict() for point in points] == [{"x": 1, "y": 2, "z": 3}, {"x": 4, "y": 5, "z": 6}]
    assert type(points[0]).__name__ == "Point"
    assert point_cloud2.read_points_list(packed(POINTS), ["y"], uvs=[0])[0].y == 2.0


@pytest.mark.parametrize(
    "read", [point_cloud2.read_points, point_cloud2.read_points_list], ids=["read_points", "read_points_list"]
)
def test_only_clouds_and_their_fields_can_be_read(read: object) -> None:
    with pytest.raises(AssertionError, match=r"(?i)cloud is not a sensor_msgs\.msg\.PointCloud2"):
        read(Image())
    with pytest.raises(AssertionError, match="Requests field is not in the fields"):
        read(packed(POINTS), ["x", "intensity"])


def test_too_little_data() -> None:
    cloud = packed(POINTS)
    cloud.width = 5
    with pytest.raises(ValueError, match="5 x 1 points of 12 bytes needs 60 bytes of data, not 48"):
        point_cloud2.read_points(cloud)


def test_an_empty_cloud() -> None:
    assert point_cloud2.read_points(packed([])).shape == (0,)
    assert point_cloud2.read_points_list(packed([])) == []
    assert point_cloud2.create_cloud_xyz32(Header(), []).width == 0


def test_gaps_between_points_and_rows() -> None:
    data = b"".join(struct.pack("<3fI", *POINTS[number], 99) + b"?" * (number % 2 * 4) for number in range(4))
    cloud = PointCloud2(height=2, width=2, fields=fields(), point_step=16, row_step=36, data=data)
    np.testing.assert_array_equal(point_cloud2.read_points(cloud)["x"], [1, 4, 7, 10])


# Data types


@pytest.mark.parametrize("datatype", CODES)
def test_every_data_type(datatype: int) -> None:
    code = CODES[datatype]
    size = struct.calcsize(code)
    cloud = PointCloud2(
        height=1,
        width=2,
        fields=fields("ab", datatype, size),
        point_step=2 * size,
        row_step=4 * size,
        data=struct.pack(f"<4{code}", 1, 2, 3, 4),
    )
    points = point_cloud2.read_points(cloud)
    assert points.dtype["a"] == np.dtype(code)
    assert points.tolist() == [(1, 2), (3, 4)]
    again = point_cloud2.create_cloud(Header(), cloud.fields, points)
    assert again.data == cloud.data
    assert again.point_step == 2 * size


def test_dtype_from_fields() -> None:
    described = [
        PointField(name="", offset=0, datatype=PointField.UINT8, count=1),
        PointField(name="xyz", offset=4, datatype=PointField.FLOAT32, count=3),
        PointField(name="t", offset=16, datatype=PointField.FLOAT64, count=1),
    ]
    dtype = point_cloud2.dtype_from_fields(described)
    assert dtype.names == ("unnamed_field_0", "xyz_0", "xyz_1", "xyz_2", "t")
    assert [dtype.fields[name][1] for name in dtype.names] == [0, 4, 8, 12, 16]
    assert dtype.itemsize == 24
    assert point_cloud2.dtype_from_fields(described, point_step=32).itemsize == 32


def test_fields_that_make_no_sense() -> None:
    with pytest.raises(AssertionError, match="Duplicate field names"):
        point_cloud2.dtype_from_fields(fields("xx"))
    with pytest.raises(AssertionError, match="count = 0"):
        point_cloud2.dtype_from_fields([PointField(name="x", datatype=7, count=0)])


# Writing


def test_create_cloud_xyz32() -> None:
    header = Header(frame_id="laser")
    cloud = point_cloud2.create_cloud_xyz32(header, POINTS)
    assert bytes(cloud.data) == bytes(packed(POINTS).data)
    assert (cloud.height, cloud.width, cloud.point_step, cloud.row_step) == (1, 4, 12, 48)
    assert cloud.header.frame_id == "laser"
    assert cloud.fields == fields()
    assert isinstance(cloud.data, array)
    assert not cloud.is_bigendian
    assert not cloud.is_dense


def test_points_of_every_form() -> None:
    expected = point_cloud2.create_cloud(Header(), fields(), POINTS)
    structured = np.array(POINTS, dtype=[(name, np.float32) for name in "xyz"])
    for points in (np.array(POINTS), [list(point) for point in POINTS], iter(POINTS), structured):
        assert point_cloud2.create_cloud(Header(), fields(), points) == expected


def test_mixed_types_need_names() -> None:
    mixed = [*fields("xy"), PointField(name="ring", offset=8, datatype=PointField.UINT16, count=1)]
    cloud = point_cloud2.create_cloud(Header(), mixed, [(1.5, 2.5, 7)])
    assert bytes(cloud.data) == struct.pack("<2fH", 1.5, 2.5, 7)
    with pytest.raises(AssertionError, match="same datatype"):
        point_cloud2.create_cloud(Header(), mixed, np.zeros((1, 3)))
    with pytest.raises(AssertionError, match="do not match"):
        point_cloud2.create_cloud(Header(), mixed, np.zeros(1, dtype=[("x", "f4"), ("y", "f4")]))


def test_point_step() -> None:
    cloud = point_cloud2.create_cloud(Header(), fields(), POINTS, point_step=16)
    assert (cloud.point_step, cloud.row_step, len(cloud.data)) == (16, 64, 64)
    np.testing.assert_array_equal(point_cloud2.read_points_numpy(cloud), np.array(POINTS, np.float32))


def test_organised_clouds_go_there_and_back() -> None:
    grid = np.arange(24, dtype=np.float32).reshape(4, 2, 3)
    cloud = point_cloud2.create_cloud_xyz32(Header(), grid)
    assert (cloud.width, cloud.height, cloud.row_step) == (4, 2, 48)
    np.testing.assert_array_equal(point_cloud2.read_points_numpy(cloud, reshape_organized_cloud=True), grid)
    assert point_cloud2.read_points(cloud).shape == (8,)
    with pytest.raises(AssertionError, match="Too many dimensions"):
        point_cloud2.create_cloud_xyz32(Header(), np.zeros((2, 2, 2, 3)))


@given(
    hnp.arrays(np.float32, st.tuples(st.integers(0, 5), st.just(3)), elements=st.floats(width=32)),
    st.integers(0, 3),
)
def test_any_points_go_there_and_back(points: np.ndarray, gap: int) -> None:
    cloud = point_cloud2.create_cloud(Header(), fields(), points, point_step=12 + gap)
    np.testing.assert_array_equal(point_cloud2.read_points_numpy(cloud), points)


# The names of older programs


def test_numpy_compat() -> None:
    structured = np.array([(1.0, 2.0), (3.0, 4.0)], dtype=[("a", "f4"), ("b", "f4")])
    plain = numpy_compat.structured_to_unstructured(structured)
    np.testing.assert_array_equal(plain, [[1, 2], [3, 4]])
    again = numpy_compat.unstructured_to_structured(plain, dtype=structured.dtype)
    np.testing.assert_array_equal(again, structured)
