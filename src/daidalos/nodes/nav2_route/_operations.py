"""Operations on the way along a route, with what they publish and call."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rclpy.node import Node
from rosidl_runtime_py.set_message import set_message_fields
from rosidl_runtime_py.utilities import get_message, get_service

from daidalos.common.suggestions import hint
from daidalos.navigation.errors import OperationFailed
from daidalos.navigation.routes.contracts import (
    ON_GRAPH,
    ON_STATUS_CHANGE,
    Message,
    OperationResult,
    Progress,
    RouteOperation,
)
from daidalos.navigation.routes.graph import GraphOperation, RouteGraph
from daidalos.nodes.cycles import wait_until

SERVICE_TIMEOUT_S = 5.0
"""How long [s] a service of an operation may take to appear and to answer."""

_POLL_HZ = 20.0


@dataclass
class Outcome:
    """Outcome of all operations of a cycle: which ones acted, and whether and around what to route anew."""

    triggered: list[str] = field(default_factory=list)
    reroute: bool = False
    blocked: set[int] = field(default_factory=set)


class Operations:
    """Operations of a route server.

    Parameters
    ----------
    node : Node
        Publishes and calls services.
    operations : mapping of str to RouteOperation
        By their names in parameter files.
    """

    def __init__(self, node: Node, operations: Mapping[str, RouteOperation]) -> None:
        self._node = node
        self._operations = operations
        self._publishers: dict[str, Any] = {}
        self._clients: dict[str, Any] = {}

    def unknown(self, graph: RouteGraph) -> str:
        """Return which operations of a graph are not loaded, in words; empty where all are."""
        operations = [one.operations for one in graph.nodes.values()] + [one.operations for one in graph.edges]
        asked = {one.type for several in operations for one in several}
        return ", ".join(sorted(asked - self._on_graph().keys()))

    def _on_graph(self) -> dict[str, RouteOperation]:
        return {name: one for name, one in self._operations.items() if one.occasion == ON_GRAPH}

    async def process(self, progress: Progress, *, has_changed: bool, is_over: Callable[[], bool]) -> Outcome:
        """Carry out what is due.

        Parameters
        ----------
        progress : Progress
        has_changed : bool
            Whether a node was achieved.
        is_over : callable
            Returns whether to wait no longer for services.

        Raises
        ------
        OperationFailed
        """
        outcome = Outcome()
        if has_changed:
            for asked in _asked(progress):
                await self._perform(self._named(asked), asked.type, progress, asked.metadata, outcome, is_over)
        for name, operation in self._operations.items():
            if operation.occasion != ON_GRAPH and (has_changed or operation.occasion != ON_STATUS_CHANGE):
                await self._perform(operation, name, progress, {}, outcome, is_over)
        return outcome

    def _named(self, asked: GraphOperation) -> RouteOperation:
        known = self._on_graph()
        if asked.type not in known:
            raise OperationFailed(
                f"the graph asks for the operation '{asked.type}', which is not among the route server's "
                f"'operations'{hint(asked.type, list(known))}"
            )
        return known[asked.type]

    async def _perform(
        self,
        operation: RouteOperation,
        name: str,
        progress: Progress,
        metadata: Mapping[str, Any],
        outcome: Outcome,
        is_over: Callable[[], bool],
    ) -> None:
        now = self._node.get_clock().now().nanoseconds * 1e-9
        result = operation.perform(progress, now, metadata)
        for message in result.published:
            self._publish(message)
        if result.called is not None:
            await self._call(result.called, name, is_over)
        if result != OperationResult() or operation.occasion == ON_GRAPH:
            outcome.triggered.append(name)
        outcome.reroute |= result.reroute
        outcome.blocked.update(result.blocked)

    def _publish(self, message: Message) -> None:
        kind = get_message(message.type)
        if message.name not in self._publishers:
            self._publishers[message.name] = self._node.create_publisher(kind, message.name, 1)
        filled = kind()
        set_message_fields(filled, dict(message.fields))
        self._publishers[message.name].publish(filled)

    async def _call(self, message: Message, name: str, is_over: Callable[[], bool]) -> None:
        kind = get_service(message.type)
        if message.name not in self._clients:
            self._clients[message.name] = self._node.create_client(kind, message.name)
        client = self._clients[message.name]
        if not await self._wait(lambda: client.service_is_ready() or is_over()):
            raise OperationFailed(f"{name}: the service {message.name} is not there")
        if is_over():
            return
        request = kind.Request()
        set_message_fields(request, dict(message.fields))
        answer = client.call_async(request)
        if not await self._wait(lambda: answer.done() or is_over()):
            raise OperationFailed(f"{name}: the service {message.name} did not answer within {SERVICE_TIMEOUT_S:g} s")
        if answer.done() and not answer.result().success:
            reason = getattr(answer.result(), "message", "")
            raise OperationFailed(f"{name}: the service {message.name} failed{f': {reason}' if reason else ''}")

    async def _wait(self, condition: Callable[[], bool]) -> bool:
        return await wait_until(condition, self._node, _POLL_HZ, SERVICE_TIMEOUT_S)


def _asked(progress: Progress) -> list[GraphOperation]:
    """Return the operations that the graph asks for where a node was achieved."""
    places: tuple[tuple[Any, str], ...] = (
        (progress.node, "NODE"),
        (progress.edge, "ON_ENTER"),
        (progress.left, "ON_EXIT"),
    )
    return [one for place, trigger in places if place is not None for one in place.operations if one.trigger == trigger]
