"""Topics without publishers or without subscriptions."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.cli.ros2.graph import topics
from daidalos.transport.graph import EndpointKind, Graph

_ALONE_IS_FINE = ("/parameter_events", "/rosout")


class Topic(Subject):
    """Publishers and subscriptions of topics."""

    category = "topic"

    def check(self, graph: Graph) -> Findings:
        """Warn of topics that have only publishers or only subscriptions."""
        findings = Findings()
        for name, publishers, subscriptions in _counts(graph):
            if publishers and not subscriptions:
                findings.warnings.append(f"Publisher without subscriber detected on {name}.")
            elif subscriptions and not publishers:
                findings.warnings.append(f"Subscriber without publisher detected on {name}.")
        return findings

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the numbers of publishers and subscriptions."""
        items: list[tuple[str, str | int]] = []
        for name, publishers, subscriptions in _counts(graph):
            items += [("topic", name), ("publisher count", publishers), ("subscriber count", subscriptions)]
        none = (("topic", "none"), ("publisher count", 0), ("subscriber count", 0))
        yield Report("TOPIC LIST", tuple(items) or none)


def _counts(graph: Graph) -> list[tuple[str, int, int]]:
    return [
        (
            name,
            len(graph.endpoints(EndpointKind.PUBLISHER, name=name)),
            len(graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)),
        )
        for name, _ in topics(graph, include_hidden=False)
        if name not in _ALONE_IS_FINE
    ]


SUBJECT = Topic
