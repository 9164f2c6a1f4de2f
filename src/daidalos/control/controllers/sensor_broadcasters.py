"""Sensor broadcasters: IMU, force-torque, range and pose."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.common.pose3 import Pose, multiply
from daidalos.common.rate_gate import RateGate
from daidalos.control.contracts import Controller
from daidalos.control.interfaces import Interfaces
from daidalos.samples.controllers import PoseSample, VariedRangeSample
from daidalos.samples.sensors import (
    ImuSample,
    Sample,
    TransformSample,
    WrenchSample,
)

_NINE = (0.0,) * 9
_POSE = ("position.x", "position.y", "position.z", "orientation.x", "orientation.y", "orientation.z", "orientation.w")
_IMU = (
    *(f"orientation.{axis}" for axis in "xyzw"),
    *(f"angular_velocity.{axis}" for axis in "xyz"),
    *(f"linear_acceleration.{axis}" for axis in "xyz"),
)


@dataclass(frozen=True)
class RotationOffset(Parameters):
    """Rotation offset of an orientation."""

    roll: float = parameter(0.0, "Roll.", unit="rad", read_only=True)
    pitch: float = parameter(0.0, "Pitch.", unit="rad", read_only=True)
    yaw: float = parameter(0.0, "Yaw.", unit="rad", read_only=True)


@dataclass(frozen=True)
class ImuParameters(Parameters):
    """Parameters of the broadcaster of IMUs, as ROS names them."""

    sensor_name: str = parameter("", "Name of the sensor in its interfaces.", not_empty=True, read_only=True)
    frame_id: str = parameter("", "Frame of the sensor.", not_empty=True, read_only=True)
    static_covariance_orientation: tuple[float, ...] = parameter(
        _NINE, "Covariance of the orientation, row by row.", unit="rad^2", length=9, read_only=True
    )
    static_covariance_angular_velocity: tuple[float, ...] = parameter(
        _NINE, "Covariance of the angular velocity, row by row.", unit="(rad/s)^2", length=9, read_only=True
    )
    static_covariance_linear_acceleration: tuple[float, ...] = parameter(
        _NINE, "Covariance of the linear acceleration, row by row.", unit="(m/s^2)^2", length=9, read_only=True
    )
    rotation_offset: RotationOffset = group(RotationOffset)


class ImuSensorBroadcaster(Controller):
    """Broadcaster of ``~/imu``."""

    names = ("imu_sensor_broadcaster/IMUSensorBroadcaster",)
    Parameters = ImuParameters
    parameters: ImuParameters

    def configure(self) -> None:
        """Set the names of the sensor's interfaces."""
        self.state_names = tuple(f"{self.parameters.sensor_name}/{name}" for name in _IMU)
        turn = self.parameters.rotation_offset
        self._turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (turn.roll, turn.pitch, turn.yaw)).orientation

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of the sensor."""
        return {"~/imu": ImuSample}

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Publish what the IMU measures."""
        values = self.states.read()
        x, y, z, w = (float(value) for value in values[:4])
        yield ImuSample(
            stamp_ns=now_ns,
            topic="~/imu",
            frame_id=self.parameters.frame_id,
            orientation=np.array(multiply(self._turn, (x, y, z, w))),
            angular_velocity=values[4:7],
            linear_acceleration=values[7:10],
            orientation_covariance=np.array(self.parameters.static_covariance_orientation),
            angular_velocity_covariance=np.array(self.parameters.static_covariance_angular_velocity),
            linear_acceleration_covariance=np.array(self.parameters.static_covariance_linear_acceleration),
        )


@dataclass(frozen=True)
class AxisNames(Parameters):
    """Interface names of three axes; empty for none."""

    x: str = parameter("", "Full name of the interface of the x axis; empty for none.", read_only=True)
    y: str = parameter("", "Full name of the interface of the y axis; empty for none.", read_only=True)
    z: str = parameter("", "Full name of the interface of the z axis; empty for none.", read_only=True)


@dataclass(frozen=True)
class WrenchNames(Parameters):
    """Full interface names of a force-torque sensor."""

    force: AxisNames = group(AxisNames)
    torque: AxisNames = group(AxisNames)


@dataclass(frozen=True)
class AxisOffsets(Parameters):
    """Offsets of three axes."""

    x: float = parameter(0.0, "Added along x.", unit="N or N m")
    y: float = parameter(0.0, "Added along y.", unit="N or N m")
    z: float = parameter(0.0, "Added along z.", unit="N or N m")


@dataclass(frozen=True)
class WrenchOffsets(Parameters):
    """Offsets of force and torque."""

    force: AxisOffsets = group(AxisOffsets)
    torque: AxisOffsets = group(AxisOffsets)


@dataclass(frozen=True)
class AxisFactors(Parameters):
    """Factors of three axes."""

    x: float = parameter(1.0, "Factor along x.")
    y: float = parameter(1.0, "Factor along y.")
    z: float = parameter(1.0, "Factor along z.")


@dataclass(frozen=True)
class WrenchFactors(Parameters):
    """Factors of force and torque, applied after the offsets."""

    force: AxisFactors = group(AxisFactors)
    torque: AxisFactors = group(AxisFactors)


@dataclass(frozen=True)
class ForceTorqueParameters(Parameters):
    """Parameters of the broadcaster of force-torque sensors, as ROS names them."""

    sensor_name: str = parameter(
        "", "Name of a sensor with all six interfaces; empty where interface_names are given.", read_only=True
    )
    interface_names: WrenchNames = group(WrenchNames)
    frame_id: str = parameter("", "Frame of the sensor.", not_empty=True, read_only=True)
    offset: WrenchOffsets = group(WrenchOffsets)
    multiplier: WrenchFactors = group(WrenchFactors)

    @property
    def given(self) -> tuple[str, ...]:
        """Names of the six interfaces; empty where none is given."""
        names = self.interface_names
        return (names.force.x, names.force.y, names.force.z, names.torque.x, names.torque.y, names.torque.z)

    def check(self) -> None:
        """Check that the sensor is named in exactly one way."""
        if bool(self.sensor_name) == any(self.given):
            raise ParameterError("sensor_name", "or interface_names must be given, and not both")


class ForceTorqueSensorBroadcaster(Controller):
    """Broadcaster of ``~/wrench``; other controllers may use its exported interfaces."""

    names = ("force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",)
    Parameters = ForceTorqueParameters
    parameters: ForceTorqueParameters

    def configure(self) -> None:
        """Set the interface names."""
        axes = tuple(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz")
        sensor = self.parameters.sensor_name
        given = tuple(f"{sensor}/{axis}" for axis in axes) if sensor else self.parameters.given
        self._places = np.array([place for place, name in enumerate(given) if name], dtype=np.intp)
        self.state_names = tuple(name for name in given if name)
        self.exported = Interfaces(axes)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of the sensor."""
        return {"~/wrench": WrenchSample}

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Return the corrected measurement; missing axes are NaN."""
        values = np.full(6, np.nan)
        values[self._places] = self.states.read()
        values = (values + _six(self.parameters.offset)) * _six(self.parameters.multiplier)
        self.exported.values[:] = values
        yield WrenchSample(now_ns, "~/wrench", self.parameters.frame_id, values[:3], values[3:])


def _six(given: WrenchOffsets | WrenchFactors) -> np.ndarray:
    return np.array([one for part in (given.force, given.torque) for one in (part.x, part.y, part.z)])


@dataclass(frozen=True)
class RangeParameters(Parameters):
    """Parameters of the broadcaster of range sensors; values as in ``sensor_msgs/msg/Range``."""

    sensor_name: str = parameter("", "Name of the sensor in its interface.", not_empty=True, read_only=True)
    frame_id: str = parameter("", "Frame of the sensor.", not_empty=True, read_only=True)
    radiation_type: int = parameter(1, "Radiation: 0 is ultrasound, 1 is infrared.", minimum=0, read_only=True)
    field_of_view: float = parameter(0.1, "Angle of the cone that is seen.", unit="rad", read_only=True)
    min_range: float = parameter(0.1, "Least range.", unit="m", read_only=True)
    max_range: float = parameter(7.0, "Largest range.", unit="m", read_only=True)
    variance: float = parameter(0.0, "Variance of the range.", unit="m^2", read_only=True)


class RangeSensorBroadcaster(Controller):
    """Broadcaster of ``~/range``."""

    names = ("range_sensor_broadcaster/RangeSensorBroadcaster",)
    Parameters = RangeParameters
    parameters: RangeParameters

    def configure(self) -> None:
        """Set the interface name."""
        self.state_names = (f"{self.parameters.sensor_name}/range",)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of the sensor."""
        return {"~/range": VariedRangeSample}

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Publish what the range sensor measures."""
        p = self.parameters
        yield VariedRangeSample(
            stamp_ns=now_ns,
            topic="~/range",
            frame_id=p.frame_id,
            radiation_type=p.radiation_type,
            field_of_view=p.field_of_view,
            min_range=p.min_range,
            max_range=p.max_range,
            range=float(self.states.read()[0]),
            variance=p.variance,
        )


@dataclass(frozen=True)
class TransformParameters(Parameters):
    """Parameters of a pose's transform."""

    enable: bool = parameter(True, "Whether the transform is published.", read_only=True)
    child_frame_id: str = parameter("", "Frame whose pose it is; empty for pose_name.", read_only=True)
    publish_rate: float = parameter(
        0.0, "How often the transform is published; 0 for every cycle.", unit="Hz", minimum=0.0, read_only=True
    )


@dataclass(frozen=True)
class PoseParameters(Parameters):
    """Parameters of the broadcaster of poses, as ROS names them."""

    pose_name: str = parameter("", "Name before the pose's interfaces.", not_empty=True, read_only=True)
    frame_id: str = parameter("", "Frame that the pose is in.", not_empty=True, read_only=True)
    tf: TransformParameters = group(TransformParameters)


class PoseBroadcaster(Controller):
    """Broadcaster of ``~/pose`` and its transform."""

    names = ("pose_broadcaster/PoseBroadcaster",)
    Parameters = PoseParameters
    parameters: PoseParameters

    def configure(self) -> None:
        """Set the interface names."""
        self.state_names = tuple(f"{self.parameters.pose_name}/{name}" for name in _POSE)
        self._transforming = RateGate(self.parameters.tf.publish_rate)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Pose, and its transform if enabled."""
        topics: dict[str, type[Sample]] = {"~/pose": PoseSample}
        if self.parameters.tf.enable:
            topics["/tf"] = TransformSample
        return topics

    def activate(self, now_ns: int) -> None:
        """Restart the period of the transforms."""
        self._transforming.restart()

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Publish the pose, and its transform where the pose is finite and its orientation a unit quaternion."""
        values = self.states.read()
        position, orientation = values[:3], values[3:]
        yield PoseSample(now_ns, "~/pose", self.parameters.frame_id, position, orientation)
        sound = bool(np.all(np.isfinite(values)) and abs(np.linalg.norm(orientation) - 1.0) < 1e-3)
        if self.parameters.tf.enable and sound and self._transforming.is_due(now_ns):
            child = self.parameters.tf.child_frame_id or self.parameters.pose_name
            yield TransformSample(now_ns, "/tf", self.parameters.frame_id, child, position, orientation)
