"""Tasks of a navigator: actions that it starts, monitors and cancels, and services that it calls."""

from __future__ import annotations

from enum import Enum
from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from rclpy.action import ActionClient
from rclpy.node import Node


class TaskResult(Enum):
    """Result of a task."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


class RunningTask(Enum):
    """Running task; every member counts as true."""

    NONE = 0
    NAVIGATE_TO_POSE = 1
    NAVIGATE_THROUGH_POSES = 2
    FOLLOW_PATH = 3
    FOLLOW_WAYPOINTS = 4
    FOLLOW_GPS_WAYPOINTS = 5
    SPIN = 6
    BACKUP = 7
    DRIVE_ON_HEADING = 8
    ASSISTED_TELEOP = 9
    DOCK_ROBOT = 10
    UNDOCK_ROBOT = 11
    COMPUTE_AND_TRACK_ROUTE = 12


_RESULTS = {
    GoalStatus.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.STATUS_ABORTED: TaskResult.FAILED,
    GoalStatus.STATUS_CANCELED: TaskResult.CANCELED,
}
_PEEK_S = 0.1
"""For how long a look at a task waits for its end."""


class Progress:
    """A task that was started: its goal, the future of its result and its feedback."""

    def __init__(self) -> None:
        self.goal_handle: Any = None
        self.result_future: Any = None
        self.feedback: list[Any] = []


class Tasks(Node):
    """A node that starts actions and calls services, one after the other, and spins itself meanwhile."""

    def __init__(self, node_name: str, namespace: str) -> None:
        super().__init__(node_name=node_name, namespace=namespace)
        self._main, self._route = Progress(), Progress()
        self._clients: dict[str, Any] = {}
        self._status: int | None = None
        self.last_action_error_code = 0
        self.last_action_error_msg = ""

    def cancelTask(self) -> None:
        """Cancel what runs, and wait until it is being cancelled."""
        self.info("Canceling current task.")
        for progress in (self._main, self._route):
            if progress.result_future is not None and not progress.result_future.done():
                self._finish(progress.goal_handle.cancel_goal_async())
        self.clearTaskError()

    def isTaskComplete(self, task: RunningTask = RunningTask.NONE) -> bool:
        """Return whether the task is over, after at most 0.1 s.

        Parameters
        ----------
        task
            What was returned when it was started; only routes run beside another task, so it may be left out.
        """
        progress = self._progress(task)
        if progress.result_future is None:
            return True
        rclpy.spin_until_future_complete(self, progress.result_future, timeout_sec=_PEEK_S)
        if not progress.result_future.done():
            return False
        answer = progress.result_future.result()
        self._status = answer.status
        if answer.status != GoalStatus.STATUS_SUCCEEDED:
            self.setTaskError(getattr(answer.result, "error_code", 0), getattr(answer.result, "error_msg", ""))
            self.debug(f"Task with failed status code: {answer.status}")
        return True

    def getFeedback(self, task: RunningTask = RunningTask.NONE) -> Any:
        """Return the last feedback of a task, None where there is none; of a route the oldest that was not returned."""
        feedback = self._progress(task).feedback
        if task is RunningTask.COMPUTE_AND_TRACK_ROUTE:
            return feedback.pop(0) if feedback else None
        return feedback[-1] if feedback else None

    def getResult(self) -> TaskResult:
        """Return how the last task ended."""
        return TaskResult.UNKNOWN if self._status is None else _RESULTS.get(self._status, TaskResult.UNKNOWN)

    def clearPreviousState(self) -> None:
        """Clear the state of the task before."""
        self._main, self._route, self._status = Progress(), Progress(), None
        self.clearTaskError()

    def setTaskError(self, error_code: int, error_msg: str) -> None:
        """Set the error of a task."""
        self.last_action_error_code, self.last_action_error_msg = error_code, error_msg

    def clearTaskError(self) -> None:
        """Clear the error of a task."""
        self.setTaskError(0, "")

    def getTaskError(self) -> tuple[int, str]:
        """Return why the last task failed: a number of its action, and words."""
        return self.last_action_error_code, self.last_action_error_msg

    def info(self, msg: str) -> None:
        """Log how it goes."""
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log what may go wrong."""
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log what went wrong."""
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log what may help to find a mistake."""
        self.get_logger().debug(msg)

    # Starting and calling.

    def _start(self, task: RunningTask, kind: Any, name: str, **fields: Any) -> RunningTask | None:
        """Start an action; returns `task`, None where the server does not want it."""
        self.clearTaskError()
        self._status = None
        progress = Progress()
        client = self._action_client(kind, name)

        def note(message: Any) -> None:
            progress.feedback.append(message.feedback)
            if task is not RunningTask.COMPUTE_AND_TRACK_ROUTE:
                del progress.feedback[:-1]

        handle = self._finish(client.send_goal_async(_goal(kind, fields), note))
        if not handle.accepted:
            self.setTaskError(0, f"{name} request was rejected!")
            self.error(self.last_action_error_msg)
            return None
        progress.goal_handle, progress.result_future = handle, handle.get_result_async()
        if task is RunningTask.COMPUTE_AND_TRACK_ROUTE:
            self._route = progress
        else:
            self._main = progress
        return task

    def _ask(self, kind: Any, name: str, **fields: Any) -> Any:
        """Send a goal, and return its result; None where it failed or was rejected."""
        self.clearTaskError()
        handle = self._finish(self._action_client(kind, name).send_goal_async(_goal(kind, fields)))
        if not handle.accepted:
            self.setTaskError(0, f"{name} request was rejected!")
            self.error(self.last_action_error_msg)
            return None
        answer = self._finish(handle.get_result_async())
        self._status = answer.status
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return answer.result
        self.setTaskError(answer.result.error_code, answer.result.error_msg)
        self.warn(f"{name} failed with error code {answer.result.error_code}: {answer.result.error_msg}")
        return None

    def _call(self, kind: Any, name: str, **fields: Any) -> Any:
        """Return the response of a service, for which it waits."""
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = self.create_client(kind, name)
        while not client.wait_for_service(timeout_sec=1.0):
            self.info(f"{name} service not available, waiting...")
        return self._finish(client.call_async(kind.Request(**fields)))

    def _action_client(self, kind: Any, name: str) -> Any:
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = ActionClient(self, kind, name)
        while not client.wait_for_server(timeout_sec=1.0):
            self.info(f"'{name}' action server not available, waiting...")
        return client

    def _finish(self, future: Any) -> Any:
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def _progress(self, task: RunningTask) -> Progress:
        return self._route if task is RunningTask.COMPUTE_AND_TRACK_ROUTE else self._main

    def _destroy_clients(self) -> None:
        for client in self._clients.values():
            if isinstance(client, ActionClient):
                client.destroy()
        self._clients.clear()


def duration(seconds: float) -> Duration:
    """Return seconds as a message."""
    whole = int(seconds)
    return Duration(sec=whole, nanosec=round((seconds - whole) * 1e9))


def _goal(kind: Any, fields: dict[str, Any]) -> Any:
    """Return a goal; a field that is None is left as it is, also where the action has no such field."""
    return kind.Goal(**{name: value for name, value in fields.items() if value is not None})
