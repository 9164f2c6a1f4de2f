"""Ground-truth odometry of a link."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from daidalos.common.pose3 import Pose, rotate
from daidalos.samples.odometry import planar_covariance
from daidalos.samples.sensors import OdometrySample, TransformSample
from daidalos.simulation.instance import Instance, LinkView


def true_odometry(
    link: LinkView,
    now_ns: int,
    topic: str,
    frame_id: str,
    child_frame_id: str,
    covariance: tuple[float, float, float] = (1e-5, 1e-5, 1e-3),
    start: Pose | None = None,
) -> OdometrySample:
    """Return the true odometry of a link.

    Parameters
    ----------
    link : LinkView
    now_ns : int
    topic, frame_id, child_frame_id : str
    covariance : tuple of 3 floats
        That the odometry claims, of x, y and yaw.
    start : Pose or None
        Of `frame_id` in the world; None is the world itself.
    """
    pose = link.pose if start is None else start.inverse @ link.pose
    linear, angular = link.velocity()
    back = link.pose.inverse.orientation
    spread = planar_covariance(*covariance)
    return OdometrySample(
        stamp_ns=now_ns,
        topic=topic,
        frame_id=frame_id,
        child_frame_id=child_frame_id,
        position=np.array(pose.position),
        orientation=np.array(pose.orientation),
        linear=np.array(rotate(back, linear.tolist())),
        angular=np.array(rotate(back, angular.tolist())),
        pose_covariance=spread,
        twist_covariance=spread,
    )


def link_transforms(
    instance: Instance, base: LinkView, joints: Iterable[str], now_ns: int, topic: str, frame_id: str
) -> Iterator[TransformSample]:
    """Yield the transforms of the child links of joints in a base frame."""
    back = base.pose.inverse
    for joint in joints:
        child = instance.model.joints[joint].child
        pose = back @ instance.link(child).pose
        yield TransformSample(now_ns, topic, frame_id, child, np.array(pose.position), np.array(pose.orientation))
