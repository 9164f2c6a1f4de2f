"""Calibration of tools on the flange and of work objects in the cell from touched points."""

from daidalos.industry.calibration.tool import CalibrationError, ToolCalibration, calibrate_tool
from daidalos.industry.calibration.work_object import work_object_frame

__all__ = ["CalibrationError", "ToolCalibration", "calibrate_tool", "work_object_frame"]
