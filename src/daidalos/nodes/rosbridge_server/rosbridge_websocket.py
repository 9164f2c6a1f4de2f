"""`rosbridge_websocket`: the graph for clients of the rosbridge protocol, such as roslibjs and roslibpy."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosapi.glob_helper import split_globs
from rosbridge_library.capabilities import (
    advertise,
    advertise_action,
    advertise_service,
    call_service,
    publish,
    send_action_goal,
    subscribe,
    unadvertise_action,
    unadvertise_service,
)
from rosbridge_library.internal.publishers import manager
from rosbridge_msgs.msg import ConnectedClient, ConnectedClients
from std_msgs.msg import Int32

from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.rosbridge_server._server import RosbridgeServer
from daidalos.nodes.runner import UserError, program_arguments, run
from daidalos.nodes.server_access import Access, chosen_token, listening_hosts, warn_of_exposure
from daidalos.studio.guarded_server import HEARTBEAT_S
from daidalos.studio.ports import PortError, PortUsedError

_BESIDE = "calls and goals never wait for each other"
WITHOUT_EFFECT = {
    "call_services_in_new_thread": _BESIDE,
    "send_action_goals_in_new_thread": _BESIDE,
    "params_glob": "parameters are reached through rosapi_node",
    "websocket_ping_timeout": "a client has half of websocket_ping_interval to answer",
}


@dataclass(frozen=True)
class RosbridgeWebsocketParameters(Parameters):
    """Parameters of ``rosbridge_websocket``."""

    port: int = parameter(9090, "TCP port; 0 for any that is free.", minimum=0, maximum=65535, read_only=True)
    address: str = parameter("", "Address to listen on; loopback where empty.", read_only=True)
    url_path: str = parameter("/", "Path of the address.", read_only=True)
    certfile: str = parameter("", "Certificate in PEM format, by which connections are encrypted.", read_only=True)
    keyfile: str = parameter("", "Private key in PEM format; where empty, it is in ``certfile``.", read_only=True)
    allowed_origins: tuple[str, ...] = parameter(
        ("",), "Servers of web pages that may connect, such as ``http://localhost:8000``.", read_only=True
    )
    allowed_hosts: tuple[str, ...] = parameter(
        ("",), "Names under which a server on loopback is reached, such as that of a proxy.", read_only=True
    )
    retry_startup_delay: float = parameter(
        2.0, "Time after which a used port is tried again.", unit="s", above=0.0, read_only=True
    )
    fragment_timeout: float = parameter(
        600.0, "Time for which pieces of a message wait for the others.", unit="s", above=0.0, read_only=True
    )
    delay_between_messages: float = parameter(
        0.0, "Least time between two messages to a client.", unit="s", minimum=0.0, read_only=True
    )
    max_message_size: int = parameter(10_000_000, "Size of a message of a client.", unit="B", minimum=1, read_only=True)
    unregister_timeout: float = parameter(
        10.0, "Time for which a topic stays advertised after its last client.", unit="s", minimum=0.0, read_only=True
    )
    default_call_service_timeout: float = parameter(
        0.0, "Time in which services must answer; 0 waits without end.", unit="s", minimum=0.0, read_only=True
    )
    use_compression: bool = parameter(False, "Whether frames are compressed.", read_only=True)
    websocket_ping_interval: float = parameter(
        0.0, "Period in which clients are asked for a sign of life; 0 for 30 s.", unit="s", minimum=0.0, read_only=True
    )
    topics_glob: str = parameter("", "Patterns of topics that clients may use, as ``[/a, /b/*]``.", read_only=True)
    services_glob: str = parameter("", "Patterns of services that clients may use.", read_only=True)
    actions_glob: str = parameter("", "Patterns of actions that clients may use.", read_only=True)
    bson_only_mode: bool = parameter(False, "Must be false: messages are JSON or CBOR.", read_only=True)


class RosbridgeWebsocket(Node):
    """Node that serves the rosbridge protocol on ``ws://localhost:9090/``.

    Raises
    ------
    UserError
        When the address cannot be opened, or the certificate cannot be used.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("rosbridge_websocket", **kwargs)
        _accept_whole_numbers(self)
        settings = declare(self, RosbridgeWebsocketParameters)
        if settings.bson_only_mode:
            raise ParameterError("bson_only_mode", "must be false: messages are JSON, or CBOR where a client asks")
        declare_without_effect(self, WITHOUT_EFFECT)
        self._settings = settings
        _set_patterns(settings)
        latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._count = self.create_publisher(Int32, "client_count", latched)
        self._connected = self.create_publisher(ConnectedClients, "connected_clients", latched)
        self._since: dict[str, ConnectedClient] = {}
        self._retry = self.create_timer(
            settings.retry_startup_delay, self._open, clock=Clock(clock_type=ClockType.STEADY_TIME), autostart=False
        )
        try:
            access = Access.of(
                settings.allowed_hosts,
                settings.allowed_origins,
                tls=bool(settings.certfile),
                certfile=settings.certfile,
                keyfile=settings.keyfile,
            )
            self._server = RosbridgeServer(
                self,
                port=settings.port,
                path=settings.url_path,
                hosts=listening_hosts(settings.address),
                allowed_hosts=access.hosts,
                allowed_origins=access.origins,
                token=chosen_token(),
                tls=access.tls_context(),
                parameters={
                    "fragment_timeout": settings.fragment_timeout,
                    "delay_between_messages": settings.delay_between_messages,
                    "unregister_timeout": settings.unregister_timeout,
                    "default_call_service_timeout": settings.default_call_service_timeout,
                },
                max_message_bytes=settings.max_message_size,
                compress=settings.use_compression,
                heartbeat_s=settings.websocket_ping_interval or HEARTBEAT_S,
                clients_changed=self._publish_clients,
            )
            self._publish_clients({})
            self._open()
        except (PortError, UserError) as error:
            super().destroy_node()
            raise UserError(str(error)) from None

    @property
    def server(self) -> RosbridgeServer:
        """The port and its clients."""
        return self._server

    def _open(self) -> None:
        try:
            self._server.start()
        except PortUsedError as error:
            delay_s = self._settings.retry_startup_delay
            self.get_logger().warning(f"{error}; it is tried again in {delay_s:g} s")
            self._retry.reset()
            return
        self._retry.cancel()
        self.declare_parameter("actual_port", self._server.port)
        # Programs wait for this line of the original.
        self.get_logger().info(f"Rosbridge WebSocket server started on port {self._server.port}")
        if self._server.asks_for_token:  # which is not for the log, that everyone in the graph reads
            print(f"rosbridge: {self._server.address}", file=sys.stderr, flush=True)
        warn_of_exposure(self, self._server, "rosbridge", "ws")

    def _publish_clients(self, clients: Mapping[str, str]) -> None:
        now = self.get_clock().now().to_msg()
        self._since = {
            number: self._since.get(number) or ConnectedClient(ip_address=address, connection_time=now)
            for number, address in clients.items()
        }
        self._count.publish(Int32(data=len(clients)))
        self._connected.publish(ConnectedClients(clients=list(self._since.values())))

    def destroy_node(self) -> None:
        """Close the connections and leave the graph."""
        self._server.stop()
        manager.forget(self)
        super().destroy_node()


def _accept_whole_numbers(node: Node) -> None:
    """Take given integers as the real numbers that they stand for: the original's launch file writes them so."""
    for one in fields(RosbridgeWebsocketParameters):
        given = node._parameter_overrides.get(one.name)
        if str(one.type) == "float" and given is not None and isinstance(given.value, int):
            node._parameter_overrides[one.name] = Parameter(one.name, value=float(given.value))


def _set_patterns(settings: RosbridgeWebsocketParameters) -> None:
    topics, services, actions = map(split_globs, (settings.topics_glob, settings.services_glob, settings.actions_glob))
    advertise.Advertise.topics_glob = publish.Publish.topics_glob = subscribe.Subscribe.topics_glob = topics
    call_service.CallService.services_glob = advertise_service.AdvertiseService.services_glob = services
    unadvertise_service.UnadvertiseService.services_glob = services
    send_action_goal.SendActionGoal.actions_glob = advertise_action.AdvertiseAction.actions_glob = actions
    unadvertise_action.UnadvertiseAction.actions_glob = actions


def _overrides() -> list[Parameter[Any]]:
    """Return the parameters that the command line gives in the original's way, such as ``--port 9091``."""
    parser = argparse.ArgumentParser(prog="rosbridge_websocket", description=__doc__)
    for one in fields(RosbridgeWebsocketParameters):
        kind = {"int": int, "float": float}.get(str(one.type), str)
        if str(one.type) in ("int", "float", "str"):
            parser.add_argument(f"--{one.name}", type=kind, default=argparse.SUPPRESS)
    return [Parameter(name, value=value) for name, value in vars(parser.parse_args(program_arguments())).items()]


def main() -> int:
    """Run the node."""
    overrides = _overrides()
    return run(lambda: RosbridgeWebsocket(parameter_overrides=overrides))
