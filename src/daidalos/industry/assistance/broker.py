"""Assistance devices and sequences on an MQTT broker."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from typing import Any

from daidalos.industry.assistance.device import POINT, Device, DeviceError
from daidalos.industry.assistance.runner import carry_out
from daidalos.industry.assistance.sequence import MQTT, Confirmation, Step, read_showing
from daidalos.industry.lighting.device import MqttParameters, make_client, parse_url
from daidalos.industry.lighting.embedded_broker import EmbeddedBroker

PREFIX = "assist"


class AssistBroker:
    """Devices on a broker within a ``with`` block.

    ``assist/{device}/skills`` says what a device can, retained; ``assist/{device}/point`` and ``show`` ask for it,
    errors come back on ``assist/{device}/error``; ``assist/step`` is the step of the sequence, retained.

    Parameters
    ----------
    parameters : MqttParameters
        An embedded broker is started where it names none.
    devices : mapping of str to Device
    topics : iterable of str
        Whose messages are confirmations.
    confirm : callable
        Called with these on the network's thread.
    report : callable
        Called with a line when the broker refuses or is lost.
    """

    def __init__(
        self,
        parameters: MqttParameters,
        devices: Mapping[str, Device],
        topics: Iterable[str],
        confirm: Callable[[Confirmation], None],
        report: Callable[[str], None],
    ) -> None:
        self._parameters, self._devices, self._topics = parameters, devices, frozenset(topics)
        self._confirm, self._report = confirm, report
        self._address = parse_url(parameters.broker or f"mqtt://127.0.0.1:{parameters.port}")
        self._client = make_client("daidalos-assist", parameters, self._address)
        self._client.on_connect, self._client.on_disconnect = self._connected, self._disconnected
        self._client.on_message = self._received
        self._stack = ExitStack()

    @property
    def url(self) -> str:
        """The broker's URL, without a password."""
        return f"{'mqtts' if self._address.is_encrypted else 'mqtt'}://{self._address.host}:{self._address.port}"

    def __enter__(self) -> AssistBroker:
        if not self._parameters.broker:
            self._stack.enter_context(EmbeddedBroker(self._parameters.host, self._parameters.port))
        self._client.will_set(f"{PREFIX}/availability", "offline", qos=1, retain=True)
        self._client.connect_async(self._address.host, self._address.port, keepalive=10)
        self._client.loop_start()
        return self

    def __exit__(self, *error: object) -> None:
        if self._client.is_connected():
            self._publish("availability", "offline").wait_for_publish(1.0)
        self._client.disconnect()
        self._client.loop_stop()
        self._stack.close()

    def announce(self, number: int, count: int, step: Step | None) -> None:
        """Publish the step that is shown now; None at the end."""
        content = {} if step is None else {"number": number, "of": count, "name": step.name}
        self._publish("step", json.dumps(content))

    def _connected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if reason.is_failure:
            self._report(f"the broker refuses the connection: {reason}")
            return
        self._publish("availability", "online")
        topics = [f"{PREFIX}/{name}/{skill}" for name, device in self._devices.items() for skill in device.skills]
        for name, device in self._devices.items():
            self._publish(f"{name}/skills", json.dumps(list(device.skills)))
        for topic in (*topics, *self._topics):
            client.subscribe(topic, self._parameters.qos)

    def _disconnected(self, client: Any, data: Any, flags: Any, reason: Any, properties: Any) -> None:
        if reason.is_failure:
            self._report("the broker is lost; connected again as soon as it is there")

    def _received(self, client: Any, data: Any, message: Any) -> None:
        if message.topic in self._topics:
            self._confirm(Confirmation(MQTT, message.topic, message.payload.decode("utf-8", "replace")))
            return
        _, name, skill = message.topic.split("/")
        device = self._devices[name]
        try:
            showing = read_showing(name, _json(message.payload), device.skills)
            if showing.follow:
                raise DeviceError("'follow' is for steps of a sequence, not for messages")
            if (showing.place is not None) != (skill == POINT):
                raise DeviceError(f"'{skill}' {'needs a' if skill == POINT else 'takes no'} point")
            carry_out(device, showing)
        except DeviceError as error:
            self._publish(f"{name}/error", str(error))
        else:
            self._publish(f"{name}/error", "")

    def _publish(self, name: str, text: str) -> Any:
        return self._client.publish(f"{PREFIX}/{name}", text, qos=1, retain=True)


def _json(payload: bytes) -> Any:
    try:
        return json.loads(payload)
    except (ValueError, RecursionError):
        raise DeviceError("is not valid JSON") from None
