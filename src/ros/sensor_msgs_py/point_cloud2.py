"""Point clouds as arrays, and arrays as point clouds.

Organized clouds are arrays of shape (width, height) here, as they are in ROS 2's own package: that what one program
writes another one reads the same way matters more than which axis comes first.
"""

from __future__ import annotations

import sys
from array import array
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from numpy.typing import ArrayLike, NDArray
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

DUMMY_FIELD_PREFIX = "unnamed_field"
_BIG_ENDIAN = sys.byteorder == "big"
_DATATYPES: dict[int, np.dtype[Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | NDArray[np.integer[Any]] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return a cloud's points as a structured array; where it can be, it is a view of the message's data.

    Parameters
    ----------
    cloud
        The cloud.
    field_names
        Which fields, in which order; all where None.
    skip_nans
        Whether to leave out points with a NaN in one of these fields.
    uvs
        Indices of the points to return (after leaving out); all where None.
    reshape_organized_cloud
        Whether the result has the shape (width, height) where the height exceeds one.

    Raises
    ------
    AssertionError
        When it is not a point cloud, or has no such field.
    ValueError
        When it holds less data than it says.
    """
    assert isinstance(cloud, PointCloud2), "Cloud is not a sensor_msgs.msg.PointCloud2"
    points: NDArray[Any] = view_points(cloud).reshape(-1)
    if field_names is not None:
        assert set(field_names) <= set(points.dtype.names or ()), (
            "Requests field is not in the fields of the PointCloud!"
        )
        points = points[list(field_names)]
    if cloud.is_bigendian != _BIG_ENDIAN:
        points = points.astype(points.dtype.newbyteorder("="))
    if skip_nans and not cloud.is_dense:
        complete = np.ones(len(points), dtype=bool)
        for name in points.dtype.names or ():
            complete &= ~np.isnan(points[name])
        points = points[complete]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def view_points(cloud: PointCloud2) -> NDArray[Any]:
    """Return a cloud's points as a structured array that shows, and changes, the message's data.

    Returns
    -------
    array of shape (height, width)
        In the byte order of the message.

    Raises
    ------
    ValueError
        When the cloud holds less data than it says.
    """
    dtype = dtype_from_fields(cloud.fields, cloud.point_step).newbyteorder(">" if cloud.is_bigendian else "<")
    packed_row = cloud.width * cloud.point_step
    row = cloud.row_step if cloud.height > 1 and cloud.row_step > packed_row else packed_row
    needed = row * (cloud.height - 1) + packed_row if cloud.height else 0
    if len(cloud.data) < needed:
        raise ValueError(
            f"a cloud of {cloud.width} x {cloud.height} points of {cloud.point_step} bytes needs {needed} bytes of "
            f"data, not {len(cloud.data)}"
        )
    shape = (cloud.height, cloud.width)
    return np.ndarray(shape, dtype, cloud.data if needed else None, strides=(row, cloud.point_step))


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | NDArray[np.integer[Any]] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return a cloud's points as a plain array with the fields along the last axis.

    Parameters
    ----------
    cloud, field_names, skip_nans, uvs, reshape_organized_cloud
        As in `read_points`.

    Raises
    ------
    AssertionError
        When the fields are not of the same type.
    """
    wanted = [field for field in cloud.fields if field_names is None or _name_in(field, field_names)]
    assert len({field.datatype for field in wanted}) <= 1, (
        "All fields need to have the same datatype. Use `read_points()` otherwise."
    )
    return structured_to_unstructured(read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud))


def _name_in(field: PointField, names: Sequence[str]) -> bool:
    return field.name in names or any(f"{field.name}_{number}" in names for number in range(field.count))


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | NDArray[np.integer[Any]] | None = None,
) -> list[Any]:
    """Return a cloud's points as a list of named tuples; `read_points` is much faster.

    Parameters
    ----------
    cloud, field_names, skip_nans, uvs
        As in `read_points`.
    """
    assert isinstance(cloud, PointCloud2), "cloud is not a sensor_msgs.msg.PointCloud2"
    points = read_points(cloud, field_names, skip_nans, uvs)
    names = list(points.dtype.names or ())
    point: Any = namedtuple("Point", names, rename=True)  # type: ignore[misc]
    return [point._make(values) for values in points.tolist()]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype[Any]:
    """Return the structured data type of points.

    Parameters
    ----------
    fields
        A field with a count above one becomes that many, named ``name_0``, ``name_1`` ...; one without a name is
        called after its place.
    point_step
        Bytes from one point to the next; as much as the fields need where None.

    Raises
    ------
    AssertionError
        For a count of zero, and when two fields have the same name.
    """
    names: list[str] = []
    offsets: list[int] = []
    formats: list[str] = []
    for place, field in enumerate(fields):
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{place}"
        datatype = _DATATYPES[field.datatype]
        assert field.count > 0, "Can't process fields with count = 0."
        for number in range(field.count):
            part = f"{name}_{number}" if field.count > 1 else name
            assert part not in names, "Duplicate field names are not allowed!"
            names.append(part)
            offsets.append(field.offset + number * datatype.itemsize)
            formats.append(datatype.str)
    description: dict[str, Any] = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        description["itemsize"] = point_step
    dtype: np.dtype[Any] = np.dtype(description)  # type: ignore[call-overload]
    return dtype


def create_cloud(
    header: Header, fields: Sequence[PointField], points: ArrayLike | Iterable[Any], point_step: int | None = None
) -> PointCloud2:
    """Return a cloud.

    Parameters
    ----------
    header
        Its header.
    fields
        Its fields.
    points
        A structured array with just these fields; a plain array with the fields along its last axis, if they are of
        one type; or any iterable of points that are iterables of values. An organized cloud has one more axis.
    point_step
        Bytes from one point to the next; as much as the fields need where None.

    Raises
    ------
    AssertionError
        When points and fields do not fit.
    """
    dtype = dtype_from_fields(fields, point_step)
    if not isinstance(points, np.ndarray):
        points = np.array(list(map(tuple, points)), dtype=dtype)  # type: ignore[arg-type]
    elif points.dtype.names is None:
        assert len({field.datatype for field in fields}) <= 1, (
            "All fields need to have the same datatype. Pass a structured NumPy array with multiple dtypes otherwise."
        )
        points = unstructured_to_structured(points, dtype=dtype)
    else:
        assert points.dtype == dtype, (
            "PointFields and structured NumPy array dtype do not match for all fields! "
            "Check their field order, names and types."
        )
    assert points.ndim <= 2, (
        "Too many dimensions for organized cloud! Points can only be organized in max. two dimensional space"
    )
    width = points.shape[0]
    data = array("B")
    data.frombytes(np.ascontiguousarray(points).tobytes())
    return PointCloud2(
        header=header,
        height=points.shape[1] if points.ndim == 2 else 1,
        width=width,
        is_dense=False,
        is_bigendian=_BIG_ENDIAN,
        fields=list(fields),
        point_step=dtype.itemsize,
        row_step=dtype.itemsize * width,
        data=data,
    )


def create_cloud_xyz32(header: Header, points: ArrayLike | Iterable[Any]) -> PointCloud2:
    """Return a cloud with the fields x, y and z of 32 bits each; see `create_cloud`."""
    fields = [
        PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
        for place, name in enumerate("xyz")
    ]
    return create_cloud(header, fields, points)
