"""Parameters of the graph's nodes, for clients that are not nodes themselves."""

from __future__ import annotations

import time
from collections.abc import Callable, Coroutine, Sequence
from concurrent.futures import Future
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future as RclpyFuture
from rclpy.task import Task

from daidalos.studio.source import Parameter, SourceError
from daidalos.transport.steady_timers import STEADY_TIMERS

Work = Callable[[AsyncParameterClient, str, list[str]], Coroutine[Any, Any, list[Parameter]]]

_MAX_SHOWN = 300
"""Number of characters of a reason that a client gets."""
_TIMEOUT_NS = 2_000_000_000
"""Time in which nodes answer; one that does not spin is not asked again before it has answered."""


class GraphParameters:
    """Client of other nodes' parameters.

    Parameters
    ----------
    node : Node
        It must be spun for parameters to be answered.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[str, AsyncParameterClient] = {}
        self._silent: dict[str, Task] = {}  # nodes that did not answer in time, and what waits for their answer

    def get(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        """Read parameters, named ``/node.parameter``; all of them where none is named."""
        return self._gather(
            _by_node(names) if names else {node.full_name: [] for node in self._node.handle.graph.nodes()}, self._read
        )

    def set(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        """Set parameters and read them again."""
        values = {parameter.name: parameter.value for parameter in parameters}

        async def write(client: AsyncParameterClient, node: str, names: list[str]) -> list[Parameter]:
            wanted: list[Any] = [RclpyParameter(name, value=values[f"{node}.{name}"]) for name in names]
            await client.set_parameters(wanted)
            return await self._read(client, node, names)

        return self._gather(_by_node(list(values)), write)

    def _gather(self, wanted: dict[str, list[str]], work: Work) -> Future[Sequence[Parameter]]:
        """Do some work with the parameters of every node, in the node's executor; silent nodes are left out."""
        answer: Future[Sequence[Parameter]] = Future()
        executor = self._node.executor
        if executor is None:
            answer.set_exception(SourceError("the node is not spun"))
            return answer

        async def gather() -> None:
            found: list[Parameter] = []
            failure: SourceError | None = None
            try:
                tasks = {
                    node: executor.create_task(self._ask, node, wanted[node], work) for node in self._asked(wanted)
                }
                await self._wait_for(list(tasks.values()))
                for node, task in tasks.items():
                    if task.done():
                        found += task.result()
                    else:
                        self._silent[node] = task
            except Exception as error:  # what a client asks for fails this request only
                failure = SourceError(f"parameters: {error}"[:_MAX_SHOWN])
            if not answer.set_running_or_notify_cancel():  # the client may be gone
                return
            if failure is None:
                answer.set_result(found)
            else:
                answer.set_exception(failure)

        executor.create_task(gather)
        return answer

    def _asked(self, wanted: dict[str, list[str]]) -> list[str]:
        """Return the wanted nodes that are in the graph and owe no answer; forget those that have left."""
        present = {node.full_name for node in self._node.handle.graph.nodes()}
        for node in [node for node in self._clients if node not in present]:
            self._silent.pop(node, None)
            for client in self._clients.pop(node)._clients.values():
                self._node.destroy_client(client)
        for node in [node for node, task in self._silent.items() if task.done()]:
            del self._silent[node]
        return [node for node in wanted if node in present and node not in self._silent]

    async def _ask(self, node: str, names: list[str], work: Work) -> list[Parameter]:
        client = self._client_of(node)
        return await work(client, node, names) if client.services_are_ready() else []

    async def _wait_for(self, tasks: list[Task]) -> None:
        """Wait until all tasks have ended, but not longer than for `_TIMEOUT_NS`."""
        ended = RclpyFuture(executor=self._node.executor)

        def end() -> None:
            if not ended.done():
                ended.set_result(None)

        if not tasks:
            return
        timeout = STEADY_TIMERS.at(time.monotonic_ns() + _TIMEOUT_NS, end)
        for task in tasks:
            task.add_done_callback(lambda _: end() if all(each.done() for each in tasks) else None)
        await ended
        timeout.cancel()

    def _client_of(self, node: str) -> AsyncParameterClient:
        if node not in self._clients:
            self._clients[node] = AsyncParameterClient(self._node, node)
        return self._clients[node]

    async def _read(self, client: AsyncParameterClient, node: str, names: list[str]) -> list[Parameter]:
        if not names:
            names = list((await client.list_parameters()).result.names)
        values = list((await client.get_parameters(names)).values)
        if len(values) != len(names) > 1:
            # A node answers with no value at all when one of the parameters has none.
            return [one for name in names for one in await self._read(client, node, [name])]
        return [
            Parameter(f"{node}.{name}", parameter_value_to_python(value))
            for name, value in zip(names, values, strict=False)
        ]


def _by_node(names: Sequence[str]) -> dict[str, list[str]]:
    """Group ``/node.parameter`` names by node."""
    found: dict[str, list[str]] = {}
    for name in names:
        node, _, parameter = name.partition(".")
        found.setdefault(node, []).append(parameter)
    return found
