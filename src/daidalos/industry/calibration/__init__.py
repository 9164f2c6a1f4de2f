"""Where the tool is on the flange, and where the workpiece is in the cell, from touched points."""

from daidalos.industry.calibration.tool import CalibrationError, ToolCalibration, calibrate_tool
from daidalos.industry.calibration.work_object import work_object_frame

__all__ = ["CalibrationError", "ToolCalibration", "calibrate_tool", "work_object_frame"]
