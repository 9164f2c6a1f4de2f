"""Drives ahead, and turns away from what is near."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class KeepDistance(Node):
    def __init__(self):
        super().__init__("keep_distance")
        self.distance = self.declare_parameter("distance", 0.6).value
        self.speed = self.declare_parameter("speed", 0.2).value
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        ahead = [
            distance
            for index, distance in enumerate(scan.ranges)
            if abs(scan.angle_min + index * scan.angle_increment) < math.radians(40)
        ]
        command = Twist()
        if min(ahead) > self.distance:
            command.linear.x = self.speed
        else:
            command.angular.z = 0.6
        self.publisher.publish(command)


def main():
    try:
        with rclpy.init():
            rclpy.spin(KeepDistance())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
