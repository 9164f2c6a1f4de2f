"""Images, calibrations, clouds and logical images as messages."""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.nodes.gazebo_ros._conversion import Outgoing, array_bytes, header, named
from daidalos.nodes.gazebo_ros._states import pose_message
from daidalos.samples import sensors as samples

_image_type = named("sensor_msgs", "Image")
_camera_info_type = named("sensor_msgs", "CameraInfo")
_points_type = named("sensor_msgs", "PointCloud2")
_logical_type = named("ros_gz_interfaces", "LogicalCameraImage")


def _image(sample: samples.ImageSample) -> Any:
    pixels = np.ascontiguousarray(sample.pixels)
    return _image_type()(
        header=header(sample),
        height=pixels.shape[0],
        width=pixels.shape[1],
        encoding=sample.encoding,
        is_bigendian=0,
        step=pixels.strides[0],
        data=array_bytes(pixels),
    )


def _camera_info(sample: samples.CameraInfoSample) -> Any:
    return _camera_info_type()(
        header=header(sample),
        height=sample.height,
        width=sample.width,
        distortion_model="plumb_bob",
        d=list(sample.distortion),
        k=sample.matrix.ravel(),
        r=np.eye(3).ravel(),
        p=sample.projection.ravel(),
    )


def _points(sample: samples.PointCloudSample) -> Any:
    from sensor_msgs.msg import PointField

    rows, columns = sample.points.shape[:2]
    extras = {"intensity": sample.intensities, "rgb": None if sample.colors is None else _packed(sample.colors)}
    bands = {"x": None, "y": None, "z": None} | {name: band for name, band in extras.items() if band is not None}
    buffer = np.empty((rows, columns, len(bands)), dtype=np.float32)
    buffer[:, :, :3] = sample.points
    for place, band in enumerate(bands.values()):
        if band is not None:
            buffer[:, :, place] = band
    fields = [
        PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
        for place, name in enumerate(bands)
    ]
    return _points_type()(
        header=header(sample),
        height=rows,
        width=columns,
        fields=fields,
        is_bigendian=False,
        point_step=4 * len(bands),
        row_step=4 * len(bands) * columns,
        data=array_bytes(buffer),
        is_dense=bool(np.isfinite(sample.points).all()),
    )


def _packed(colors: Any) -> Any:
    """Return colours as PCL packs them: three bytes in the bits of a float."""
    packed = np.zeros((*colors.shape[:2], 4), dtype=np.uint8)
    packed[:, :, :3] = colors[:, :, ::-1]
    return packed.view("<f4")[:, :, 0]


def _logical(sample: samples.LogicalImageSample) -> Any:
    from ros_gz_interfaces.msg import LogicalCameraImageModel

    models = [LogicalCameraImageModel(name=name, pose=pose_message(pose)) for name, pose in sample.models]
    return _logical_type()(header=header(sample), pose=pose_message(sample.pose), model=models)


IMAGES: dict[type[samples.Sample], Outgoing] = {
    samples.PointCloudSample: Outgoing(_points_type, _points),
    samples.ImageSample: Outgoing(_image_type, _image),
    samples.CameraInfoSample: Outgoing(_camera_info_type, _camera_info),
    samples.LogicalImageSample: Outgoing(_logical_type, _logical),
}
