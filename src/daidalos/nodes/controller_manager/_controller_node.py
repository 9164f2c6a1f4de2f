"""Node of a controller: its parameters, topics, services and actions."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.task import Future

from daidalos.control.contracts import Action, Controller, Goal
from daidalos.nodes.controller_manager._entries import ActionEntry
from daidalos.nodes.controller_manager._messages import ACTIONS, SERVICES
from daidalos.nodes.parameters import declare, warn_of_undeclared
from daidalos.samples.messages import MESSAGES
from daidalos.samples.sensors import Sample


class ControllerNode(Node):
    """Node of a controller.

    Parameters
    ----------
    name, namespace : str
    arguments : list of str
        ROS arguments for this node, such as its parameter files.
    lock : lock
        Held by whoever touches the controller.
    **kwargs
        Of `Node`.
    """

    def __init__(self, name: str, namespace: str, arguments: list[str], lock: threading.RLock, **kwargs: Any) -> None:
        own_name = ["-r", f"__node:={name}", "-r", f"__ns:={namespace}"]
        super().__init__(name, namespace=namespace, cli_args=["--ros-args", *own_name, *arguments], **kwargs)
        self._lock = lock
        self._controller: Controller | None = None
        self._is_active: Callable[[], bool] = lambda: False
        self._outgoing: dict[str, tuple[Any, Callable[[Any], Any]]] = {}
        self._entities: list[Callable[[], Any]] = []
        self._goals: list[tuple[Any, Goal, Action]] = []

    def warn(self, line: str) -> None:
        """Log a line for the user."""
        self.get_logger().warning(line)

    # Parameters

    def read_parameters(self, kind: type) -> Any:
        """Declare a controller's parameters and return them.

        Raises
        ------
        ParameterError
            When a value is of the wrong type, or not allowed.
        """
        try:
            return declare(self, kind, reconfigure=self._reconfigure)
        finally:
            warn_of_undeclared(self)

    def _reconfigure(self, parameters: Any) -> None:
        if self._controller is not None:
            with self._lock:
                self._controller.reconfigure(parameters)

    # Topics

    def has_subscribers(self, topic: str) -> bool:
        """Return whether one of the controller's topics has subscribers."""
        entry = self._outgoing.get(topic)
        return entry is not None and entry[0].handle.has_subscribers

    def publish(self, sample: Sample) -> None:
        """Publish the controller's samples."""
        publisher, convert = self._outgoing[sample.topic]
        publisher.publish(convert(sample))

    def connect(self, controller: Controller, is_active: Callable[[], bool]) -> None:
        """Make a controller's topics, services and actions."""
        self.disconnect()
        self._controller, self._is_active = controller, is_active
        for topic, kind in controller.publications.items():
            outgoing = MESSAGES[kind]
            publisher = self.create_publisher(outgoing.message_class, topic, QoSProfile(depth=10))
            self._outgoing[topic] = (publisher, outgoing.to_message)
        for topic, subscription in controller.subscriptions.items():
            incoming = MESSAGES[subscription.type]
            take = self._taker(incoming.from_message, subscription.take)
            made = self.create_subscription(incoming.message_class, topic, take, QoSProfile(depth=10))
            self._entities.append(lambda made=made: self.destroy_subscription(made))  # type: ignore[misc]
        for name, service in controller.services.items():
            server = self.create_service(
                SERVICES[service.type].message(), name, self._answerer(service.type, service.answer)
            )
            self._entities.append(lambda server=server: self.destroy_service(server))  # type: ignore[misc]
        for name, action in controller.actions.items():
            self._entities.append(self._serve(name, action).destroy)

    def disconnect(self) -> None:
        """Remove them."""
        self._controller = None
        for destroy in self._entities:
            destroy()
        for publisher, _ in self._outgoing.values():
            self.destroy_publisher(publisher)
        self._entities.clear()
        self._outgoing.clear()

    def _taker(self, convert: Callable[[Any], Any], take: Callable[[Any], None]) -> Callable[[Any], None]:
        def callback(message: Any) -> None:
            command = convert(message)
            with self._lock:
                if self._is_active():
                    take(command)

        return callback

    def _answerer(self, kind: type, answer: Callable[[Any], Any]) -> Callable[[Any, Any], Any]:
        entry = SERVICES[kind]

        def callback(request: Any, response: Any) -> Any:
            question = entry.question(request)
            with self._lock:
                if not self._is_active():
                    if hasattr(response, "message"):
                        response.message = "the controller is not active"
                    return response
                return entry.fill(response, answer(question))

        return callback

    # Actions

    def cancel_requested(self) -> None:
        """Cancel the goals with cancel requests; called before a cycle, with the lock held."""
        for entry in [one for one in self._goals if one[0].is_cancel_requested]:
            self._goals.remove(entry)
            _, goal, action = entry
            action.cancel(goal)

    def _serve(self, name: str, action: Action) -> ActionServer:
        entry = ACTIONS[action.type]

        def on_goal(request: Any) -> GoalResponse:
            with self._lock:
                problem = action.refuse(entry.request(request)) if self._is_active() else "the controller is not active"
            if problem:
                self.get_logger().error(f"goal rejected: {problem}")
            return GoalResponse.REJECT if problem else GoalResponse.ACCEPT

        async def execute(goal_handle: Any) -> Any:
            return await self._execute(goal_handle, action, entry)

        return ActionServer(
            self,
            entry.message(),
            name,
            execute,
            goal_callback=on_goal,
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
        )

    async def _execute(self, goal_handle: Any, action: Action, entry: ActionEntry) -> Any:
        over = Future()
        goal = Goal(
            entry.request(goal_handle.request),
            lambda feedback: goal_handle.publish_feedback(entry.feedback(feedback)),
            lambda status, result: over.set_result((status, result)),
        )
        with self._lock:
            self._goals.append((goal_handle, goal, action))
            action.start(goal)
        status, result = await over
        with self._lock:
            self._goals = [one for one in self._goals if one[1] is not goal]
        if status == "succeeded":
            goal_handle.succeed()
        elif status == "canceled" and goal_handle.is_cancel_requested:
            goal_handle.canceled()
        else:
            goal_handle.abort()
        return entry.result(result)
