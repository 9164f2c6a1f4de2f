"""A head as an MQTT device: commands come in by `{device}/{property}`, state, errors and availability go out."""

from __future__ import annotations

import ssl
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote, urlsplit

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import Vector
from daidalos.common.suggestions import hint
from daidalos.industry.lighting import messages
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.kinematics import PointingError

_STATE_S = 0.1
"""Least time between two states, and between two errors."""


@dataclass(frozen=True)
class MqttParameters(Parameters):
    """Parameters of the connection to an MQTT broker."""

    broker: str = parameter(
        "", "URL of the broker, mqtt://user:password@host:1883 or mqtts:// with TLS; the embedded one where empty."
    )
    host: str = parameter("127.0.0.1", "Address at which the embedded broker listens.", not_empty=True)
    port: int = parameter(1883, "Port at which the embedded broker listens.", minimum=1, maximum=65535)
    qos: int = parameter(1, "Quality of service of subscriptions and of what is published.", minimum=0, maximum=2)
    user: str = parameter("", "User name, where the URL has none.")
    password: str = parameter("", "Password, where the URL has none.")
    ca_file: str = parameter("", "Certificates that are trusted with TLS; the system's where empty.")
    cert_file: str = parameter("", "Certificate of this client; none where empty.")
    key_file: str = parameter("", "Key of that certificate.")
    blackout_after: float = parameter(
        5.0, "Time without a broker after which the head goes dark, until there is one again; 0 for never.",
        unit="s", minimum=0.0,
    )  # fmt: skip


@dataclass(frozen=True)
class Address:
    """Broker of a URL."""

    host: str
    port: int
    is_encrypted: bool
    user: str
    password: str


def parse_url(url: str) -> Address:
    """Return the broker of a URL.

    Raises
    ------
    UserError
        When it is none of MQTT.
    """
    parts = urlsplit(url)
    schemes = {"mqtt": 1883, "mqtts": 8883}
    if parts.scheme not in schemes:
        raise UserError(f"'{url}' is no URL of a broker: '{parts.scheme}' is unknown{hint(parts.scheme, schemes)}")
    try:
        port = parts.port or schemes[parts.scheme]
    except ValueError:
        raise UserError(f"'{url}' is no URL of a broker: its port must be from 1 to 65535") from None
    if not parts.hostname:
        raise UserError(f"'{url}' is no URL of a broker: it names no host")
    return Address(
        parts.hostname, port, parts.scheme == "mqtts", unquote(parts.username or ""), unquote(parts.password or "")
    )


def make_client(identity: str, parameters: MqttParameters, address: Address) -> Any:
    """Return a client of paho-mqtt that is not connected yet.

    Raises
    ------
    UserError
        When paho-mqtt is missing, or certificates cannot be read.
    """
    try:
        import paho.mqtt.client as mqtt
    except ImportError:
        raise UserError("MQTT needs paho-mqtt; run: pip install 'daidalos[industry]'") from None
    client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, client_id=identity, clean_session=False)
    user, password = address.user or parameters.user, address.password or parameters.password
    if user:
        client.username_pw_set(user, password or None)
    if address.is_encrypted:
        client.tls_set_context(_tls(parameters))
    client.reconnect_delay_set(min_delay=1, max_delay=5)
    return client


class MqttDevice:
    """One head on a broker, connected until `close`.

    Points replace each other until the head takes the newest: a flood of them needs no memory. Changes of channels and
    of looks are merged. What is refused leaves the head as it is, and its reason is published on ``{device}/error``.

    Parameters
    ----------
    engine : Engine
    name : str
        Of the head; also the first part of its topics.
    parameters : MqttParameters
    address : Address
        The broker.
    report : callable, optional
        Called with a line when the broker cannot be reached, refuses, is lost or is there again.
    """

    def __init__(
        self,
        engine: Engine,
        name: str,
        parameters: MqttParameters,
        address: Address,
        report: Callable[[str], None] | None = None,
    ) -> None:
        self._engine, self._name, self._parameters = engine, name, parameters
        self._report = report or (lambda line: None)
        self._reported = ""
        self._condition = threading.Condition()
        self._pending: dict[str, tuple[Any, bytes]] = {}
        self._error: str | None = None
        self._had_error = self._has_accepted = False
        self._point: Vector | None = None
        self._lost_at: float | None = time.monotonic()
        self._was_lit = False
        self._is_connected = self._is_ending = False
        self._last_state, self._last_sent = "", 0.0
        self._client = self._make_client(address)
        self._worker = threading.Thread(target=self._work, name=f"mqtt {name}", daemon=True)
        self._worker.start()
        self._client.connect_async(address.host, address.port, keepalive=10)
        self._client.loop_start()

    @property
    def is_connected(self) -> bool:
        """Whether the broker passes commands on."""
        return self._is_connected

    def await_connection(self, seconds: float) -> bool:
        """Wait until the broker passes commands on, at most some time; return whether it does."""
        with self._condition:
            return self._condition.wait_for(lambda: self._is_connected, seconds)

    def close(self) -> None:
        """Publish that the device is offline, and disconnect."""
        with self._condition:
            self._is_ending = True
            self._condition.notify_all()
        self._worker.join()
        if self._is_connected:
            self._publish("availability", "offline").wait_for_publish(1.0)
        self._client.disconnect()
        self._client.loop_stop()

    def _make_client(self, address: Address) -> Any:
        client = make_client(f"daidalos-{self._name}", self._parameters, address)
        client.will_set(f"{self._name}/availability", "offline", qos=1, retain=True)
        client.on_connect, client.on_disconnect = self._connected, self._disconnected
        client.on_connect_fail = self._unreachable
        client.on_subscribe, client.on_message = self._subscribed, self._received
        return client

    def _connected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if reason.is_failure:
            self._tell(f"the broker refuses the connection: {reason}")
            return
        client.subscribe([(f"{self._name}/{one}", self._parameters.qos) for one in messages.PROPERTIES])

    def _subscribed(self, client: Any, data: Any, number: Any, reasons: Any, properties: Any) -> None:
        """Announce the device once the broker passes commands on."""
        if self._reported:
            self._tell("the broker is there again")
            self._reported = ""
        self._publish("availability", "online")
        with self._condition:
            self._is_connected, self._lost_at = True, None
            self._last_state = ""
            if self._was_lit:
                self._engine.command(self._name, lambda head: head.show(head.look))
                self._was_lit = False
            self._condition.notify_all()

    def _unreachable(self, client: Any, data: Any) -> None:
        self._tell("the broker cannot be reached; tried again and again")

    def _tell(self, line: str) -> None:
        """Report a line, once as long as nothing changes."""
        if line != self._reported:
            self._reported = line
            self._report(f"{self._name}: {line}")

    def _disconnected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if self._is_connected and not self._is_ending:
            self._tell("the broker is lost")
        with self._condition:
            self._is_connected = False
            self._lost_at = self._lost_at or time.monotonic()
            self._condition.notify_all()

    def _received(self, client: Any, data: Any, message: Any) -> None:
        """Keep a command for the worker; this thread must be quick, or messages pile up in the network."""
        name = message.topic.rpartition("/")[2]
        try:
            content = messages.parse(name, message.payload)
        except UserError as problem:
            with self._condition:
                self._error = messages.error(message.topic, str(problem), message.payload)
                self._condition.notify_all()
            return
        with self._condition:
            before = self._pending.pop(name, None)
            if before is not None and isinstance(content, dict):
                content = {**before[0], **content}
            self._pending[name] = (content, message.payload)  # the newest kind comes last
            self._condition.notify_all()

    def _work(self) -> None:
        while True:
            with self._condition:
                if not (self._pending or self._error or self._is_ending):
                    self._condition.wait(self._patience())
                if self._is_ending:
                    return
                pending, self._pending = self._pending, {}
            for name, (content, payload) in pending.items():
                self._carry_out(name, content, payload)
            self._blackout_when_lost()
            self._publish_news()

    def _patience(self) -> float | None:
        """Return how long the worker may sleep [s]."""
        if self._is_connected:
            return _STATE_S
        return 0.5 if self._parameters.blackout_after else None

    def _carry_out(self, name: str, content: Any, payload: bytes) -> None:
        try:
            self._engine.command(self._name, lambda head: self._command(head, name, content))
            self._has_accepted = True
        except (PointingError, UserError) as problem:
            with self._condition:
                self._error = messages.error(f"{self._name}/{name}", str(problem), payload)

    def _command(self, head: Head, name: str, content: Any) -> None:
        if name == messages.POINT:
            head.point(content)
            self._point = content
        elif name == messages.DASHBOARD:
            head.set_channels(content)
        elif name == messages.LOOK:
            head.show(messages.apply_look(head.look, content))
        else:
            head.blackout()

    def _blackout_when_lost(self) -> None:
        limit = self._parameters.blackout_after
        with self._condition:
            is_lost = self._lost_at is not None and limit > 0.0 and time.monotonic() - self._lost_at > limit
        if is_lost and self._engine.look_at(self._name, lambda head: head.is_lit):
            self._was_lit = True
            self._engine.command(self._name, lambda head: head.blackout())

    def _publish_news(self) -> None:
        """Publish errors, and the state where it has changed; both at a limited rate, the newest of them."""
        now = time.monotonic()
        if not self._is_connected or now - self._last_sent < _STATE_S:
            return
        with self._condition:
            error, self._error = self._error, None
        state = self._engine.look_at(self._name, lambda head: messages.state(head, self._point))
        if error is not None:
            self._publish("error", error)
        elif self._had_error and self._has_accepted:
            self._publish("error", "")  # what was wrong is past
        if state != self._last_state:
            self._publish("state", state)
        if error is not None or self._has_accepted or state != self._last_state:
            self._had_error = error is not None or (self._had_error and not self._has_accepted)
            self._has_accepted = False
            self._last_state, self._last_sent = state, now

    def _publish(self, name: str, payload: str) -> Any:
        return self._client.publish(f"{self._name}/{name}", payload, qos=min(self._parameters.qos, 1), retain=True)


def _tls(parameters: MqttParameters) -> ssl.SSLContext:
    try:
        context = ssl.create_default_context(cafile=parameters.ca_file or None)
        if parameters.cert_file:
            context.load_cert_chain(parameters.cert_file, parameters.key_file or None)
    except OSError as error:
        raise UserError(f"cannot read the certificates of MQTT: {error}") from None
    return context
