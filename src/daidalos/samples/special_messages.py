"""Conversions that need more than field names: images, clouds, contacts and trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from daidalos.samples import controllers, sensors
from daidalos.samples.commands import PositionTrajectoryCommand
from daidalos.samples.conversion import nested_message
from daidalos.samples.fields import array_bytes, duration_message, header, nanoseconds, seconds, vector


def image(sample: sensors.ImageSample) -> Any:
    """Return a ``sensor_msgs/msg/Image``."""
    from sensor_msgs.msg import Image

    pixels = np.ascontiguousarray(sample.pixels)
    return Image(
        header=header(sample),
        height=pixels.shape[0],
        width=pixels.shape[1],
        encoding=sample.encoding,
        is_bigendian=0,
        step=pixels.strides[0],
        data=array_bytes(pixels),
    )


def point_cloud(sample: sensors.PointCloudSample) -> Any:
    """Return a ``sensor_msgs/msg/PointCloud2`` with x, y, z and, where they are known, ``intensity`` and ``rgb``."""
    from sensor_msgs.msg import PointCloud2, PointField

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
    return PointCloud2(
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


def navsat_status(sample: sensors.NavSatSample) -> Any:
    """Return a ``sensor_msgs/msg/NavSatStatus`` with a fix by GPS."""
    from sensor_msgs.msg import NavSatStatus

    return NavSatStatus(status=NavSatStatus.STATUS_FIX, service=NavSatStatus.SERVICE_GPS)


def models_seen(sample: sensors.LogicalImageSample) -> Any:
    """Return the models that a logical camera sees as ``ros_gz_interfaces/msg/LogicalCameraImageModel``."""
    from geometry_msgs.msg import Pose
    from ros_gz_interfaces.msg import LogicalCameraImageModel

    return [LogicalCameraImageModel(name=name, pose=nested_message(Pose, pose)) for name, pose in sample.models]


def contacts(sample: sensors.ContactsSample) -> Any:
    """Return the contacts as ``ros_gz_interfaces/msg/Contact``."""
    from geometry_msgs.msg import Wrench
    from ros_gz_interfaces.msg import Contact, Entity, JointWrench

    def entity(model: str, link: str, collision: str) -> Any:
        return Entity(name=f"{model}::{link}::{collision}", type=Entity.COLLISION)

    return [
        Contact(
            collision1=entity(contact.model1, contact.link1, contact.collision1),
            collision2=entity(contact.model2, contact.link2, contact.collision2),
            positions=[vector(row) for row in contact.positions],
            normals=[vector(row) for row in contact.normals],
            depths=contact.depths,
            wrenches=[
                JointWrench(body_1_wrench=Wrench(force=vector(-force)), body_2_wrench=Wrench(force=vector(force)))
                for force in contact.forces
            ],
        )
        for contact in sample.contacts
    ]


def contact_states(sample: sensors.BumperSample) -> Any:
    """Return the contacts as ``gazebo_msgs/msg/ContactState``."""
    from gazebo_msgs.msg import ContactState
    from geometry_msgs.msg import Wrench

    states = []
    for contact in sample.contacts:
        first = f"{contact.model1}::{contact.link1}::{contact.collision1}"
        second = f"{contact.model2}::{contact.link2}::{contact.collision2}"
        states.append(
            ContactState(
                info=f"{first} touches {second} at {sample.stamp_ns * 1e-9:.3f} s",
                collision1_name=first,
                collision2_name=second,
                wrenches=[Wrench(force=vector(-force)) for force in contact.forces],
                total_wrench=Wrench(force=vector(-np.sum(contact.forces, axis=0))),
                contact_positions=[vector(row) for row in contact.positions],
                contact_normals=[vector(row) for row in contact.normals],
                depths=contact.depths,
            )
        )
    return states


def interface_values(groups: Mapping[str, Mapping[str, float]]) -> Any:
    """Return values of interfaces, by group and name, as ``control_msgs/msg/InterfaceValue``."""
    from control_msgs.msg import InterfaceValue

    return [InterfaceValue(interface_names=list(values), values=list(values.values())) for values in groups.values()]


def interface_groups_of(message: Any) -> controllers.InterfaceGroupsCommand:
    """Return a ``control_msgs/msg/DynamicInterfaceGroupValues`` as a command."""
    values = tuple((tuple(one.interface_names), tuple(one.values)) for one in message.interface_values)
    return controllers.InterfaceGroupsCommand(tuple(message.interface_groups), values)


def trajectory_point(point: controllers.TrajectoryPoint) -> Any:
    """Return a ``trajectory_msgs/msg/JointTrajectoryPoint``."""
    from trajectory_msgs.msg import JointTrajectoryPoint

    rows: Mapping[str, Any] = {
        "positions": point.positions,
        "velocities": point.velocities,
        "accelerations": point.accelerations,
        "effort": point.efforts,
    }
    given = {name: values for name, values in rows.items() if values is not None}
    return JointTrajectoryPoint(time_from_start=duration_message(point.time), **given)


def trajectory_point_of(message: Any) -> controllers.TrajectoryPoint:
    """Return a ``trajectory_msgs/msg/JointTrajectoryPoint`` as a point; its empty fields are None."""

    def row(values: Any) -> Any:
        return np.array(values, dtype=np.float64) if len(values) else None

    return controllers.TrajectoryPoint(
        time=seconds(message.time_from_start),
        positions=row(message.positions),
        velocities=row(message.velocities),
        accelerations=row(message.accelerations),
        efforts=row(message.effort),
    )


def trajectory_of(message: Any) -> controllers.TrajectoryCommand:
    """Return a ``trajectory_msgs/msg/JointTrajectory`` as a command."""
    points = tuple(trajectory_point_of(point) for point in message.points)
    return controllers.TrajectoryCommand(tuple(message.joint_names), points, nanoseconds(message.header.stamp))


def position_trajectory_of(message: Any) -> PositionTrajectoryCommand:
    """Return those points of a ``trajectory_msgs/msg/JointTrajectory`` that have a position for every joint."""
    count = len(message.joint_names)
    points = [point for point in message.points if len(point.positions) == count]
    return PositionTrajectoryCommand(
        tuple(message.joint_names),
        np.array([seconds(point.time_from_start) for point in points]),
        np.array([list(point.positions) for point in points]).reshape(-1, count),
    )
