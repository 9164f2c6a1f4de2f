"""Protocol between the daemon and its clients: one line of JSON per request and response."""

from __future__ import annotations

import dataclasses
import json
import socket
from pathlib import Path
from typing import Any

from daidalos.transport.environment import Environment, read_environment
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Durability, History, Liveliness, Qos, Reliability
from daidalos.transport.registry import Registry, runtime_folder

MAX_QUESTION = 4096


@dataclasses.dataclass(frozen=True)
class Address:
    """Local port of a daemon, and the secret that authorizes requests."""

    port: int
    token: str


class AddressFile:
    """File with the address of a domain's daemon.

    Parameters
    ----------
    environment
        What the environment variables say; each middleware and discovery range has a daemon of its own.
    """

    def __init__(self, environment: Environment | None = None) -> None:
        self.environment = environment or read_environment()
        # A registry of its own beside the sessions': it brings the folder and its lock.
        self._registry = Registry(self.environment.domain, runtime_folder() / "ros2cli")
        self.locked = self._registry.locked

    @property
    def file(self) -> Path:
        """Path of the file."""
        where = self.environment
        peers = "_".join(peer.replace("/", "-").replace(":", "-") for peer in where.static_peers)
        return self._registry.folder / f"daemon-{where.middleware}-{where.discovery.value}-{peers}.json"

    def read(self) -> Address | None:
        """Return the address in the file, None without one."""
        try:
            return Address(**json.loads(self.file.read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError):
            return None

    def write(self, address: Address) -> None:
        """Write an address atomically."""
        draft = self.file.with_suffix(".new")
        draft.touch(mode=0o600)
        draft.write_text(json.dumps(dataclasses.asdict(address)), encoding="utf-8")
        draft.replace(self.file)

    def clear(self) -> None:
        """Remove the file."""
        self.file.unlink(missing_ok=True)


def ask(address: Address, request: str, timeout_s: float = 1.0) -> Any:
    """Return a daemon's response.

    Raises
    ------
    OSError, ValueError
        When nobody listens there or what answers is no daemon.
    """
    with socket.create_connection(("127.0.0.1", address.port), timeout_s) as connection:
        connection.sendall(json.dumps({"token": address.token, "ask": request}).encode() + b"\n")
        with connection.makefile("rb") as file:
            return json.loads(file.readline())


def graph_to_json(graph: Graph) -> dict[str, Any]:
    """Return a graph in a form for JSON."""
    endpoints = graph.endpoints()
    nodes = {node.key: node for node in (*graph.nodes(), *(endpoint.node for endpoint in endpoints))}
    return {
        "nodes": [[node.key, node.name, node.namespace, node.enclave] for node in nodes.values()],
        "alone": [node.key for node in graph.nodes()],
        "endpoints": [
            [
                endpoint.kind.value, endpoint.node.key, endpoint.name, endpoint.type_name, endpoint.type_hash,
                list(dataclasses.astuple(endpoint.qos)), endpoint.gid.hex(),
            ]
            for endpoint in endpoints
        ],
    }  # fmt: skip


def graph_from_json(content: dict[str, Any]) -> Graph:
    """Return the graph of the form that `graph_to_json` returns."""
    graph = Graph()
    nodes = {key: NodeInfo(key, *rest) for key, *rest in content["nodes"]}
    for key in content["alone"]:
        graph.add_node(nodes[key])
    for kind, node, name, type_name, type_hash, qos, gid in content["endpoints"]:
        endpoint = EndpointInfo(
            EndpointKind(kind), nodes[node], name, type_name, type_hash, _qos(*qos), bytes.fromhex(gid)
        )
        graph.add_endpoint(gid, endpoint)
    return graph


def _qos(
    reliability: int, durability: int, history: int, depth: int, deadline: int, lifespan: int, live: int, lease: int
) -> Qos:
    return Qos(
        Reliability(reliability),
        Durability(durability),
        History(history),
        depth,
        deadline,
        lifespan,
        Liveliness(live),
        lease,
    )
