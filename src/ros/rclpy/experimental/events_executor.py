"""The executor that later distributions add; ours are all driven by events."""

from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future

_AFTER_TIME = 1000
"""How many callbacks that are ready may run once the time is up."""


class EventsExecutor(SingleThreadedExecutor):
    """Executor that runs callbacks one after the other in the thread that spins."""

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done or cancelled, or `timeout_sec` seconds have passed and none is ready."""
        super().spin_until_future_complete(future, timeout_sec)
        for _ in range(_AFTER_TIME):
            if future._pending_over() or self._ready.empty():
                return
            self.spin_once(0)
