"""Samples of sensors and of robots' plugins.

Times are nanoseconds, simulated or of the node's clock; units are SI, quaternions are x, y, z, w, topics are absolute,
frame ids are without a leading slash.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose


@dataclass(frozen=True, eq=False)
class Sample:
    """Measurement of a sensor, plugin or controller at one instant.

    Parameters
    ----------
    stamp_ns : int
        When it was measured.
    topic : str
        On which it is published, such as ``/scan``.
    frame_id : str
        The frame that its numbers are in.
    """

    stamp_ns: int
    topic: str
    frame_id: str


@dataclass(frozen=True, eq=False)
class LaserScanSample(Sample):
    """Scan of a planar lidar.

    Parameters
    ----------
    angle_min, angle_max, angle_increment : float
        Of the rays about the frame's z axis, from its x axis [rad].
    time_increment, scan_time : float
        Between rays (0: all at once) and between scans [s].
    range_min, range_max : float
        [m].
    ranges : array (n,) of float32
        [m]; ``inf`` where nothing is in reach, ``-inf`` where something is nearer than `range_min`.
    intensities : array (n,) of float32
        The ``laser_retro`` of what was hit.
    """

    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: NDArray[np.float32]
    intensities: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PointCloudSample(Sample):
    """Points in rows (rings of a lidar, lines of a camera).

    Parameters
    ----------
    points : array (rows, columns, 3) of float32
        [m], in the frame; ``inf`` (a lidar) or ``nan`` (a camera) where nothing is in reach.
    intensities : array (rows, columns) of float32 or None
        The ``laser_retro`` of what was hit.
    colors : array (rows, columns, 3) of uint8 or None
        Red, green, blue.
    """

    points: NDArray[np.float32]
    intensities: NDArray[np.float32] | None = None
    colors: NDArray[np.uint8] | None = None


@dataclass(frozen=True, eq=False)
class ImageSample(Sample):
    """Camera image.

    Parameters
    ----------
    encoding : str
        ROS's name for what the pixels hold, such as ``rgb8`` or ``32FC1`` (depths in metres, REP 118).
    pixels : array (height, width) or (height, width, bands)
    """

    encoding: str
    pixels: NDArray[Any]


@dataclass(frozen=True, eq=False)
class CameraInfoSample(Sample):
    """Calibration of a camera.

    Parameters
    ----------
    width, height : int
        [pixels].
    distortion : tuple of floats
        Coefficients of the distortion model: k1, k2, p1, p2, k3 of ``plumb_bob``, k1 to k4 of ``equidistant``.
    matrix : array (3, 3)
        Of the raw image.
    projection : array (3, 4)
        Of the rectified image.
    distortion_model : str
        ROS's name; empty, with matrices of zeros, for an uncalibrated camera.
    """

    width: int
    height: int
    distortion: tuple[float, ...]
    matrix: Array
    projection: Array
    distortion_model: str = "plumb_bob"


@dataclass(frozen=True, eq=False)
class LogicalImageSample(Sample):
    """Models visible to a logical camera.

    Parameters
    ----------
    pose : Pose
        Of the camera in the world.
    models : tuple of (str, Pose)
        Names, with their poses in the camera's frame.
    """

    pose: Pose
    models: tuple[tuple[str, Pose], ...]


@dataclass(frozen=True, eq=False)
class ImuSample(Sample):
    """Inertial measurement.

    Parameters
    ----------
    orientation : array (4,)
        Of the frame in the world (x east, z up), or in what the sensor's settings name.
    angular_velocity : array (3,)
        [rad/s], in the frame.
    linear_acceleration : array (3,)
        Specific force [m/s^2], in the frame: +9.8 along z at rest on level ground.
    orientation_covariance, angular_velocity_covariance, linear_acceleration_covariance : array (9,)
        Row-major; of the noise that was added.
    """

    orientation: Array
    angular_velocity: Array
    linear_acceleration: Array
    orientation_covariance: Array
    angular_velocity_covariance: Array
    linear_acceleration_covariance: Array


@dataclass(frozen=True, eq=False)
class RangeSample(Sample):
    """Distance to the nearest object in a cone along x.

    Parameters
    ----------
    field_of_view : float
        [rad].
    range_min, range_max : float
        [m].
    range : float
        [m]; ``inf`` for nothing in reach, ``-inf`` for something too near.
    ultrasound : bool
        Rather than infrared.
    """

    field_of_view: float
    range_min: float
    range_max: float
    range: float
    ultrasound: bool


@dataclass(frozen=True, eq=False)
class NavSatSample(Sample):
    """Geographic position.

    Parameters
    ----------
    latitude, longitude : float
        [deg].
    altitude : float
        Over the ellipsoid [m].
    velocity : array (3,)
        East, north, up [m/s].
    covariance : array (9,)
        Of the position, east, north, up [m^2].
    """

    latitude: float
    longitude: float
    altitude: float
    velocity: Array
    covariance: Array


@dataclass(frozen=True, eq=False)
class MagneticFieldSample(Sample):
    """Magnetic field (3,) in the frame [T], with its covariance (9,)."""

    field: Array
    covariance: Array


@dataclass(frozen=True, eq=False)
class AltimeterSample(Sample):
    """Height over a reference [m], its rate [m/s], and the reference's height in the world [m]."""

    position: float
    velocity: float
    reference: float


@dataclass(frozen=True, eq=False)
class PressureSample(Sample):
    """Air pressure [Pa] and its variance."""

    pressure: float
    variance: float


@dataclass(frozen=True, eq=False)
class WrenchSample(Sample):
    """Force (3,) [N] and torque (3,) [N m] in the frame."""

    force: Array
    torque: Array


@dataclass(frozen=True, eq=False)
class Contact:
    """Two collisions that touch in k points.

    Parameters
    ----------
    model1, link1, collision1, model2, link2, collision2 : str
        Names as in the descriptions.
    positions : array (k, 3)
        In the world [m].
    normals : array (k, 3)
        Unit vectors from the first to the second.
    forces : array (k, 3)
        On the second, in world axes [N].
    depths : array (k,)
        How far they overlap [m].
    """

    model1: str
    link1: str
    collision1: str
    model2: str
    link2: str
    collision2: str
    positions: Array
    normals: Array
    forces: Array
    depths: Array

    def swapped(self) -> Contact:
        """Return the same with the two sides exchanged."""
        return Contact(
            *(self.model2, self.link2, self.collision2),
            *(self.model1, self.link1, self.collision1),
            positions=self.positions,
            normals=-self.normals,
            forces=-self.forces,
            depths=self.depths,
        )


@dataclass(frozen=True, eq=False)
class ContactsSample(Sample):
    """Contacts of a link, pair by pair; the link's collision is the first of each."""

    contacts: tuple[Contact, ...]


@dataclass(frozen=True, eq=False)
class BumperSample(ContactsSample):
    """Contacts of a link, in the form of Gazebo classic's bumper."""


@dataclass(frozen=True, eq=False)
class OdometrySample(Sample):
    """Pose and velocity of a base in `frame_id`.

    Parameters
    ----------
    child_frame_id : str
        The base.
    position : array (3,)
        [m].
    orientation : array (4,)
    linear, angular : array (3,)
        Velocity in the base's frame [m/s, rad/s].
    pose_covariance, twist_covariance : array (36,)
        Row-major over x, y, z and rotations about x, y, z.
    """

    child_frame_id: str
    position: Array
    orientation: Array
    linear: Array
    angular: Array
    pose_covariance: Array
    twist_covariance: Array


@dataclass(frozen=True, eq=False)
class TransformSample(Sample):
    """Pose of `child_frame_id` in `frame_id`; its topic is ``/tf``.

    Parameters
    ----------
    child_frame_id : str
    translation : array (3,)
        [m].
    rotation : array (4,)
    """

    child_frame_id: str
    translation: Array
    rotation: Array


@dataclass(frozen=True, eq=False)
class JointStateSample(Sample):
    """State of n joints.

    Parameters
    ----------
    names : tuple of n strings
    positions : array (n,)
        [rad, m].
    velocities : array (n,)
        [rad/s, m/s].
    efforts : array (n,)
        Of their actuators [N m, N].
    """

    names: tuple[str, ...]
    positions: Array
    velocities: Array
    efforts: Array


@dataclass(frozen=True, eq=False)
class FlagSample(Sample):
    """Boolean value."""

    value: bool


@dataclass(frozen=True, eq=False)
class NumberSample(Sample):
    """Number in the unit of its topic."""

    value: float


@dataclass(frozen=True, eq=False)
class TextSample(Sample):
    """Text."""

    text: str


@dataclass(frozen=True, eq=False)
class BatterySample(Sample):
    """State of a battery.

    Parameters
    ----------
    voltage, current : float
        [V], and [A], negative while it empties.
    charge, capacity : float
        [A h].
    """

    voltage: float
    current: float
    charge: float
    capacity: float


@dataclass(frozen=True, eq=False)
class WheelSlipSample(Sample):
    """Slip of wheels, arrays (n,).

    Parameters
    ----------
    names : tuple of n strings
    lateral : array (n,)
        Between where each points and where it goes [rad].
    longitudinal : array (n,)
        Slip speed over rim speed.
    """

    names: tuple[str, ...]
    lateral: Array
    longitudinal: Array
