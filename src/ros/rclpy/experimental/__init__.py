"""What ROS 2's newer distributions try out: an executor driven by events, and nodes for asyncio."""

from rclpy.experimental.events_executor import EventsExecutor

__all__ = ["EventsExecutor"]
