"""Cameras as their calibration describes them: from points in space to pixels and back."""

from .cameramodels import PinholeCameraModel as PinholeCameraModel
from .cameramodels import StereoCameraModel as StereoCameraModel
