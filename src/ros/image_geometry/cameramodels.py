"""Models of one and of two cameras, made from `sensor_msgs/CameraInfo`.

A pixel is (u, v): columns to the right, rows down, from the centre of the first pixel. Points are in the camera's
optical frame: x to the right, y down, z ahead [m]. Methods have their names in both of ROS 2's spellings.
"""

from __future__ import annotations

import copy
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._distortion import distortion, undistort

if TYPE_CHECKING:
    from sensor_msgs.msg import CameraInfo

Array = NDArray[np.float64]
Pixel = tuple[float, float]
Point = tuple[float, float, float]


class PinholeCameraModel:
    """One camera.

    Attributes
    ----------
    K, D, R, P : array
        Camera matrix (3, 3), distortion coefficients (n,), rectification (3, 3) and projection (3, 4), the matrices
        of pixels in the message's region of interest, after binning.
    full_K, full_P : array
        The matrices of the whole sensor without binning.
    width, height : int
        Of the whole sensor [pixels].
    binning_x, binning_y : int
        How many pixels became one.
    raw_roi : sensor_msgs.msg.RegionOfInterest
        The region of interest.
    tf_frame : str
        The optical frame.
    stamp : builtin_interfaces.msg.Time
        That of the message.
    """

    def __init__(self) -> None:
        self.K: Any = None
        self.D: Any = None
        self.R: Any = None
        self.P: Any = None
        self.full_K: Any = None
        self.full_P: Any = None
        self.width: int | None = None
        self.height: int | None = None
        self.binning_x: int | None = None
        self.binning_y: int | None = None
        self.raw_roi: Any = None
        self.tf_frame: str | None = None
        self.stamp: Any = None
        self._bend: Any = None
        self._maps: Any = None

    def from_camera_info(self, msg: CameraInfo) -> None:
        """Set the camera's model from a message.

        Raises
        ------
        ValueError
            If the camera is not calibrated, or its distortion model is unknown.
        """
        matrix, projection = np.array(msg.k).reshape(3, 3), np.array(msg.p).reshape(3, 4)
        if not (matrix[0, 0] and matrix[1, 1] and projection[0, 0] and projection[1, 1]):
            raise ValueError("the camera is not calibrated: its focal lengths are 0")
        self.D = np.array(msg.d, dtype=float)
        self._bend = distortion(msg.distortion_model, self.D)
        rotation = np.array(msg.r).reshape(3, 3)
        self.R = rotation if rotation.any() else np.eye(3)
        self.full_K, self.full_P = matrix, projection
        self.width, self.height = msg.width, msg.height
        self.binning_x, self.binning_y = max(1, msg.binning_x), max(1, msg.binning_y)
        self.raw_roi = copy.copy(msg.roi)
        self.tf_frame, self.stamp = msg.header.frame_id, msg.header.stamp
        self.K, self.P = (self._binned(full) for full in (matrix, projection))
        self._maps = None

    def _binned(self, full: Array) -> Array:
        """Return the matrix for the pixels of the region of interest, after binning."""
        reduced = full.copy()
        reduced[0, 2] -= self.raw_roi.x_offset
        reduced[1, 2] -= self.raw_roi.y_offset
        reduced[0] /= self.binning_x
        reduced[1] /= self.binning_y
        return reduced

    def rectify_image(self, raw: NDArray[Any], rectified: NDArray[Any]) -> None:
        """Write the image into `rectified` as a camera without distortion would have seen it.

        Parameters
        ----------
        raw, rectified : array of shape (height, width) or (height, width, channels)
            `rectified` must be of the same shape and type.

        Raises
        ------
        RuntimeError
            If OpenCV is not installed.
        ValueError
            If the arrays differ.
        """
        from cv_bridge._opencv import COMMAND, opencv

        if raw.shape != rectified.shape or raw.dtype != rectified.dtype:
            raise ValueError(
                f"the rectified image has shape {rectified.shape} and type {rectified.dtype}, "
                f"the raw one {raw.shape} and {raw.dtype}"
            )
        if self._bend is None and np.array_equal(self.R, np.eye(3)) and np.array_equal(self.K, self.P[:, :3]):
            rectified[...] = raw
            return
        cv2 = opencv()
        if cv2 is None:
            raise RuntimeError(f"images are rectified with OpenCV, which is not installed: {COMMAND}")
        if self._maps is None or self._maps.shape[:2] != raw.shape[:2]:
            rows, columns = np.mgrid[: raw.shape[0], : raw.shape[1]]
            self._maps = self.unrectify_point(np.stack((columns, rows), axis=-1)).astype(np.float32)
        rectified[...] = cv2.remap(raw, self._maps, None, cv2.INTER_CUBIC).reshape(raw.shape)

    def rectify_point(self, uv_raw: ArrayLike) -> Array:
        """Return where a pixel is in the rectified image.

        Parameters
        ----------
        uv_raw : array of shape (..., 2)
            One pixel or many.

        Returns
        -------
        array of shape (..., 2)
        """
        rays = (np.asarray(uv_raw, dtype=float) - self.K[:2, 2]) / (self.K[0, 0], self.K[1, 1])
        if self._bend is not None:
            rays = undistort(self._bend, rays)
        turned = _as_points(rays) @ self.R.T @ self.P[:, :3].T
        return np.asarray(turned[..., :2] / turned[..., 2:])

    def unrectify_point(self, uv_rect: ArrayLike) -> Array:
        """Return where a pixel of the rectified image is in the raw one.

        Parameters
        ----------
        uv_rect : array of shape (..., 2)
            One pixel or many.

        Returns
        -------
        array of shape (..., 2)
        """
        rays = (np.asarray(uv_rect, dtype=float) - self.P[:2, 2]) / (self.P[0, 0], self.P[1, 1])
        turned = _as_points(rays) @ self.R
        rays = turned[..., :2] / turned[..., 2:]
        if self._bend is not None:
            rays = self._bend(rays)
        return np.asarray(rays * (self.K[0, 0], self.K[1, 1]) + self.K[:2, 2])

    def project_3d_to_pixel(self, point: ArrayLike) -> Pixel:
        """Return the rectified pixel of a point; not a number where the point is beside the camera.

        Parameters
        ----------
        point
            (x, y, z) [m].
        """
        u, v, w = self.P @ (*np.ravel(np.asarray(point, dtype=float))[:3], 1.0)
        return (float(u / w), float(v / w)) if w else (math.nan, math.nan)

    def project_pixel_to_3d_ray(self, uv: ArrayLike) -> Point:
        """Return the direction in which a rectified pixel looks, 1 long.

        Parameters
        ----------
        uv
            (u, v).
        """
        u, v = np.ravel(np.asarray(uv, dtype=float))
        ray = np.array(((u - self.cx()) / self.fx(), (v - self.cy()) / self.fy(), 1.0))
        x, y, z = (ray / np.linalg.norm(ray)).tolist()
        return x, y, z

    def get_delta_u(self, delta_x: float, z: float) -> float:
        """Return how many pixels lie across `delta_x` [m] at depth `z` [m]."""
        return math.inf if z == 0 else self.fx() * delta_x / z

    def get_delta_v(self, delta_y: float, z: float) -> float:
        """Return how many pixels lie along `delta_y` [m] at depth `z` [m]."""
        return math.inf if z == 0 else self.fy() * delta_y / z

    def get_delta_x(self, delta_u: float, z: float) -> float:
        """Return how many metres lie across `delta_u` [pixels] at depth `z` [m]."""
        return z * delta_u / self.fx()

    def get_delta_y(self, delta_v: float, z: float) -> float:
        """Return how many metres lie along `delta_v` [pixels] at depth `z` [m]."""
        return z * delta_v / self.fy()

    def full_resolution(self) -> tuple[int | None, int | None]:
        """Return width and height of the sensor [pixels]."""
        return self.width, self.height

    def intrinsic_matrix(self) -> Array:
        """Return the camera matrix K, (3, 3)."""
        return np.asarray(self.K)

    def distortion_coeffs(self) -> Array:
        """Return the distortion coefficients D."""
        return np.asarray(self.D)

    def rotation_matrix(self) -> Array:
        """Return the rectification R, (3, 3)."""
        return np.asarray(self.R)

    def projection_matrix(self) -> Array:
        """Return the projection P, (3, 4)."""
        return np.asarray(self.P)

    def full_intrinsic_matrix(self) -> Array:
        """Return the camera matrix of the whole sensor, (3, 3)."""
        return np.asarray(self.full_K)

    def full_projection_matrix(self) -> Array:
        """Return the projection of the whole sensor, (3, 4)."""
        return np.asarray(self.full_P)

    def cx(self) -> float:
        """Return the column of the rectified principal point."""
        return float(self.P[0, 2])

    def cy(self) -> float:
        """Return the row of the rectified principal point."""
        return float(self.P[1, 2])

    def fx(self) -> float:
        """Return the rectified focal length across [pixels]."""
        return float(self.P[0, 0])

    def fy(self) -> float:
        """Return the rectified focal length along [pixels]."""
        return float(self.P[1, 1])

    def tx(self) -> float:
        """Return -fx times the distance of a stereo pair's cameras [pixels m]; 0 for its left camera."""
        return float(self.P[0, 3])

    def ty(self) -> float:
        """Return -fy times the distance of a pair of cameras one above the other [pixels m]."""
        return float(self.P[1, 3])

    def fov_x(self) -> float:
        """Return the angle that the whole sensor sees across [rad]."""
        return 2 * math.atan((self.width or 0) / (2 * float(self.full_P[0, 0])))

    def fov_y(self) -> float:
        """Return the angle that the whole sensor sees along [rad]."""
        return 2 * math.atan((self.height or 0) / (2 * float(self.full_P[1, 1])))

    def get_tf_frame(self) -> str | None:
        """Return the optical frame."""
        return self.tf_frame

    fromCameraInfo = from_camera_info
    rectifyImage = rectify_image
    rectifyPoint = rectify_point
    unrectifyPoint = unrectify_point
    project3dToPixel = project_3d_to_pixel
    projectPixelTo3dRay = project_pixel_to_3d_ray
    getDeltaU = get_delta_u
    getDeltaV = get_delta_v
    getDeltaX = get_delta_x
    getDeltaY = get_delta_y
    fullResolution = full_resolution
    intrinsicMatrix = intrinsic_matrix
    distortionCoeffs = distortion_coeffs
    rotationMatrix = rotation_matrix
    projectionMatrix = projection_matrix
    fullIntrinsicMatrix = full_intrinsic_matrix
    fullProjectionMatrix = full_projection_matrix
    Tx = tx
    Ty = ty
    fovX = fov_x
    fovY = fov_y
    tfFrame = get_tf_frame


class StereoCameraModel:
    """Two cameras beside each other, with rectified images.

    Attributes
    ----------
    left, right : PinholeCameraModel
        The cameras. Points are in the left one's frame.
    Q : array of shape (4, 4)
        Takes (u, v, disparity, 1) of the left image to (x, y, z, 1) times a factor.
    """

    def __init__(self) -> None:
        self.left = PinholeCameraModel()
        self.right = PinholeCameraModel()
        self.Q: Any = None

    def from_camera_info(self, left_msg: CameraInfo, right_msg: CameraInfo) -> None:
        """Set the cameras' models from their messages.

        Raises
        ------
        ValueError
            If one is not calibrated, or both are at one place: the right one's projection tells the distance.
        """
        self.left.from_camera_info(left_msg)
        self.right.from_camera_info(right_msg)
        if not self.right.tx():
            raise ValueError("the right camera's projection has no distance from the left one in its fourth column")
        fx, fy = self.left.fx(), self.left.fy()
        cx, cy = self.left.cx(), self.left.cy()
        # z = -tx / (disparity - (cx - right cx)), x = z (u - cx) / fx, y = z (v - cy) / fy; all times fx fy / -tx.
        self.Q = np.array(
            (
                (fy, 0.0, 0.0, -fy * cx),
                (0.0, fx, 0.0, -fx * cy),
                (0.0, 0.0, 0.0, fx * fy),
                (0.0, 0.0, -fx * fy / self.right.tx(), fx * fy * (cx - self.right.cx()) / self.right.tx()),
            )
        )

    def project_3d_to_pixel(self, point: ArrayLike) -> tuple[Pixel, Pixel]:
        """Return the rectified pixels of a point in the left and in the right image.

        Parameters
        ----------
        point
            (x, y, z) [m].
        """
        return self.left.project_3d_to_pixel(point), self.right.project_3d_to_pixel(point)

    def project_pixel_to_3d(self, left_uv: ArrayLike, disparity: float) -> Point:
        """Return the point behind a rectified pixel of the left image; (0, 0, 0) where it is infinitely far.

        Parameters
        ----------
        left_uv
            (u, v).
        disparity
            How many columns further left the point is in the right image [pixels].
        """
        u, v = np.ravel(np.asarray(left_uv, dtype=float))
        *point, factor = (self.Q @ (u, v, disparity, 1.0)).tolist()
        if factor == 0:
            return 0.0, 0.0, 0.0
        x, y, z = (value / factor for value in point)
        return x, y, z

    def get_z(self, disparity: float) -> float:
        """Return the depth [m] of a disparity [pixels]."""
        return math.inf if disparity == 0 else -self.right.tx() / disparity

    def get_disparity(self, z: float) -> float:
        """Return the disparity [pixels] at a depth [m]."""
        return math.inf if z == 0 else -self.right.tx() / z

    def get_tf_frame(self) -> str | None:
        """Return the left camera's optical frame."""
        return self.left.tf_frame

    def get_left_camera(self) -> PinholeCameraModel:
        """Return the left camera."""
        return self.left

    def get_right_camera(self) -> PinholeCameraModel:
        """Return the right camera."""
        return self.right

    fromCameraInfo = from_camera_info
    project3dToPixel = project_3d_to_pixel
    projectPixelTo3d = project_pixel_to_3d
    getZ = get_z
    getDisparity = get_disparity
    tfFrame = get_tf_frame


def _as_points(rays: Array) -> Array:
    """Return the points of rays (..., 2) at depth 1, (..., 3)."""
    return np.concatenate((rays, np.ones((*rays.shape[:-1], 1))), axis=-1)
