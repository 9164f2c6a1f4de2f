"""The executor that later distributions add; ours are all driven by events."""

from rclpy.executors import SingleThreadedExecutor


class EventsExecutor(SingleThreadedExecutor):
    """Runs callbacks one after the other in the thread that spins."""
