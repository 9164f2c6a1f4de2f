"""Connection of `mqtt_client` to its broker, made again whenever it is lost."""

from __future__ import annotations

import os
import ssl
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError
from daidalos.nodes.mqtt_client._buffer import Buffer, Outgoing
from daidalos.nodes.mqtt_client._parameters import BrokerParameters, ClientParameters

_TLS_VERSIONS = {1: ssl.TLSVersion.TLSv1, 2: ssl.TLSVersion.TLSv1_1, 3: ssl.TLSVersion.TLSv1_2}
_RETRY_S = 1, 5
"""Least and greatest time between two attempts."""


class Connection:
    """Client of a broker.

    Parameters
    ----------
    broker : BrokerParameters
    client : ClientParameters
    logger : object
        Of the node.
    connected : callable
        Called on the network's thread whenever the broker has accepted the connection.
    received : callable
        Called there with the topic and the payload of each message.

    Raises
    ------
    UserError
        When paho-mqtt is missing, or a file of certificates or the buffer cannot be read.
    """

    def __init__(
        self,
        broker: BrokerParameters,
        client: ClientParameters,
        logger: Any,
        connected: Callable[[], None],
        received: Callable[[str, bytes], None],
    ) -> None:
        self._logger, self._on_connected, self._on_received = logger, connected, received
        self.url = f"{'ssl' if broker.tls else 'tcp'}://{broker.host}:{broker.port}"
        self._subscriptions: dict[str, int] = {}
        self._lock = threading.Lock()
        self._is_connected = self._was_refused = False
        try:
            self._buffer = Buffer(client.buffer_size, _resolve(client.buffer_directory) / f"{client.id}.jsonl")
        except OSError as error:
            raise UserError(f"cannot read the buffer: {error}") from None
        self._client = _make_client(broker, client)
        self._client.on_connect, self._client.on_disconnect = self._connected, self._disconnected
        self._client.on_connect_fail = self._failed
        self._client.on_message = lambda client, data, message: received(message.topic, message.payload)
        logger.info(f"Connecting to broker at '{self.url}'{_as(client.id)} ...")
        self._client.connect_async(broker.host, broker.port, keepalive=round(client.keep_alive_interval))
        self._client.loop_start()

    @property
    def is_connected(self) -> bool:
        """Whether the broker has accepted the connection."""
        return self._is_connected

    def subscribe(self, topic: str, qos: int) -> None:
        """Subscribe to a topic, now or as soon as there is a connection, and after each reconnection."""
        with self._lock:
            is_known = self._subscriptions.get(topic) == qos
            self._subscriptions[topic] = qos
        if not is_known and self._is_connected:
            self._client.subscribe(topic, qos)

    def publish(self, topic: str, payload: bytes, qos: int, retained: bool) -> None:
        """Send a message; without a broker it is kept in the buffer, or lost with a warning."""
        with self._lock:
            if self._is_connected:
                self._client.publish(topic, payload, qos, retained)
                return
            try:
                is_kept = self._buffer.add(Outgoing(topic, payload, qos, retained))
            except OSError as error:
                self._logger.error(f"cannot write the buffer: {error}", throttle_duration_sec=5.0)
                return
        if not is_kept:
            why = "there is no broker" if not len(self._buffer) else "there is no broker, and the buffer is full"
            self._logger.warning(f"Publishing to MQTT topic '{topic}' failed: {why}", throttle_duration_sec=5.0)

    def close(self) -> None:
        """Leave the broker in order, without the last will."""
        self._client.disconnect()
        self._client.loop_stop()

    def _connected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if reason.is_failure:
            if not self._was_refused:
                self._logger.error(f"The broker refuses the connection: {reason}; will automatically retry...")
            self._was_refused = True
            return
        self._was_refused = False
        self._logger.info(f"Connected to broker at '{self.url}'")
        with self._lock:
            for topic, qos in self._subscriptions.items():
                client.subscribe(topic, qos)
            for one in self._buffer.take():
                client.publish(*one)
            self._is_connected = True
        self._on_connected()

    def _disconnected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if self._is_connected and reason.is_failure:
            self._logger.error("Connection to broker lost, will try to reconnect...")
        self._is_connected = False

    def _failed(self, client: Any, data: Any) -> None:
        self._logger.error(
            f"Connection to broker at '{self.url}' failed, will automatically retry...", throttle_duration_sec=30.0
        )


def _make_client(broker: BrokerParameters, settings: ClientParameters) -> Any:
    try:
        import paho.mqtt.client as mqtt
    except ImportError:
        raise UserError("mqtt_client needs paho-mqtt; run: pip install 'daidalos[industry]'") from None
    client = mqtt.Client(
        mqtt.CallbackAPIVersion.VERSION2, client_id=settings.id, clean_session=settings.clean_session
    )  # fmt: skip
    client.max_inflight_messages_set(settings.max_inflight)
    client.reconnect_delay_set(*_RETRY_S)
    if broker.user:
        client.username_pw_set(broker.user, broker.password)
    if settings.will_topic:
        client.will_set(settings.will_topic, settings.will_message, settings.will_qos, settings.will_retained)
    if broker.tls:
        client.tls_set_context(_tls(broker, settings))
    return client


def _tls(broker: BrokerParameters, settings: ClientParameters) -> ssl.SSLContext:
    trusted = _file("broker.tls.ca_certificate", broker.ca_certificate)
    certificate = _file("client.tls.certificate", settings.certificate)
    key = _file("client.tls.key", settings.key)
    try:
        context = ssl.create_default_context(cafile=trusted)
        if certificate is not None:
            context.load_cert_chain(certificate, key, settings.key_password or None)
    except OSError as error:  # also what TLS finds wrong in them
        raise UserError(f"cannot use the certificates of 'broker.tls' and 'client.tls': {error}") from None
    context.check_hostname = settings.verify and settings.server_cert_auth
    context.verify_mode = ssl.CERT_REQUIRED if settings.server_cert_auth else ssl.CERT_NONE
    if settings.tls_version:
        context.minimum_version = context.maximum_version = _TLS_VERSIONS[settings.tls_version]
    if settings.alpn_protos:
        context.set_alpn_protocols(list(settings.alpn_protos))
    return context


def _file(name: str, path: str) -> Path | None:
    """Return the file that a parameter names; None where it is empty.

    Raises
    ------
    UserError
        When there is none.
    """
    if not path:
        return None
    file = _resolve(path)
    if not file.is_file():
        raise UserError(f"parameter '{name}' names '{file}', which does not exist")
    return file


def _resolve(path: str) -> Path:
    return Path(os.environ.get("ROS_HOME") or Path.cwd()) / path


def _as(identity: str) -> str:
    return f" as '{identity}'" if identity else ""
