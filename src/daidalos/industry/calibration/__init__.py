"""Calibration of tools on the flange and of work objects in the cell from touched points."""

from daidalos.industry.calibration.tool import CalibrationError, ToolCalibration, calibrate_tool, tool_rotation
from daidalos.industry.calibration.work_object import (
    work_object_deviations,
    work_object_frame,
    work_object_warnings,
)

__all__ = [
    "CalibrationError",
    "ToolCalibration",
    "calibrate_tool",
    "tool_rotation",
    "work_object_deviations",
    "work_object_frame",
    "work_object_warnings",
]
