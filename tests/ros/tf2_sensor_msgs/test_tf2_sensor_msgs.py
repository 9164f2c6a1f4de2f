"""Transformed clouds against scipy; what is not a coordinate stays as it is."""

import numpy as np
import pytest
from geometry_msgs.msg import TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs_py.point_cloud2 import create_cloud, create_cloud_xyz32, read_points, read_points_numpy
from std_msgs.msg import Header
from tf2_ros import Buffer
from tf2_sensor_msgs import do_transform_cloud, transform_points

from ros.transforms import SECOND, matrix_of, quaternions, stamp, transform, vectors

transforms = st.builds(lambda xyz, xyzw: transform("a", "b", 7, xyz, xyzw), vectors, quaternions)
points = hnp.arrays(np.float64, st.tuples(st.integers(0, 6), st.just(3)), elements=st.floats(-10, 10))
FLOAT = PointField.FLOAT32
BY = transform("a", "b", SECOND, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


def expected(values: np.ndarray, by: TransformStamped) -> np.ndarray:
    return values @ matrix_of(by)[:3, :3].T + matrix_of(by)[:3, 3]


@given(transforms, points)
def test_points(by: TransformStamped, values: np.ndarray) -> None:
    for one in (by, by.transform):
        np.testing.assert_allclose(transform_points(values, one), expected(values, by), atol=1e-12)
    assert transform_points(values.tolist() or np.zeros((0, 3)), by).shape == values.shape


@given(transforms, points)
def test_clouds(by: TransformStamped, values: np.ndarray) -> None:
    header = Header(stamp=stamp(3), frame_id="b")
    found = do_transform_cloud(create_cloud_xyz32(header, values), by)
    np.testing.assert_allclose(read_points_numpy(found), expected(values, by), atol=2e-5)
    assert found.header == Header(stamp=stamp(3), frame_id="a")


def test_a_bare_transform_names_no_frame() -> None:
    cloud = create_cloud_xyz32(Header(frame_id="b"), [(1.0, 2.0, 3.0)])
    found = do_transform_cloud(cloud, BY.transform)
    assert found.header.frame_id == "b"
    assert read_points(found).tolist() == [(2.0, -2.0, -3.0)]
    assert read_points(cloud).tolist() == [(1.0, 2.0, 3.0)]


def mixed(big: bool = False) -> PointCloud2:
    """Two rows of two points with gaps everywhere, coordinates of 64 bits in another order, and other fields."""
    order = ">" if big else "<"
    dtype = np.dtype(
        {
            "names": ["ring", "z", "x", "y", "intensity"],
            "formats": [f"{order}u2", f"{order}f8", f"{order}f8", f"{order}f8", f"{order}f4"],
            "offsets": [0, 8, 16, 24, 32],
            "itemsize": 40,
        }
    )
    rows = np.zeros((2, 88), np.uint8)
    for row in range(2):
        view = np.ndarray(2, dtype, rows[row])
        view["ring"], view["intensity"] = [row, 7], [0.5, row]
        view["x"], view["y"], view["z"] = [1, 4], [2, 5], [3 + 10 * row, 6]
        rows[row, 80:] = 0xEE
    codes = {"u2": PointField.UINT16, "f8": PointField.FLOAT64, "f4": FLOAT}
    return PointCloud2(
        header=Header(frame_id="b"),
        height=2,
        width=2,
        is_bigendian=big,
        is_dense=True,
        point_step=40,
        row_step=88,
        data=rows.tobytes(),
        fields=[
            PointField(name=name, offset=offset, datatype=codes[kind.str[1:]], count=1)
            for name, (kind, offset) in dtype.fields.items()
        ],
    )


@pytest.mark.parametrize("big", [False, True])
def test_everything_else_is_kept(big: bool) -> None:
    cloud = mixed(big)
    before = bytes(cloud.data)
    found = do_transform_cloud(cloud, BY)
    assert bytes(cloud.data) == before
    for name in ("height", "width", "fields", "is_bigendian", "is_dense", "point_step", "row_step"):
        assert getattr(found, name) == getattr(cloud, name)
    values = read_points(found)
    assert values["x"].tolist() == [2.0, 5.0, 2.0, 5.0]
    assert values["y"].tolist() == [-2.0, -5.0, -2.0, -5.0]
    assert values["z"].tolist() == [-3.0, -6.0, -13.0, -6.0]
    original = read_points(cloud)
    for name in ("ring", "intensity"):
        np.testing.assert_array_equal(values[name], original[name])
    assert bytes(found.data)[80:88] == b"\xee" * 8


def test_points_without_a_place_stay_without() -> None:
    found = do_transform_cloud(create_cloud_xyz32(Header(), [(float("nan"), 1.0, 2.0), (1.0, 2.0, 3.0)]), BY)
    assert np.isnan(read_points_numpy(found)[0]).any()
    assert read_points_numpy(found)[1].tolist() == [2.0, -2.0, -3.0]


def test_all_coordinates_are_needed() -> None:
    fields = [PointField(name=name, offset=4 * place, datatype=FLOAT, count=1) for place, name in enumerate("xy")]
    with pytest.raises(AssertionError, match="fields x, y, and z"):
        do_transform_cloud(create_cloud(Header(), fields, [(1.0, 2.0)]), BY)


def test_buffers_transform_clouds() -> None:
    buffer = Buffer()
    buffer.set_transform(BY, "me")
    cloud = create_cloud_xyz32(Header(stamp=stamp(SECOND), frame_id="b"), [(1.0, 2.0, 3.0)])
    found = buffer.transform(cloud, "a", new_type=PointCloud2)
    assert found.header.frame_id == "a"
    assert read_points(found).tolist() == [(2.0, -2.0, -3.0)]
