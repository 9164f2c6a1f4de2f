"""Environment variables of ROS 2."""

from __future__ import annotations

import os
from collections.abc import Iterable

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.transport.graph import Graph

_PREFIXES = ("ROS_", "RMW_", "RCUTILS_", "ZENOH_", "AMENT_", "COLCON_", "DAIDALOS_", "CYCLONEDDS_")


class Environment(Subject):
    """Environment variables of ROS 2."""

    category = "environment"
    checked = False

    def check(self, graph: Graph) -> Findings:
        """Return no findings; an invalid value is an error where it is read."""
        return Findings()

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the values of the variables."""
        found = sorted((name, value) for name, value in os.environ.items() if name.startswith(_PREFIXES))
        yield Report("ENVIRONMENT INFORMATION", tuple(found) or (("variables", "none is set"),))


SUBJECT = Environment
