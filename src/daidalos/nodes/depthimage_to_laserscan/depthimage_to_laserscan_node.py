"""`depthimage_to_laserscan_node`: publishes the middle rows of depth images as laser scans."""

from __future__ import annotations

from typing import Any

import numpy as np
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, LaserScan

from daidalos.nodes.depthimage_to_laserscan._scan import scan
from daidalos.nodes.runner import run

_METRES = {"16UC1": 0.001, "mono16": 0.001, "32FC1": 1.0}


class DepthImageToLaserScan(Node):
    """Node that publishes ``scan`` from ``depth`` and ``depth_camera_info`` while it has subscribers.

    Parameters of the node: ``scan_time`` [s], ``range_min``, ``range_max`` [m], ``scan_height`` (how many rows are
    looked at) and ``output_frame`` (of the scan: x ahead, y to the left).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("depthimage_to_laserscan", **kwargs)
        self._scan_time = self._number("scan_time", 0.033)
        self._near, self._far = self._number("range_min", 0.45), self._number("range_max", 10.0)
        self._height = int(self.declare_parameter("scan_height", 1).value or 0)
        if self._height < 1:
            raise RuntimeError(f"the parameter 'scan_height' is {self._height}, but must be at least 1")
        self._frame = str(self.declare_parameter("output_frame", "camera_depth_frame").value)
        self._camera: CameraInfo | None = None
        self._bridge = CvBridge()
        self._scans = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_subscription(CameraInfo, "depth_camera_info", self._set_camera, qos_profile_sensor_data)
        self.create_subscription(Image, "depth", self._publish_scan, qos_profile_sensor_data)

    def _number(self, name: str, default: float) -> float:
        return float(self.declare_parameter(name, default).value)

    def _set_camera(self, camera: CameraInfo) -> None:
        self._camera = camera

    def _publish_scan(self, image: Image) -> None:
        camera = self._camera
        if camera is None or self._scans.get_subscription_count() == 0:
            return
        scale = _METRES.get(image.encoding)
        if scale is None or not camera.k[0] or self._height > image.height:
            self.get_logger().error(self._fault(image, camera), throttle_duration_sec=5.0)
            return
        depth = np.asarray(self._bridge.imgmsg_to_cv2(image)) * scale
        fan = scan(depth, camera.k[0], camera.k[2], self._near, self._far, self._height)
        message = LaserScan(
            header=image.header,
            angle_min=fan.angle_min,
            angle_max=fan.angle_max,
            angle_increment=fan.angle_increment,
            scan_time=self._scan_time,
            range_min=self._near,
            range_max=self._far,
            ranges=fan.ranges,
        )
        message.header.frame_id = self._frame
        self._scans.publish(message)

    def _fault(self, image: Image, camera: CameraInfo) -> str:
        if image.encoding not in _METRES:
            return f"the depth image is encoded as '{image.encoding}', not as {', '.join(_METRES)}"
        if not camera.k[0]:
            return "the camera is not calibrated: its focal length is 0"
        return f"the parameter 'scan_height' is {self._height}, but the image has only {image.height} rows"


def main() -> int:
    """Run the node."""
    return run(DepthImageToLaserScan)
