"""Messages of grinding: forces, joints, the height field as a coloured cloud, and the disc."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import TransformStamped, WrenchStamped
from numpy.typing import NDArray
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

from daidalos.common.pose3 import Pose
from daidalos.industry.grinding.height_field import Workpiece
from daidalos.industry.grinding.pictures import deviation_colors

MAX_POINTS = 60_000
_LOOK = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4")])


def wrench_message(force: float, header: Header) -> WrenchStamped:
    """Return a force along z of the frame [N]."""
    message = WrenchStamped(header=header)
    message.wrench.force.z = force
    return message


def joint_message(
    names: Sequence[str], header: Header, position: Sequence[float], velocity: Sequence[float] = (),
    effort: Sequence[float] = (),
) -> JointState:  # fmt: skip
    """Return positions [m or rad], speeds and efforts of joints."""
    return JointState(
        header=header, name=list(names), position=list(position), velocity=list(velocity), effort=list(effort)
    )


def transform_message(pose: Pose, child: str, header: Header) -> TransformStamped:
    """Return the pose of a child frame."""
    message = TransformStamped(header=header, child_frame_id=child)
    shift, turn = message.transform.translation, message.transform.rotation
    shift.x, shift.y, shift.z = pose.position
    turn.x, turn.y, turn.z, turn.w = pose.orientation
    return message


def field_message(piece: Workpiece, surface: NDArray[np.float64], span: float, header: Header) -> PointCloud2:
    """Return a surface (rows, columns) as points coloured by their deviation, blue at -span and red at span [m]."""
    every = math.ceil(math.sqrt(surface.size / MAX_POINTS))
    heights = surface[::every, ::every]
    points = np.empty(heights.shape, _LOOK)
    points["x"], points["y"] = np.meshgrid(piece.x[::every], piece.y[::every])
    points["z"] = heights
    colors = deviation_colors(heights - piece.target[::every, ::every], span).astype(np.uint32)
    colors[~piece.region[::every, ::every]] = 150
    points["rgb"] = (colors[..., 0] << 16) | (colors[..., 1] << 8) | colors[..., 2]
    fields = [
        PointField(name=name, offset=4 * place, datatype=kind, count=1)
        for place, (name, kind) in enumerate(
            [
                ("x", PointField.FLOAT32),
                ("y", PointField.FLOAT32),
                ("z", PointField.FLOAT32),
                ("rgb", PointField.UINT32),
            ]
        )
    ]
    return PointCloud2(
        header=header, height=1, width=points.size, fields=fields, is_bigendian=False, point_step=_LOOK.itemsize,
        row_step=points.nbytes, data=points.tobytes(), is_dense=True,
    )  # fmt: skip


def disc_marker(place: Sequence[float], axis: NDArray[np.float64], radius: float, color: Any, header: Header) -> Marker:
    """Return the disc as a flat cylinder at a place [m] about an axis (3,)."""
    marker = Marker(header=header, ns="disc", type=Marker.CYLINDER, action=Marker.ADD, color=ColorRGBA(**color))
    marker.pose.position.x, marker.pose.position.y, marker.pose.position.z = (float(one) for one in place)
    # The shortest turn from z to the axis.
    turn = np.array([-axis[1], axis[0], 0.0, 1.0 + axis[2]])
    turn /= np.linalg.norm(turn)
    orientation = marker.pose.orientation
    orientation.x, orientation.y, orientation.z, orientation.w = (float(one) for one in turn)
    marker.scale.x = marker.scale.y = 2.0 * radius
    marker.scale.z = 0.006
    return marker
