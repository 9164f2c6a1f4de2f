"""`depthimage_to_laserscan_node`: publishes the middle rows of depth images as laser scans."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, LaserScan

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.depth_images import METRES
from daidalos.nodes.depthimage_to_laserscan._scan import scan
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run


@dataclass(frozen=True)
class DepthImageToLaserScanParameters(Parameters):
    """Parameters of ``depthimage_to_laserscan_node``."""

    scan_time: float = parameter(0.033, "Time between scans, as the messages say it.", unit="s", minimum=0.0)
    range_min: float = parameter(0.45, "Least distance of points.", unit="m", minimum=0.0)
    range_max: float = parameter(10.0, "Greatest distance of points.", unit="m", minimum=0.0)
    scan_height: int = parameter(1, "How many rows in the middle of the image count.", minimum=1)
    output_frame: str = parameter("camera_depth_frame", "Frame of the scans: x ahead, y to the left.")


class DepthImageToLaserScan(Node):
    """Node that publishes ``scan`` from ``depth`` and ``depth_camera_info`` while it has subscribers."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("depthimage_to_laserscan", **kwargs)
        self._settings = declare(self, DepthImageToLaserScanParameters)
        self._camera: CameraInfo | None = None
        self._bridge = CvBridge()
        self._scans = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_subscription(CameraInfo, "depth_camera_info", self._set_camera, qos_profile_sensor_data)
        self.create_subscription(Image, "depth", self._publish_scan, qos_profile_sensor_data)

    def _set_camera(self, camera: CameraInfo) -> None:
        self._camera = camera

    def _publish_scan(self, image: Image) -> None:
        camera = self._camera
        if camera is None or self._scans.get_subscription_count() == 0:
            return
        scale = METRES.get(image.encoding)
        if scale is None or not camera.k[0] or self._settings.scan_height > image.height:
            self.get_logger().error(self._fault(image, camera), throttle_duration_sec=5.0)
            return
        depth = np.asarray(self._bridge.imgmsg_to_cv2(image)) * scale
        fan = scan(
            depth,
            camera.k[0],
            camera.k[2],
            self._settings.range_min,
            self._settings.range_max,
            self._settings.scan_height,
        )
        message = LaserScan(
            header=image.header,
            angle_min=fan.angle_min,
            angle_max=fan.angle_max,
            angle_increment=fan.angle_increment,
            scan_time=self._settings.scan_time,
            range_min=self._settings.range_min,
            range_max=self._settings.range_max,
            ranges=fan.ranges,
        )
        message.header.frame_id = self._settings.output_frame
        self._scans.publish(message)

    def _fault(self, image: Image, camera: CameraInfo) -> str:
        if image.encoding not in METRES:
            return f"the depth image is encoded as '{image.encoding}', not as {', '.join(METRES)}"
        if not camera.k[0]:
            return "the camera is not calibrated: its focal length is 0"
        return (
            f"the parameter 'scan_height' is {self._settings.scan_height}, but the image has only {image.height} rows"
        )


def main() -> int:
    """Run the node."""
    return run(DepthImageToLaserScan)
