"""Action servers."""

from __future__ import annotations

import traceback
from collections import deque
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any

from rclpy.action._action_end import ActionEnd, ActionQoS
from rclpy.action._expiry import Expiry
from rclpy.action._goal_state import GoalEvent, GoalState
from rclpy.action._server_goal import ServerGoalHandle as ServerGoalHandle
from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import PublisherHandle, ServiceHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from rclpy.task import Future
from rclpy.waitable import NumberOfEntities

if TYPE_CHECKING:
    from rclpy.node import Node


class GoalResponse(Enum):
    """Answers to a goal."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Answers to a wish to cancel."""

    REJECT = 1
    ACCEPT = 2


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute the goal at once."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Reject the cancellation."""
    return CancelResponse.REJECT


class ActionServer(ActionEnd):
    """Server of an action.

    Parameters
    ----------
    node
        The node to serve with.
    action_type
        Class of the action.
    action_name
        Its name, relative to the node unless it begins with a slash.
    execute_callback
        ``callback(goal_handle) -> result``: carries a goal out. None where `handle_accepted_callback` takes care.
    callback_group
        The node's default where None.
    goal_callback
        ``callback(goal) -> GoalResponse``: accepts or rejects.
    handle_accepted_callback
        ``callback(goal_handle)``: called with every accepted goal; carries it out at once by default.
    cancel_callback
        ``callback(goal_handle) -> CancelResponse``: accepts or rejects the cancellation of a goal.
    goal_service_qos_profile, result_service_qos_profile, cancel_service_qos_profile,
    feedback_pub_qos_profile, \
status_pub_qos_profile
        Quality of service of the parts.
    result_timeout
        How long results are kept, in seconds; for ever where negative.
    """

    role = "action server"
    _goal_end: ServiceHandle
    _cancel_end: ServiceHandle
    _result_end: ServiceHandle
    _feedback_end: PublisherHandle
    _status_end: PublisherHandle

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any] | None = None,
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], GoalResponse] = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], None] = default_handle_accepted_callback,
        cancel_callback: Callable[[Any], CancelResponse] = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,
    ) -> None:
        # Before anything is made that would have to be undone: they may refuse.
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self._execute_callback: Callable[[ServerGoalHandle], Any] | None = None
        if execute_callback is not None:
            self.register_execute_callback(execute_callback)
        qos = ActionQoS(
            goal_service_qos_profile,
            cancel_service_qos_profile,
            result_service_qos_profile,
            feedback_pub_qos_profile,
            status_pub_qos_profile,
        )
        super().__init__(node, action_type, action_name, callback_group, ServiceHandle, PublisherHandle, qos)
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._result_futures: dict[bytes, Future] = {}
        self._result_timeout = result_timeout
        self._sources = (
            (self._goal_end, self._execute_goal_request),
            (self._cancel_end, self._execute_cancel_request),
            (self._result_end, self._execute_get_result_request),
        )
        self._rcl_serves = frozenset(service.name for service in self._services)
        self._waiting_goals: deque[tuple[ServerGoalHandle, Callable[[ServerGoalHandle], Any]]] = deque()
        self._expiry = Expiry(self, node)
        for service in self._services:
            service.set_on_ready(self._rcl_hook)
        node.add_waitable(self)

    # The executor's side.

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        if self._waiting_goals:
            return self.notify_execute, self._waiting_goals.popleft()
        for service, callback in self._sources:
            taken = service.take_request()
            if taken is not None:
                return callback, taken
        return None

    def _rcl_has_more(self) -> bool:
        return bool(self._waiting_goals) or any(len(service.impl) for service in self._services)

    def get_num_entities(self) -> NumberOfEntities:
        """Return three services and a timer."""
        return NumberOfEntities(0, 0, 1, 0, 3)

    # Goals.

    async def _execute_goal_request(self, request: Any, header: Any) -> None:
        from action_msgs.msg import GoalInfo

        key = bytes(request.goal_id.uuid)
        response = self._action_type.Impl.SendGoalService.Response(accepted=False)
        goal_info = GoalInfo(goal_id=request.goal_id, stamp=self._action_node.get_clock().now().to_msg())
        self._logger.debug(f"New goal request with ID: {key.hex()}")
        with self._lock:
            known = key in self._goal_handles
        if known:
            self._logger.error(f"Goal with ID {key.hex()} was offered before")
        else:
            response.accepted = await self._is_accepted(request.goal)
        response.stamp = goal_info.stamp
        goal_handle = None
        if response.accepted:
            goal_handle = ServerGoalHandle(self, goal_info, request.goal)
            with self._lock:
                self._goal_handles[key] = goal_handle
                self._result_futures[key] = Future()
        self._goal_end.send_response(response, header)
        if goal_handle is None:
            self._logger.debug(f"New goal rejected: {key.hex()}")
            return
        self._logger.debug(f"New goal accepted: {key.hex()}")
        self._publish_status()
        self._handle_accepted_callback(goal_handle)

    async def _is_accepted(self, goal: Any) -> bool:
        try:
            answer = self._goal_callback(goal)
            if hasattr(answer, "__await__"):
                answer = await answer
        except Exception as error:
            self._logger.error(f"Error raised in goal callback: {error}")
            traceback.print_exc()
            return False
        if not isinstance(answer, GoalResponse):
            self._logger.warning(f"Goal callback did not return a valid response value: {answer!r}")
        return answer == GoalResponse.ACCEPT

    async def _execute_goal(self, execute_callback: Callable[[ServerGoalHandle], Any], goal_handle: Any) -> None:
        key = bytes(goal_handle.goal_id.uuid)
        self._logger.debug(f"Executing goal with ID {key.hex()}")
        try:
            result = execute_callback(goal_handle)
            if hasattr(result, "__await__"):
                result = await result
        except Exception as error:
            self._logger.error(f"Error raised in execute callback: {error}")
            traceback.print_exc()
            result = None
        if goal_handle.is_active:
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {key.hex()}")
            goal_handle.abort()
        if goal_handle._response is not None:
            return
        if not isinstance(result, self._action_type.Result):
            if result is not None:
                self._logger.error(f"Execute callback returned {type(result)}, expected {self._action_type.Result}")
            result = self._action_type.Result()
        self._set_result(goal_handle, result)

    def _set_result(self, goal_handle: ServerGoalHandle, result: Any) -> None:
        future = self._result_futures.get(bytes(goal_handle.goal_id.uuid))
        if future is None or future.done():
            return
        response = self._action_type.Impl.GetResultService.Response()
        response.status = goal_handle.status
        response.result = result
        future.set_result(response)

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Execute a goal by the node's executor, or by the next one that runs the node."""
        callback = execute_callback or self._execute_callback
        if callback is None:
            raise RuntimeError("the action server has no execute_callback, and none was given")
        executor = self._action_node.executor
        if executor is not None:
            executor.create_task(self._execute_goal, callback, goal_handle)
        else:
            self._waiting_goals.append((goal_handle, callback))
            self._rcl_hook()

    def notify_goal_done(self) -> None:
        """Schedule the expiry of a goal that is over."""
        self._expiry.plan()

    # Cancelling.

    async def _execute_cancel_request(self, request: Any, header: Any) -> None:
        from action_msgs.srv import CancelGoal

        response = CancelGoal.Response()
        with self._lock:
            wanted, response.return_code = self._goals_to_cancel(request.goal_info)
        for goal_handle in wanted:
            if await self._is_cancel_accepted(goal_handle) and _is_cancelable(goal_handle):
                goal_handle._update_state(GoalEvent.CANCEL_GOAL)
                response.goals_canceling.append(goal_handle._goal_info)
        if wanted and not response.goals_canceling:
            response.return_code = CancelGoal.Response.ERROR_REJECTED
        self._cancel_end.send_response(response, header)

    def _goals_to_cancel(self, info: Any) -> tuple[list[ServerGoalHandle], int]:
        """Return the goals that a request means: one by its identity, all up to a time, both, or all."""
        from action_msgs.srv import CancelGoal

        key = bytes(info.goal_id.uuid)
        stamp = (info.stamp.sec, info.stamp.nanosec)
        goals = [goal for goal in self._goal_handles.values() if _is_cancelable(goal)]
        if any(key):
            one = self._goal_handles.get(key)
            if one is None:
                return [], CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
            if stamp == (0, 0):
                if not _is_cancelable(one):
                    return [], CancelGoal.Response.ERROR_GOAL_TERMINATED
                return [one], CancelGoal.Response.ERROR_NONE
        elif stamp == (0, 0):
            return goals, CancelGoal.Response.ERROR_NONE
        chosen = [goal for goal in goals if _stamp(goal) <= stamp or bytes(goal.goal_id.uuid) == key]
        return chosen, CancelGoal.Response.ERROR_NONE

    async def _is_cancel_accepted(self, goal_handle: ServerGoalHandle) -> bool:
        try:
            answer = self._cancel_callback(goal_handle)
            if hasattr(answer, "__await__"):
                answer = await answer
        except Exception as error:
            self._logger.error(f"Error raised in cancel callback: {error}")
            traceback.print_exc()
            return False
        return answer == CancelResponse.ACCEPT and goal_handle.is_active

    # Results.

    async def _execute_get_result_request(self, request: Any, header: Any) -> None:
        key = bytes(request.goal_id.uuid)
        with self._lock:
            future = self._result_futures.get(key)
        if future is None:
            self._logger.debug(f"Sending result response for unknown goal ID: {key.hex()}")
            response = self._action_type.Impl.GetResultService.Response()
            response.status = GoalState.UNKNOWN
            self._result_end.send_response(response, header)
            return
        future.on_wake(lambda: self._send_result(future, header))

    def _send_result(self, future: Future, header: Any) -> None:
        if not self._destroyed and future.done():
            self._result_end.send_response(future.result(), header)

    def _now_ns(self) -> int:
        """Return the time that results age by: the node's, which a simulator may give."""
        return self._action_node.get_clock().now().nanoseconds

    def _forget(self, key: bytes) -> None:
        with self._lock:
            self._goal_handles.pop(key, None)
            self._result_futures.pop(key, None)

    def expire_goals(self) -> None:
        """Remove the goals whose results were kept long enough."""
        if self._result_timeout < 0:
            return
        limit = self._now_ns() - int(self._result_timeout * 1e9)
        with self._lock:
            expired = [
                key for key, goal in self._goal_handles.items() if goal.ended_ns is not None and goal.ended_ns <= limit
            ]
            for key in expired:
                self._goal_handles[key]._destroyed = True
                self._forget(key)
        if expired:
            self._publish_status()
        self._expiry.plan()

    def _publish_status(self) -> None:
        from action_msgs.msg import GoalStatus, GoalStatusArray

        with self._lock:
            goals = list(self._goal_handles.values())
        if self._destroyed:
            return
        statuses = [GoalStatus(goal_info=goal._goal_info, status=goal.status) for goal in goals]
        self._status_end.impl.publish(GoalStatusArray(status_list=statuses))

    # Callbacks.

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], None] | None
    ) -> None:
        """Set what is called with accepted goals; the default where None."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[[Any], GoalResponse] | None) -> None:
        """Set what accepts or rejects goals; the default where None."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[[Any], CancelResponse] | None) -> None:
        """Set the callback that accepts or rejects cancellation; the default where None."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], Any]) -> None:
        """Set what carries goals out.

        Raises
        ------
        TypeError
            When it cannot be called.
        """
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def destroy(self) -> None:
        """Stop serving; goals that are not over end as they are."""
        if self._destroyed:
            return
        super().destroy()
        self._expiry.close()
        with self._lock:
            self._goal_handles.clear()
            self._result_futures.clear()


def _is_cancelable(goal: ServerGoalHandle) -> bool:
    return goal.is_active and not goal.is_cancel_requested


def _stamp(goal: ServerGoalHandle) -> tuple[int, int]:
    stamp = goal._goal_info.stamp
    return stamp.sec, stamp.nanosec


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "action_msgs.msg": ("GoalInfo", "GoalStatus"),
            "action_msgs.srv": ("CancelGoal",),
            "rclpy.executors": ("await_or_execute",),
            "rclpy.type_support": ("check_for_type_support",),
            "rclpy.waitable": ("Waitable",),
        },
    )
