"""Checks and reports of other packages, written for ROS 2's doctor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.metadata import entry_points
from typing import Any

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.transport.graph import Graph


class AddedCheck(Subject):
    """Check of a class with ``category()`` and ``check() -> Result``, which prints its own messages."""

    def __init__(self, check: Any) -> None:
        self._check = check
        self.category = check.category()

    def check(self, graph: Graph) -> Findings:
        """Run the check."""
        result = self._check.check()
        fault = f"{self.category} has found something"
        return Findings([fault] * bool(result.error), [fault] * bool(result.warning))

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return no reports; they are subjects of their own."""
        return ()


class AddedReport(Subject):
    """Report of a class with ``category()`` and ``report() -> Report``."""

    checked = False

    def __init__(self, report: Any) -> None:
        self._report = report
        self.category = report.category()

    def check(self, graph: Graph) -> Findings:
        """Return no findings; checks are subjects of their own."""
        return Findings()

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the report."""
        report = self._report.report()
        yield Report(report.name, tuple(report.items))


def added_subjects() -> Iterator[Subject]:
    """Yield the subjects of other packages."""
    for group, kind in (("ros2doctor.checks", AddedCheck), ("ros2doctor.report", AddedReport)):
        for point in entry_points(group=group):
            yield kind(point.load()())
