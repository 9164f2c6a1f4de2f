"""Action clients."""

from __future__ import annotations

import uuid
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.action._action_end import ActionEnd, ActionQoS
from rclpy.action._client_goal import ClientGoalHandle as ClientGoalHandle
from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import ClientHandle, SubscriptionHandle
from rclpy.impl.errors import InvalidHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.running import wait_for
from rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from rclpy.task import Future
from rclpy.waitable import NumberOfEntities

if TYPE_CHECKING:
    from rclpy.node import Node


class ActionClient(ActionEnd):
    """Client of an action, which sends goals to its server.

    Parameters
    ----------
    node
        The node to call with.
    action_type
        Class of the action.
    action_name
        Its name, relative to the node unless it begins with a slash.
    callback_group
        The node's default where None.
    goal_service_qos_profile, result_service_qos_profile, cancel_service_qos_profile,
    feedback_sub_qos_profile, \
status_sub_qos_profile
        Quality of service of the parts.
    """

    role = "action client"
    _goal_end: ClientHandle
    _cancel_end: ClientHandle
    _result_end: ClientHandle
    _feedback_end: SubscriptionHandle
    _status_end: SubscriptionHandle
    _services: tuple[ClientHandle, ...]

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        qos = ActionQoS(
            goal_service_qos_profile,
            cancel_service_qos_profile,
            result_service_qos_profile,
            feedback_sub_qos_profile,
            status_sub_qos_profile,
        )
        super().__init__(node, action_type, action_name, callback_group, ClientHandle, SubscriptionHandle, qos)
        self._own_waiters = 0
        self._goal_handles: dict[bytes, weakref.ref[ClientGoalHandle]] = {}
        self._pending_goal_requests: dict[int, Future] = {}
        self._goal_sequence_number_to_goal_id: dict[int, Any] = {}
        self._pending_cancel_requests: dict[int, Future] = {}
        self._pending_result_requests: dict[int, Future] = {}
        self._result_sequence_number_to_goal_id: dict[int, Any] = {}
        self._feedback_callbacks: dict[bytes, Callable[[Any], None]] = {}
        # In the order in which they are looked at: feedback comes before the result that ends it.
        self._sources = (
            (self._goal_end, self._on_goal_response),
            (self._cancel_end, self._on_cancel_response),
            (self._feedback_end, self._on_feedback),
            (self._status_end, self._on_status),
            (self._result_end, self._on_result_response),
        )
        for source, _ in self._sources:
            source.set_on_ready(self._on_ready)
        node.add_waitable(self)

    # The executor's side.

    def _on_ready(self) -> None:
        """Process at once what a blocking call waits for, which may hold up the executor, or make the client ready."""
        if not self._own_waiters:
            self._rcl_hook()
            return
        work = self._rcl_take()
        while work is not None:
            work[0](*work[1])
            work = self._rcl_take()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        for source, callback in self._sources:
            if not len(source.impl):
                continue
            if isinstance(source, ClientHandle):
                response = source.take_response()
                if response is not None:
                    return callback, response
            else:
                sample = source.impl.take()
                if sample is not None:
                    return callback, sample[:1]
        return None

    def _rcl_take_unbound(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a response, which only finishes a future; a result waits for the feedback that came before it."""
        for source, callback in self._sources:
            if source is self._result_end and len(self._feedback_end.impl):
                return None
            taken = source.take_response() if isinstance(source, ClientHandle) else None
            if taken is not None:
                return callback, taken
        return None

    def _rcl_has_more(self) -> bool:
        return any(len(source.impl) for source, _ in self._sources)

    def get_num_entities(self) -> NumberOfEntities:
        """Return two subscriptions and three clients."""
        return NumberOfEntities(2, 0, 0, 3, 0)

    def _finish(self, pending: dict[int, Future], number: int, result: Any, what: str) -> None:
        future = pending.pop(number, None)
        if future is None:
            self._logger.warning(
                f"Ignoring unexpected {what} response. There may be more than one action server for the action "
                f"'{self._action_name}'"
            )
            return
        future._set_executor(self._action_node.executor)
        future.set_result(result)

    def _on_goal_response(self, header: Any, response: Any) -> None:
        number = header.request_id.sequence_number
        with self._lock:
            goal_id = self._goal_sequence_number_to_goal_id.pop(number, None)
        if goal_id is None:
            self._finish(self._pending_goal_requests, number, None, "goal")
            return
        goal_handle = ClientGoalHandle(self, goal_id, response)
        if goal_handle.accepted:
            with self._lock:
                self._goal_handles[bytes(goal_id.uuid)] = weakref.ref(goal_handle)
        else:
            self._feedback_callbacks.pop(bytes(goal_id.uuid), None)
        self._finish(self._pending_goal_requests, number, goal_handle, "goal")

    def _on_cancel_response(self, header: Any, response: Any) -> None:
        self._finish(self._pending_cancel_requests, header.request_id.sequence_number, response, "cancel")

    def _on_result_response(self, header: Any, response: Any) -> None:
        number = header.request_id.sequence_number
        with self._lock:
            goal_id = self._result_sequence_number_to_goal_id.pop(number, None)
        if goal_id is not None:
            self._end_goal(goal_id, response.status)
        self._finish(self._pending_result_requests, number, response, "result")

    def _end_goal(self, goal_id: Any, status: int) -> None:
        key = bytes(goal_id.uuid)
        with self._lock:
            reference = self._goal_handles.pop(key, None)
            self._feedback_callbacks.pop(key, None)
        goal_handle = reference() if reference is not None else None
        if goal_handle is not None:
            goal_handle._status = status

    def _on_feedback(self, message: Any) -> Any:
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        return callback(message) if callback is not None else None

    def _on_status(self, message: Any) -> None:
        for status in message.status_list:
            key = bytes(status.goal_info.goal_id.uuid)
            reference = self._goal_handles.get(key)
            goal_handle = reference() if reference is not None else None
            if goal_handle is not None:
                goal_handle._status = status.status
            elif reference is not None:
                self._goal_handles.pop(key, None)

    # Calls.

    def _generate_random_uuid(self) -> Any:
        from unique_identifier_msgs.msg import UUID

        return UUID(uuid=list(uuid.uuid4().bytes))

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal and wait for its result: an object with ``status`` and ``result``.

        Returns None when the server rejects the goal. It needs no executor.

        Raises
        ------
        TypeError
            When the goal is of the wrong type.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError()
        goal_handle = self._wait(lambda: self.send_goal_async(goal, **kwargs))
        if not goal_handle.accepted:
            return None
        return self._get_result(goal_handle)

    def _wait(self, call: Callable[[], Future], timeout_s: float | None = None) -> Any:
        """Return the result of a call's future, taking care of responses ourselves meanwhile; None when it is late."""
        with self._lock:
            self._own_waiters += 1
        try:
            future = call()
            wait_for(future, self._action_node.context, [service.name for service in self._services], timeout_s)
        finally:
            with self._lock:
                self._own_waiters -= 1
        return future.result()

    def send_goal_async(
        self,
        goal: Any,
        feedback_callback: Callable[[Any], None] | None = None,
        goal_uuid: Any = None,
    ) -> Future:
        """Send a goal; the future's result will be a `ClientGoalHandle`.

        Parameters
        ----------
        goal
            The goal.
        feedback_callback
            Called with every feedback message.
        goal_uuid
            The goal's identity; a random one where None.

        Raises
        ------
        TypeError
            When the goal is of the wrong type.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError()
        request = self._action_type.Impl.SendGoalService.Request()
        request.goal_id = self._generate_random_uuid() if goal_uuid is None else goal_uuid
        request.goal = goal
        future = Future()
        with self._lock:
            if feedback_callback is not None:
                self._feedback_callbacks[bytes(request.goal_id.uuid)] = feedback_callback
            number = self._goal_end.send_request(request)
            if number in self._pending_goal_requests:
                raise RuntimeError(f"Sequence ({number}) conflicts with pending goal request")
            self._pending_goal_requests[number] = future
            self._goal_sequence_number_to_goal_id[number] = request.goal_id
        return future

    def _cancel_goal(self, goal_handle: ClientGoalHandle) -> Any:
        return self._wait(lambda: self._cancel_goal_async(goal_handle))

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle) -> Future:
        from action_msgs.srv import CancelGoal

        if not isinstance(goal_handle, ClientGoalHandle):
            raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
        request = CancelGoal.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        future = Future()
        with self._lock:
            self._pending_cancel_requests[self._cancel_end.send_request(request)] = future
        return future

    def _get_result(self, goal_handle: ClientGoalHandle) -> Any:
        return self._wait(lambda: self._get_result_async(goal_handle))

    def _get_result_async(self, goal_handle: ClientGoalHandle) -> Future:
        if not isinstance(goal_handle, ClientGoalHandle):
            raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
        request = self._action_type.Impl.GetResultService.Request()
        request.goal_id = goal_handle.goal_id
        future = Future()
        with self._lock:
            number = self._result_end.send_request(request)
            self._pending_result_requests[number] = future
            self._result_sequence_number_to_goal_id[number] = goal_handle.goal_id
        return future

    def server_is_ready(self) -> bool:
        """Return whether the action is served."""
        if self._destroyed:
            raise InvalidHandle("the action client was destroyed")
        served = all(service.service_server_is_available() for service in self._services)
        return served and bool(self._feedback_end.get_publisher_count())

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until the action is served; False when `timeout_sec` seconds pass, or at a shutdown."""
        if self.server_is_ready():
            return True
        graph = self._goal_end.node.graph
        context = self._action_node.context
        limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        graph.wait_for(lambda: not context.ok() or self.server_is_ready(), limit)
        return self.server_is_ready()


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "action_msgs.msg": ("GoalStatus",),
            "action_msgs.srv": ("CancelGoal",),
            "rclpy.executors": ("await_or_execute",),
            "rclpy.type_support": ("check_for_type_support",),
            "rclpy.waitable": ("Waitable",),
            "unique_identifier_msgs.msg": ("UUID",),
        },
    )
