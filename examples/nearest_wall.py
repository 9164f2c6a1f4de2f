"""Tells how near the nearest wall is, and on which side."""

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class NearestWall(Node):
    def __init__(self):
        super().__init__("nearest_wall")
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        distance, index = min((distance, index) for index, distance in enumerate(scan.ranges))
        angle = math.degrees(scan.angle_min + index * scan.angle_increment)
        self.get_logger().info(f"{distance:.2f} m at {angle:+.0f} deg", throttle_duration_sec=1.0)


def main():
    try:
        with rclpy.init():
            rclpy.spin(NearestWall())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
