"""Checks and reports of other packages, written for ROS 2's doctor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.metadata import entry_points
from typing import Any

from daidalos.cli.ros2.checkup import Findings, Report, Subject
from daidalos.transport.graph import Graph


class AddedCheck(Subject):
    """A class with ``category()`` and ``check() -> Result``; it says itself what is wrong."""

    def __init__(self, check: Any) -> None:
        self._check = check
        self.category = check.category()

    def check(self, graph: Graph) -> Findings:
        """Run it."""
        result = self._check.check()
        fault = f"{self.category} has found something"
        return Findings([fault] * bool(result.error), [fault] * bool(result.warning))

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return none: reports are added by themselves."""
        return ()


class AddedReport(Subject):
    """A class with ``category()`` and ``report() -> Report``."""

    checked = False

    def __init__(self, report: Any) -> None:
        self._report = report
        self.category = report.category()

    def check(self, graph: Graph) -> Findings:
        """Find nothing: checks are added by themselves."""
        return Findings()

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return it."""
        report = self._report.report()
        yield Report(report.name, tuple(report.items))


def added_subjects() -> Iterator[Subject]:
    """Yield what other packages add."""
    for group, kind in (("ros2doctor.checks", AddedCheck), ("ros2doctor.report", AddedReport)):
        for point in entry_points(group=group):
            yield kind(point.load()())
