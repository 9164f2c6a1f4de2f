"""Calibrations of cameras: read, offered to a driver, and written when a calibrator sets them."""

from camera_info_manager.camera_info_manager import CameraInfoError as CameraInfoError
from camera_info_manager.camera_info_manager import CameraInfoManager as CameraInfoManager
from camera_info_manager.camera_info_manager import CameraInfoMissingError as CameraInfoMissingError
from camera_info_manager.files import genCameraName as genCameraName
from camera_info_manager.files import loadCalibrationFile as loadCalibrationFile
from camera_info_manager.files import resolveURL as resolveURL
from camera_info_manager.files import saveCalibrationFile as saveCalibrationFile
