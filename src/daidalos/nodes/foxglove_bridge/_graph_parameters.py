"""The parameters of the graph's nodes for the studio's clients."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient

from daidalos.studio.source import Parameter, SourceError

_MAX_SHOWN = 300
"""Number of characters of a reason that a client gets."""


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

    def _gather(self, wanted: dict[str, list[str]], work: Callable[..., Any]) -> Future[Sequence[Parameter]]:
        """Do some work with the parameters of every node, in the node's executor."""
        answer: Future[Sequence[Parameter]] = Future()
        executor = self._node.executor
        if executor is None:
            answer.set_exception(SourceError("the bridge is not running"))
            return answer

        async def gather() -> None:
            found: list[Parameter] = []
            failure: SourceError | None = None
            try:
                present = {node.full_name for node in self._node.handle.graph.nodes()}
                for node in (name for name in wanted if name in present):
                    client = self._client_of(node)
                    if client.services_are_ready():
                        found += await work(client, node, wanted[node])
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

    def _client_of(self, node: str) -> AsyncParameterClient:
        if node not in self._clients:
            self._clients[node] = AsyncParameterClient(self._node, node)
        return self._clients[node]

    async def _read(self, client: AsyncParameterClient, node: str, names: list[str]) -> list[Parameter]:
        if not names:
            names = list((await client.list_parameters()).result.names)
        values = (await client.get_parameters(names)).values
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
