"""Compatibility of the quality of service of publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.cli.ros2.graph import topics
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph
from daidalos.transport.qos import Policy, incompatibilities

_Pair = tuple[str, EndpointInfo, EndpointInfo, list[Policy]]


class QosCompatibility(Subject):
    """Every publisher with every subscription of its topic."""

    category = "middleware"

    def check(self, graph: Graph) -> Findings:
        """Fail for every incompatible pair."""
        return Findings(
            errors=[
                f"QoS compatibility error found on topic [{name}]: {publisher.node.full_name} does not reach "
                f"{subscription.node.full_name}; {_status(policies)}"
                for name, publisher, subscription, policies in _pairs(graph)
                if policies
            ]
        )

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return a description of every pair."""
        items: list[tuple[str, str]] = []
        for name, publisher, subscription, policies in _pairs(graph):
            items += [
                ("topic [type]", f"{name} [{publisher.type_name}]"),
                ("publisher node", publisher.node.full_name),
                ("subscriber node", subscription.node.full_name),
                ("compatibility status", _status(policies)),
            ]
        none = (("compatibility status", "No publisher/subscriber pairs found"),)
        yield Report("QOS COMPATIBILITY LIST", tuple(items) or none)


def _pairs(graph: Graph) -> Iterator[_Pair]:
    for name, _ in topics(graph, include_hidden=False):
        for publisher in graph.endpoints(EndpointKind.PUBLISHER, name=name):
            for subscription in graph.endpoints(EndpointKind.SUBSCRIPTION, name=name):
                yield name, publisher, subscription, incompatibilities(publisher.qos, subscription.qos)


def _status(policies: list[Policy]) -> str:
    if not policies:
        return "OK"
    return f"ERROR: {', '.join(policy.name.lower() for policy in policies)} offered by the publisher is not enough"


SUBJECT = QosCompatibility
