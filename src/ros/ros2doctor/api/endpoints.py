"""Services and actions."""

from __future__ import annotations

from ros2cli.listing import action_parties, all_actions, services

from daidalos.transport.graph import EndpointKind
from ros2doctor.api import DoctorReport, Report
from ros2doctor.api.graph import current_graph


class ServiceReport(DoctorReport):
    """Report of the numbers of servers and clients of services."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "service"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        with current_graph() as graph:
            counts = [
                (
                    name,
                    len(graph.endpoints(EndpointKind.SERVICE, name=name)),
                    len(graph.endpoints(EndpointKind.CLIENT, name=name)),
                )
                for name, _ in services(graph, include_hidden=False)
            ]
        report = Report("SERVICE LIST")
        for name, servers, clients in counts or [("none", 0, 0)]:
            report.add_to_report("service", name)
            report.add_to_report("service count", servers)
            report.add_to_report("client count", clients)
        return report


class ActionReport(DoctorReport):
    """Report of the numbers of servers and clients of actions."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "action"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        with current_graph() as graph:
            counts = [
                (
                    name,
                    len(action_parties(graph, name, EndpointKind.PUBLISHER)),
                    len(action_parties(graph, name, EndpointKind.SUBSCRIPTION)),
                )
                for name, _ in all_actions(graph)
            ]
        report = Report("ACTION LIST")
        for name, servers, clients in counts or [("none", 0, 0)]:
            report.add_to_report("action", name)
            report.add_to_report("action server count", servers)
            report.add_to_report("action client count", clients)
        return report
