"""Tasks that watch a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._diagnostic_updater import CompositeDiagnosticTask
from ._update_functions import FrequencyStatus, FrequencyStatusParam, TimeStampStatus, TimeStampStatusParam

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.publisher import Publisher

    from ._diagnostic_updater import DiagnosticTaskVector


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Diagnostic of how often messages are published.

    Parameters
    ----------
    name
        Of the topic.
    diag
        The updater to add the task to.
    freq
        What frequency is right.
    """

    def __init__(self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq, clock=_clock_of(diag))
        self.addTask(self.freq)
        self.diag.add(self)

    def tick(self) -> None:
        """Count a published message."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Reset the counts."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Diagnostic of how often messages are published, and of their stamps.

    Parameters
    ----------
    name, diag, freq
        As in `HeaderlessTopicDiagnostic`.
    stamp
        What delay is right.
    """

    def __init__(
        self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp, clock=_clock_of(diag))
        self.addTask(self.stamp)

    def tick(self, stamp: Any) -> None:  # type: ignore[override]
        """Count a published message with this stamp."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """A publisher that is watched.

    Parameters
    ----------
    pub
        The publisher.
    diag, freq, stamp
        As in `TopicDiagnostic`.
    """

    def __init__(
        self, pub: Publisher, diag: DiagnosticTaskVector, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Publish a message with a header."""
        self.tick(message.header.stamp)
        self.publisher.publish(message)


def _clock_of(diag: Any) -> Clock | None:
    """Return the clock of the updater's node, so that simulated time counts."""
    node = getattr(diag, "node", None)
    return node.get_clock() if node is not None else None
