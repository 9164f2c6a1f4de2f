"""Daemon process, which takes part in the graph and answers requests about it.

It ends two hours after the last question, and, unless it was started to stay, soon after the last node of the
domain has gone. A question is ``graph``, ``status``, ``stay`` or ``stop``; see `wire`.
"""

from __future__ import annotations

import argparse
import json
import os
import secrets
import select
import signal
import socket
import sys
import time
from typing import Any

from daidalos.transport.graph import Graph
from ros2cli.daemon.protocol import MAX_QUESTION, Address, AddressFile, ask, graph_to_json
from ros2cli.node import NODE_NAME_PREFIX
from ros2cli.node.direct import direct_node

_IDLE_S = 2 * 60 * 60.0
_IDLE_TIMEOUT_S = 1.5


class Server:
    """Server of a graph until it is no longer needed.

    Parameters
    ----------
    graph
        What is asked about.
    listener
        A socket that listens.
    token
        What a question must bring.
    stay
        Whether to go on when nobody else is in the graph.
    """

    def __init__(self, graph: Graph, listener: socket.socket, token: str, stay: bool) -> None:
        self._graph = graph
        self._listener = listener
        self._token = token
        self._stay = stay
        self._asked_at = time.monotonic()
        self._alone_since: float | None = None
        self._stopping: socket.socket | None = None
        self._woken, self._wake = socket.socketpair()
        self._wake.setblocking(False)
        graph.listen(lambda added, what: self._notice())

    def serve(self) -> socket.socket | None:
        """Answer requests; return the connection that requested to stop, None on timeout."""
        while self._stopping is None:
            left = self._time_left()
            if left <= 0:
                return None
            ready, _, _ = select.select([self._listener, self._woken], [], [], left)
            if self._woken in ready:
                self._woken.recv(MAX_QUESTION)
            if self._listener in ready:
                self._accept()
        return self._stopping

    def _notice(self) -> None:
        """Make `serve` check the graph again; called on the transport's threads."""
        try:
            self._wake.send(b".")
        except BlockingIOError:
            return  # it has been told often enough

    def _time_left(self) -> float:
        now = time.monotonic()
        left = self._asked_at + _IDLE_S - now
        if self._stay or any(not node.name.startswith(NODE_NAME_PREFIX) for node in self._graph.nodes()):
            self._alone_since = None
            return left
        if self._alone_since is None:
            self._alone_since = now
        return min(left, self._alone_since + _IDLE_TIMEOUT_S - now)

    def _accept(self) -> None:
        connection, _ = self._listener.accept()
        connection.settimeout(1.0)
        try:
            request = _read_question(connection)
            if not secrets.compare_digest(str(request.get("token")), self._token):
                raise ValueError("the token is wrong")
            self._asked_at = time.monotonic()
            if request.get("ask") == "stop":
                self._stopping = connection
                return
            connection.sendall(json.dumps(self._answer(request.get("ask"))).encode() + b"\n")
        except (OSError, ValueError) as error:
            print(f"ros2 daemon: dropped a question: {error}", file=sys.stderr)  # noqa: T201
        connection.close()

    def _answer(self, request: Any) -> Any:
        if request == "graph":
            return graph_to_json(self._graph)
        if request == "stay":
            self._stay = True
        return {"running": True}


def _read_question(connection: socket.socket) -> dict[str, Any]:
    with connection.makefile("rb") as file:
        request = json.loads(file.readline(MAX_QUESTION))
    if not isinstance(request, dict):
        raise ValueError("a question is an object")
    return request


def main() -> int:
    """Run the daemon, unless there is one already."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stay", action="store_true")
    args = parser.parse_args()
    args.start_type_description_service = False
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(0))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    station = AddressFile()
    with socket.create_server(("127.0.0.1", 0)) as listener:
        with direct_node(args, f"{NODE_NAME_PREFIX}_daemon_{station.environment.domain}_{os.getpid()}") as node:
            token = secrets.token_hex(16)
            server = Server(node.handle.graph, listener, token, args.stay)
            with station.locked():
                if _answers(station):
                    return 0
                station.write(Address(listener.getsockname()[1], token))
            print("ready", flush=True)  # noqa: T201
            try:
                client = server.serve()
            finally:
                with station.locked():
                    address = station.read()
                    if address is not None and address.token == token:
                        station.clear()
        if client is not None:
            client.sendall(b"{}\n")
            client.close()
    return 0


def _answers(station: AddressFile) -> bool:
    address = station.read()
    if address is None:
        return False
    try:
        ask(address, "status")
    except (OSError, ValueError):
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
