"""Compatibility of the quality of service of publishers and subscriptions."""

from __future__ import annotations

from ros2cli.listing import topics

from daidalos.transport.graph import EndpointInfo, EndpointKind
from daidalos.transport.qos import Policy, incompatibilities, incompatibility_text
from ros2doctor.api import DoctorCheck, DoctorReport, Report, Result
from ros2doctor.api.format import doctor_error
from ros2doctor.api.graph import current_graph

_Pair = tuple[str, EndpointInfo, EndpointInfo, list[Policy]]


class QoSCompatibilityCheck(DoctorCheck):
    """Check that fails for every publisher that does not reach a subscription of its topic."""

    def category(self) -> str:
        """Implement `DoctorCheck`."""
        return "middleware"

    def check(self) -> Result:
        """Implement `DoctorCheck`."""
        result = Result()
        for name, publisher, subscription, policies in _pairs():
            if policies:
                doctor_error(
                    f"QoS compatibility error found on topic [{name}]: {publisher.node.full_name} does not reach "
                    f"{subscription.node.full_name}; {_status(policies).removeprefix('ERROR: ')}"
                )
                result.add_error()
        return result


class QoSCompatibilityReport(DoctorReport):
    """Report of every publisher with every subscription of its topic."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "middleware"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("QOS COMPATIBILITY LIST")
        for name, publisher, subscription, policies in _pairs():
            report.add_to_report("topic [type]", f"{name} [{publisher.type_name}]")
            report.add_to_report("publisher node", publisher.node.name)
            report.add_to_report("subscriber node", subscription.node.name)
            report.add_to_report("compatibility status", _status(policies))
        if not report.items:
            report.add_to_report("compatibility status", "No publisher/subscriber pairs found")
        return report


def _pairs() -> list[_Pair]:
    with current_graph() as graph:
        return [
            (name, publisher, subscription, incompatibilities(publisher.qos, subscription.qos))
            for name, _ in topics(graph, include_hidden=False)
            for publisher in graph.endpoints(EndpointKind.PUBLISHER, name=name)
            for subscription in graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        ]


def _status(policies: list[Policy]) -> str:
    return incompatibility_text(policies) or "OK"
