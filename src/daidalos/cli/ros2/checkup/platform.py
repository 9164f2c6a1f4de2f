"""Platform: machine, Python and middleware."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable
from importlib.metadata import version

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.distribution import DISTRIBUTION
from daidalos.transport.environment import read_environment
from daidalos.transport.graph import Graph
from daidalos.transport.shared import MIDDLEWARES


class Platform(Subject):
    """Machine, Python and ROS 2 distribution."""

    category = "platform"

    def check(self, graph: Graph) -> Findings:
        """Fail if the middleware is missing; warn if the environment is set up for another distribution."""
        findings = Findings()
        middleware = read_environment().middleware
        if middleware not in MIDDLEWARES:
            findings.errors.append(
                f"RMW_IMPLEMENTATION is {middleware}, which is not available; use {' or '.join(MIDDLEWARES)}."
            )
        distribution = os.environ.get("ROS_DISTRO", DISTRIBUTION)
        if distribution != DISTRIBUTION:
            findings.warnings.append(
                f"ROS_DISTRO is {distribution}: the environment of another ROS 2 is set up in this shell, and its "
                "Python packages may come before ours."
            )
        return findings

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return their descriptions."""
        yield Report(
            "PLATFORM INFORMATION",
            (
                ("system", platform.system()),
                ("platform info", platform.platform()),
                ("release", platform.release()),
                ("processor", platform.processor() or platform.machine()),
                ("python", platform.python_version()),
            ),
        )
        yield Report("RMW MIDDLEWARE", (("middleware name", read_environment().middleware),))
        yield Report(
            "ROS 2 INFORMATION",
            (
                ("distribution name", DISTRIBUTION),
                ("distribution type", "ros2"),
                ("distribution status", f"provided by daidalos {version('daidalos')}"),
            ),
        )


SUBJECT = Platform
