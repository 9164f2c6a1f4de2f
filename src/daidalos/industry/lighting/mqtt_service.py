"""All heads of a show on a broker: the embedded one, or another one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack

from daidalos.industry.lighting.device import MqttDevice, MqttParameters, parse_url
from daidalos.industry.lighting.embedded_broker import EmbeddedBroker
from daidalos.industry.lighting.engine import Engine

_EMBEDDED_S = 5.0
"""Time within which the embedded broker takes a connection; another one may be absent."""


class MqttService:
    """Heads as MQTT devices within a ``with`` block.

    Parameters
    ----------
    engine : Engine
    names : iterable of str
        Of the heads.
    parameters : MqttParameters
    report : callable, optional
        Called with a line about the broker: unreachable, lost, there again.

    Raises
    ------
    UserError
        When the broker's URL is none, or the embedded broker cannot start.
    """

    def __init__(
        self,
        engine: Engine,
        names: Iterable[str],
        parameters: MqttParameters,
        report: Callable[[str], None] | None = None,
    ) -> None:
        self._report = report
        self._engine, self._names, self._parameters = engine, list(names), parameters
        self._address = parse_url(parameters.broker or f"mqtt://{_reachable(parameters.host)}:{parameters.port}")
        self._stack = ExitStack()
        self.devices: list[MqttDevice] = []

    @property
    def url(self) -> str:
        """The broker's URL, without a password."""
        return f"{'mqtts' if self._address.is_encrypted else 'mqtt'}://{self._address.host}:{self._address.port}"

    def __enter__(self) -> MqttService:
        with ExitStack() as stack:
            if not self._parameters.broker:
                stack.enter_context(EmbeddedBroker(self._parameters.host, self._parameters.port))
            for name in self._names:
                device = MqttDevice(self._engine, name, self._parameters, self._address, self._report)
                stack.callback(device.close)
                self.devices.append(device)
            for device in self.devices if not self._parameters.broker else ():
                device.await_connection(_EMBEDDED_S)
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()


def _reachable(host: str) -> str:
    return "127.0.0.1" if host == "0.0.0.0" else host
