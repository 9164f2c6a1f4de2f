"""Machine, Python and ROS 2 distribution."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version

from daidalos.distribution import DISTRIBUTION
from daidalos.transport.environment import read_environment
from daidalos.transport.shared import MIDDLEWARES
from ros2doctor.api import DoctorCheck, DoctorReport, Report, Result
from ros2doctor.api.format import doctor_error, doctor_warn


class PlatformCheck(DoctorCheck):
    """Check that fails without the middleware, and warns of an environment of another distribution."""

    def category(self) -> str:
        """Implement `DoctorCheck`."""
        return "platform"

    def check(self) -> Result:
        """Implement `DoctorCheck`."""
        result = Result()
        middleware = read_environment().middleware
        if middleware not in MIDDLEWARES:
            doctor_error(f"RMW_IMPLEMENTATION is {middleware}, which is not available; use {' or '.join(MIDDLEWARES)}.")
            result.add_error()
        distribution = os.environ.get("ROS_DISTRO", DISTRIBUTION)
        if distribution != DISTRIBUTION:
            doctor_warn(
                f"ROS_DISTRO is {distribution}: the environment of another ROS 2 is set up in this shell, and its "
                "Python packages may come before ours."
            )
            result.add_warning()
        return result


class PlatformReport(DoctorReport):
    """Report of machine and Python."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "platform"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("PLATFORM INFORMATION")
        report.add_to_report("system", platform.system())
        report.add_to_report("platform info", platform.platform())
        report.add_to_report("release", platform.release())
        report.add_to_report("processor", platform.processor() or platform.machine())
        report.add_to_report("python", platform.python_version())
        return report


class RosdistroReport(DoctorReport):
    """Report of the ROS 2 distribution."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "platform"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("ROS 2 INFORMATION")
        report.add_to_report("distribution name", DISTRIBUTION)
        report.add_to_report("distribution type", "ros2")
        report.add_to_report("distribution status", f"provided by daidalos {version('daidalos')}")
        return report
