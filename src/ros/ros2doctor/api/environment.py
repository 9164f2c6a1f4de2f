"""Environment variables of ROS 2."""

from __future__ import annotations

import os

from ros2doctor.api import DoctorReport, Report

_PREFIXES = ("ROS_", "RMW_", "RCUTILS_", "ZENOH_", "AMENT_", "COLCON_", "DAIDALOS_", "CYCLONEDDS_")


class EnvironmentReport(DoctorReport):
    """Report of the environment variables that ROS 2 and its tools read."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "environment"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("ENVIRONMENT INFORMATION")
        found = sorted((name, value) for name, value in os.environ.items() if name.startswith(_PREFIXES))
        for name, value in found or [("variables", "none is set")]:
            report.add_to_report(name, value)
        return report
