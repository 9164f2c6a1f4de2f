"""Reader of SDF's ``<camera>``."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.common.pose3 import Pose
from daidalos.description.markup import Element
from daidalos.description.sdf.frames import read_pose
from daidalos.simulation.noise import SILENT, Noise, read_noise
from daidalos.simulation.rendering.optics import Pinhole

ENCODINGS = {
    "R8G8B8": "rgb8",
    "RGB_INT8": "rgb8",
    "B8G8R8": "bgr8",
    "BGR_INT8": "bgr8",
    "R8G8B8A8": "rgba8",
    "R16G16B16": "rgb16",
    "RGB_INT16": "rgb16",
    "L8": "mono8",
    "L_INT8": "mono8",
    "L16": "mono16",
    "L_INT16": "mono16",
    "BAYER_RGGB8": "bayer_rggb8",
    "BAYER_BGGR8": "bayer_bggr8",
    "BAYER_GBRG8": "bayer_gbrg8",
    "BAYER_GRBG8": "bayer_grbg8",
    # Formats of depths, which are always told as floats; what such a camera sees besides is coloured.
    "R_FLOAT16": "rgb8",
    "R_FLOAT32": "rgb8",
}
_MAX_PIXELS = 1 << 26
_TURN = 2 * math.pi + 1e-3  # files write 6.2832
WIDEST = math.radians(160.0)
"""Widest horizontal field of view [rad] of a pinhole; Gazebo permits up to a whole turn, for its lenses."""


@dataclass(frozen=True)
class CameraSettings:
    """Settings of one optical system of a camera.

    Parameters
    ----------
    name : str
    pose : Pose
        In the sensor; x ahead, z up.
    pinhole : Pinhole
    near, far : float
        Between which depths it sees [m].
    depth_near, depth_far : float
        Between which it measures depths [m].
    encoding, depth_encoding : str
        ROS's names.
    noise, depth_noise : Noise
        In shares of full brightness, and in metres.
    mask : int
        Sees visuals whose visibility flags have a bit in common with it.
    panoptic : bool
        A segmentation camera tells instances apart.
    tx, ty : float
        Of the projection matrix.
    topic, info_topic, trigger_topic, optical_frame : str
        Empty where the description leaves them out.
    """

    name: str
    pose: Pose
    pinhole: Pinhole
    near: float
    far: float
    depth_near: float
    depth_far: float
    encoding: str = "rgb8"
    depth_encoding: str = "32FC1"
    noise: Noise = SILENT
    depth_noise: Noise = SILENT
    mask: int = 0xFFFFFFFF
    panoptic: bool = False
    tx: float = 0.0
    ty: float = 0.0
    topic: str = ""
    info_topic: str = ""
    trigger_topic: str = ""
    triggered: bool = False
    optical_frame: str = ""


def read_camera(element: Element) -> CameraSettings:
    """Read a ``<camera>``.

    Raises
    ------
    DescriptionError
        When a size, angle or format makes no sense.
    """
    image = element.first("image") or _empty("image", element)
    width, height = image.integer_of("width", default=320), image.integer_of("height", default=240)
    if not (width > 0 and height > 0 and width * height <= _MAX_PIXELS):
        raise image.error(f"expected a width and a height of at least 1 pixel, got {width} x {height}")
    near, far = _clip(element.first("clip"), 0.1, 100.0)
    depth = element.first("depth_camera") or _empty("depth_camera", element)
    depth_near, depth_far = _clip(depth.first("clip"), near, far)
    noise = read_noise(element.first("noise"))
    projection = (element.first("lens") or _empty("lens", element)).first("projection") or _empty("projection", element)
    return CameraSettings(
        name=element.attribute("name", "camera"),
        pose=read_pose(element).pose,
        pinhole=_pinhole(element, width, height),
        near=near,
        far=max(far, depth_far),
        depth_near=depth_near,
        depth_far=depth_far,
        encoding=_encoding(image),
        noise=noise,
        depth_noise=read_noise(depth.first("noise")),
        mask=element.integer_of("visibility_mask", default=0xFFFFFFFF) & 0xFFFFFFFF,
        panoptic=element.text_of("segmentation_type", default="semantic") in ("panoptic", "instance"),
        tx=projection.number_of("tx", default=0.0),
        ty=projection.number_of("ty", default=0.0),
        topic=element.text_of("topic"),
        info_topic=element.text_of("camera_info_topic"),
        trigger_topic=element.text_of("trigger_topic"),
        triggered=element.flag_of("triggered", default=False),
        optical_frame=element.text_of("optical_frame_id"),
    )


def _pinhole(element: Element, width: int, height: int) -> Pinhole:
    angle = element.number_of("horizontal_fov", default=1.047)
    if not 0 < angle <= _TURN:
        raise element.error(f"<horizontal_fov> should be above 0 and at most 2 pi, got {angle:g}")
    ideal = Pinhole.from_field_of_view(width, height, min(angle, WIDEST))
    lens = element.first("lens") or _empty("lens", element)
    intrinsics = lens.first("intrinsics") or _empty("intrinsics", element)
    bent = element.first("distortion") or _empty("distortion", element)
    k1, k2, p1, p2, k3 = (bent.number_of(key, default=0.0) for key in ("k1", "k2", "p1", "p2", "k3"))
    return Pinhole(
        width,
        height,
        intrinsics.number_of("fx", default=ideal.fx),
        intrinsics.number_of("fy", default=ideal.fy),
        intrinsics.number_of("cx", default=ideal.cx),
        intrinsics.number_of("cy", default=ideal.cy),
        (k1, k2, p1, p2, k3),
    )


def _clip(element: Element | None, near: float, far: float) -> tuple[float, float]:
    if element is None:
        return near, far
    near, far = element.number_of("near", default=near), element.number_of("far", default=far)
    if not 0 < near < far:
        raise element.error(f"expected 0 < near < far, got {near:g} and {far:g}")
    return near, far


def _encoding(image: Element) -> str:
    name = image.text_of("format", default="R8G8B8")
    if name not in ENCODINGS:
        raise image.error(f"<format> is {name!r}, expected one of {', '.join(ENCODINGS)}")
    return ENCODINGS[name]


def _empty(tag: str, element: Element) -> Element:
    return Element(tag, source=element.source, line=element.line)
