"""Middleware."""

from __future__ import annotations

from daidalos.transport.environment import read_environment
from ros2doctor.api import DoctorReport, Report


class RMWReport(DoctorReport):
    """Report of the middleware."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "middleware"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("RMW MIDDLEWARE")
        report.add_to_report("middleware name", read_environment().middleware)
        return report
