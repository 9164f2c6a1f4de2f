"""Topics without publishers or without subscriptions."""

from __future__ import annotations

from ros2cli.listing import topics

from daidalos.transport.graph import EndpointKind
from ros2doctor.api import DoctorCheck, DoctorReport, Report, Result
from ros2doctor.api.format import doctor_warn
from ros2doctor.api.graph import current_graph

_ALONE_IS_FINE = ("/parameter_events", "/rosout")


class TopicCheck(DoctorCheck):
    """Check that warns of topics that have only publishers or only subscriptions."""

    def category(self) -> str:
        """Implement `DoctorCheck`."""
        return "topic"

    def check(self) -> Result:
        """Implement `DoctorCheck`."""
        result = Result()
        for name, publishers, subscriptions in _counts():
            if bool(publishers) != bool(subscriptions):
                found, missing = ("Publisher", "subscriber") if publishers else ("Subscriber", "publisher")
                doctor_warn(f"{found} without {missing} detected on {name}.")
                result.add_warning()
        return result


class TopicReport(DoctorReport):
    """Report of the numbers of publishers and subscriptions."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "topic"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("TOPIC LIST")
        for name, publishers, subscriptions in _counts() or [("none", 0, 0)]:
            report.add_to_report("topic", name)
            report.add_to_report("publisher count", publishers)
            report.add_to_report("subscriber count", subscriptions)
        return report


def _counts() -> list[tuple[str, int, int]]:
    with current_graph() as graph:
        return [
            (
                name,
                len(graph.endpoints(EndpointKind.PUBLISHER, name=name)),
                len(graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)),
            )
            for name, _ in topics(graph, include_hidden=False)
            if name not in _ALONE_IS_FINE
        ]
