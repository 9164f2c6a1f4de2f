"""Disturbed connections: latency, loss and drop-outs on topics."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from daidalos.common.errors import UserError
from daidalos.testing.scenario import Scenario


@dataclass(frozen=True)
class Impairment:
    """Disturbance of a topic.

    Parameters
    ----------
    latency : float
        By which each message comes later [s].
    jitter : float
        Standard deviation of the latency [s]; the order of the messages stays.
    loss : float
        Share of the messages that are lost, 0 to 1.
    """

    latency: float = 0.0
    jitter: float = 0.0
    loss: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.loss <= 1.0 or self.latency < 0.0 or self.jitter < 0.0:
            raise UserError(
                "expected a loss between 0 and 1, and a latency and jitter of 0 s or more, got "
                f"loss {self.loss:g}, latency {self.latency:g} s, jitter {self.jitter:g} s"
            )


class Network:
    """Connections between the nodes under test.

    Parameters
    ----------
    scenario : Scenario
    """

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._random = random.Random(scenario.seed)
        self._last_due: dict[int, int] = {}

    def disturb(self, topic: str, *, latency: float = 0.0, jitter: float = 0.0, loss: float = 0.0) -> None:
        """Disturb a topic from now on; see `Impairment`. All its subscriptions are affected, the recorder's not."""
        self._set(topic, Impairment(latency, jitter, loss))

    def restore(self, topic: str) -> None:
        """Connect a topic perfectly again."""
        self._set(topic, None)

    def drop_out(self, topic: str, seconds: float | None = None) -> None:
        """Lose all messages of a topic, such as those of a sensor that fails.

        Parameters
        ----------
        topic : str
        seconds : float, optional
            For how long; until `restore` where None. The test goes on at once.
        """
        self._set(topic, Impairment(loss=1.0))
        if seconds is not None:
            self._scenario.run.scheduler.spawn(
                lambda: self._restore_after(topic, seconds), self._scenario.program, f"drop-out of {topic}"
            )

    def alter(self, topic: str, change: Callable[[Any], None]) -> None:
        """Change all messages of a topic on their way, such as those of a sensor that is frozen.

        Parameters
        ----------
        topic : str
        change : callable
            Called with a copy of each message, once, whichever number of subscriptions there is; changes it in place.
        """
        changed: dict[int, Any] = {}

        def carry(subscription: Any, item: tuple[Any, ...]) -> None:
            if _is_observing(subscription):
                subscription.enqueue(item)
                return
            message, sequence = item[0], item[2]
            if sequence not in changed:
                changed.clear()
                changed[sequence] = copy.deepcopy(message)
                change(changed[sequence])
            subscription.enqueue((changed[sequence], *item[1:]))

        self._impair(topic, carry)

    def _restore_after(self, topic: str, seconds: float) -> None:
        scheduler = self._scenario.run.scheduler
        scheduler.sleep_until(scheduler.now_ns + round(1e9 * seconds))
        self.restore(topic)

    def _set(self, topic: str, impairment: Impairment | None) -> None:
        self._impair(topic, None if impairment is None else self._carrier(impairment))

    def _impair(self, topic: str, carry: Callable[[Any, tuple[Any, ...]], None] | None) -> None:
        name = topic if topic.startswith("/") else f"/{topic}"
        self._scenario.node.handle.session.impair(name, carry)

    def _carrier(self, impairment: Impairment) -> Callable[[Any, tuple[Any, ...]], None]:
        def carry(subscription: Any, item: tuple[Any, ...]) -> None:
            if _is_observing(subscription):
                subscription.enqueue(item)
            elif impairment.loss < 1.0 and self._random.random() >= impairment.loss:
                self._deliver(subscription, item, impairment)

        return carry

    def _deliver(self, subscription: Any, item: tuple[Any, ...], impairment: Impairment) -> None:
        scheduler = self._scenario.run.scheduler
        delay = max(0.0, self._random.gauss(impairment.latency, impairment.jitter))
        if delay <= 0.0:
            subscription.enqueue(item)
            return
        due = max(scheduler.now_ns + round(1e9 * delay), self._last_due.get(id(subscription), 0))
        self._last_due[id(subscription)] = due

        def arrive() -> None:
            scheduler.sleep_until(due)
            subscription.enqueue(item)

        scheduler.spawn(arrive, self._scenario.program, f"message on {subscription.endpoint.name}")


def _is_observing(subscription: Any) -> bool:
    """Return whether a subscription is that of the test or its recorder."""
    return subscription.endpoint.node.name in ("rosbag2_recorder", "scenario")
