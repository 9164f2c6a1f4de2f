"""Poses of docks as they are seen: checked, filtered and no older than allowed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import interpolate
from daidalos.common.pose3 import Pose, multiply, quaternion_from_rpy, yaw_from_quaternion
from daidalos.navigation.errors import FailedToDetectDock


@dataclass(frozen=True)
class DetectionParameters(Parameters):
    """Parameters, by their Nav2 names; `max_detection_jump` is ours."""

    use_external_detection_pose: bool = parameter(
        False, "Whether docks are seen, on detected_dock_pose.", read_only=True
    )
    external_detection_timeout: float = parameter(1.0, "Oldest pose that is used.", unit="s", above=0.0)
    external_detection_translation_x: float = parameter(
        -0.20, "Where the robot stands when it is docked, ahead of what is seen.", unit="m"
    )
    external_detection_translation_y: float = parameter(0.0, "The same, to the left.", unit="m")
    external_detection_rotation_yaw: float = parameter(0.0, "Rotation of what is seen to the dock.", unit="rad")
    external_detection_rotation_pitch: float = parameter(1.57, "The same.", unit="rad")
    external_detection_rotation_roll: float = parameter(-1.57, "The same.", unit="rad")
    filter_coef: float = parameter(
        0.1, "Share of the newest pose in the filtered one; 0: no filter.", minimum=0.0, maximum=1.0
    )
    max_detection_jump: float = parameter(
        0.5, "Distance from the filtered pose from which on one is not believed.", unit="m", above=0.0
    )


class DockDetection:
    """Filter of the poses of a dock.

    A pose that is far from the filtered one is not believed; the filter begins anew where no other came within
    `external_detection_timeout`.
    """

    def __init__(self) -> None:
        self._pose: Array | None = None
        self._stamp = -math.inf
        self._problem = ""

    def take(self, pose: Pose, stamp: float, p: DetectionParameters) -> None:
        """Take a dock that was seen at a time [s]."""
        seen = _dock_pose(pose, p)
        if not np.isfinite(seen).all():
            self._problem = "its last pose is not finite"
            return
        is_new = self._pose is None or not 0.0 <= stamp - self._stamp <= p.external_detection_timeout
        if not is_new:
            assert self._pose is not None
            jump = float(np.hypot(*(seen - self._pose)[:2]))
            if jump > p.max_detection_jump:
                self._problem = f"its pose jumped by {jump:.2f} m, more than {p.max_detection_jump:g} m"
                return
            if p.filter_coef > 0.0:
                seen = interpolate(self._pose, seen, p.filter_coef)
        self._pose, self._stamp, self._problem = seen, stamp, ""

    def pose(self, now: float, p: DetectionParameters) -> Array:
        """Return the pose of the dock at a time [s].

        Raises
        ------
        FailedToDetectDock
            It was not seen recently.
        """
        if self._pose is None:
            raise FailedToDetectDock(f"the dock is not seen: {self._problem or 'no pose has come'}")
        age = now - self._stamp
        if abs(age) > p.external_detection_timeout:
            when = f"{age:.3g} s ago" if age > 0.0 else f"{-age:.3g} s ahead of the clock"
            raise FailedToDetectDock(
                f"the dock was last seen {when}, the limit is {p.external_detection_timeout:g} s"
                f"{f'; {self._problem}' if self._problem else ''}"
            )
        return self._pose


def _dock_pose(seen: Pose, p: DetectionParameters) -> Array:
    """Return the pose (x, y, yaw) at which the robot is docked, from what is seen."""
    turn = multiply(
        quaternion_from_rpy(0.0, p.external_detection_rotation_pitch, 0.0),
        multiply(
            quaternion_from_rpy(p.external_detection_rotation_roll, 0.0, 0.0),
            quaternion_from_rpy(0.0, 0.0, p.external_detection_rotation_yaw),
        ),
    )
    yaw = yaw_from_quaternion(multiply(seen.orientation, turn))
    x, y = p.external_detection_translation_x, p.external_detection_translation_y
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.array([seen.position[0] + cosine * x - sine * y, seen.position[1] + sine * x + cosine * y, yaw])
