"""Services and actions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.cli.ros2.graph import action_parties, all_actions, services
from daidalos.transport.graph import EndpointKind, Graph


class Endpoints(Subject):
    """Servers and clients of services and actions."""

    category = "service"
    checked = False

    def check(self, graph: Graph) -> Findings:
        """Return no findings; a service may be waiting for its first client."""
        return Findings()

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the numbers of servers and clients."""
        items: list[tuple[str, Any]] = []
        for name, _ in services(graph, include_hidden=False):
            items += [
                ("service", name),
                ("service count", len(graph.endpoints(EndpointKind.SERVICE, name=name))),
                ("client count", len(graph.endpoints(EndpointKind.CLIENT, name=name))),
            ]
        yield Report("SERVICE LIST", tuple(items) or (("service", "none"), ("service count", 0), ("client count", 0)))
        items = []
        for name, _ in all_actions(graph):
            items += [
                ("action", name),
                ("action server count", len(action_parties(graph, name, EndpointKind.PUBLISHER))),
                ("action client count", len(action_parties(graph, name, EndpointKind.SUBSCRIPTION))),
            ]
        none = (("action", "none"), ("action server count", 0), ("action client count", 0))
        yield Report("ACTION LIST", tuple(items) or none)


SUBJECT = Endpoints
