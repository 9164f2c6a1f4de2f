"""Calibration of a camera for its driver."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import CameraInfo
from sensor_msgs.srv import SetCameraInfo

from camera_info_manager.files import genCameraName, loadCalibrationFile, path_of, saveCalibrationFile


class CameraInfoError(Exception):
    """Error of a calibration."""


class CameraInfoMissingError(CameraInfoError):
    """Error of a calibration that was not loaded."""


class CameraInfoManager:
    """Calibration of a camera; calibrators set it by the service ``set_camera_info``.

    Parameters
    ----------
    node
        The driver's node.
    cname
        Name of the camera.
    url
        Where the calibration is: ``file:///path`` or ``package://name/path``, with ``${NAME}`` for the camera and
        ``${ROS_HOME}``; empty: the default place.
    namespace
        Namespace of the service.
    """

    def __init__(self, node: Node, cname: str = "camera", url: str = "", namespace: str = "") -> None:
        self.node = node
        self.cname = cname
        self.url = url
        self.camera_info: CameraInfo | None = None
        service = f"{namespace.rstrip('/')}/set_camera_info" if namespace else "set_camera_info"
        self.svc: Any = node.create_service(SetCameraInfo, service, self.setCameraInfo)

    def __str__(self) -> str:
        return f"[{self.cname}]{self.camera_info}"

    def getCameraInfo(self) -> CameraInfo:
        """Return the calibration; raises CameraInfoMissingError before it was loaded."""
        if self.camera_info is None:
            raise CameraInfoMissingError("Calibration missing, loadCameraInfo() needed.")
        return self.camera_info

    def getCameraName(self) -> str:
        """Return the name of the camera."""
        return self.cname

    def getURL(self) -> str:
        """Return where the calibration is."""
        return self.url

    def isCalibrated(self) -> bool:
        """Return whether the camera is calibrated; raises CameraInfoMissingError before it was loaded."""
        return bool(self.getCameraInfo().k[0] != 0.0)

    def loadCameraInfo(self) -> None:
        """Read the calibration; without one, or with a faulty one, the camera is not calibrated."""
        self.camera_info = CameraInfo()
        try:
            found = loadCalibrationFile(path_of(self.url, self.cname), self.cname)
        except ValueError as error:
            self.node.get_logger().error(f"camera calibration: {error}")
            return
        if found is None:
            self.node.get_logger().warning(f"camera '{self.cname}' has no calibration file")
        else:
            self.camera_info = found

    def setCameraInfo(self, request: Any, response: Any) -> Any:
        """Take over a calibration and write it; handles the service."""
        self.camera_info = request.camera_info
        try:
            path = path_of(self.url, self.cname)
            response.success = saveCalibrationFile(request.camera_info, path, self.cname)
            response.status_message = "" if response.success else f"Error storing camera calibration in {path}."
        except ValueError as error:
            response.success, response.status_message = False, str(error)
        return response

    def setCameraName(self, cname: str) -> bool:
        """Set the name of the camera; return False for one that is not a name. It must be loaded anew."""
        if not cname or genCameraName(cname) != cname:
            return False
        if cname != self.cname:
            self.cname, self.camera_info = cname, None
        return True

    def setURL(self, url: str) -> bool:
        """Set where the calibration is; return False for what is not a URL of one. It must be loaded anew."""
        try:
            path_of(url, self.cname)
        except ValueError:
            return False
        if url != self.url:
            self.url, self.camera_info = url, None
        return True
