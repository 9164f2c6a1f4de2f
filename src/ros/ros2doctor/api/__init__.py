"""Checks and reports of `ros2 doctor`.

They are entry points of the groups ``ros2doctor.checks`` and ``ros2doctor.report``, as are the built-in ones.
"""

from __future__ import annotations

import importlib.metadata
from collections.abc import Collection, Iterator
from typing import Any

from ros2doctor.api.format import doctor_warn

_CHECKS = "ros2doctor.checks"
_REPORTS = "ros2doctor.report"
_ABOUT_PACKAGES = {"PackageCheck", "PackageReport"}


class DoctorCheck:
    """Base of checks."""

    def category(self) -> str:
        """Return the name that the check has among the failed ones; reports with this category belong to it."""
        raise NotImplementedError

    def check(self) -> Result:
        """Run the check."""
        raise NotImplementedError


class DoctorReport:
    """Base of reports."""

    def category(self) -> str:
        """Return the category of the report; see `DoctorCheck.category`."""
        raise NotImplementedError

    def report(self) -> Report:
        """Return the content of the report."""
        raise NotImplementedError


class Report:
    """Titled list of names and values.

    Parameters
    ----------
    name
        Title.
    """

    __slots__ = ("items", "name")

    def __init__(self, name: str) -> None:
        self.name = name
        self.items: list[tuple[str, Any]] = []

    def add_to_report(self, item_name: str, item_info: Any) -> None:
        """Append a name and its value."""
        self.items.append((item_name, item_info))


class Result:
    """Numbers of errors and warnings that a check has found."""

    __slots__ = ("error", "warning")

    def __init__(self) -> None:
        self.error = 0
        self.warning = 0

    def add_error(self) -> None:
        """Count an error."""
        self.error += 1

    def add_warning(self) -> None:
        """Count a warning."""
        self.warning += 1


def run_checks(
    *, include_warnings: bool = False, exclude_packages: bool | Collection[str] = False
) -> tuple[set[str], int, int]:
    """Run the checks of all packages.

    Parameters
    ----------
    include_warnings
        Whether a warning makes a check fail.
    exclude_packages
        Whether to leave out the check of package versions, or the packages that it leaves out.

    Returns
    -------
    tuple
        Categories of the failed checks, their number and the number of all checks.
    """
    failed: set[str] = set()
    fails = total = 0
    for check in _instances(_CHECKS, exclude_packages):
        try:
            category, result = check.category(), check.check()
        except Exception as error:  # code of other packages may raise anything
            doctor_warn(f"The check {type(check).__name__} failed to run: {error}")
            continue
        total += 1
        if result.error or (include_warnings and result.warning):
            fails += 1
            failed.add(category)
    return failed, fails, total


def generate_reports(
    *, categories: Collection[str] | None = None, exclude_packages: bool | Collection[str] = False
) -> list[Report]:
    """Return the reports of all packages.

    Parameters
    ----------
    categories
        Those to return; all where None or empty.
    exclude_packages
        Whether to leave out the report of package versions, or the packages that it leaves out.
    """
    reports = []
    for report in _instances(_REPORTS, exclude_packages):
        try:
            if not categories or report.category() in categories:
                reports.append(report.report())
        except Exception as error:  # code of other packages may raise anything
            doctor_warn(f"The report {type(report).__name__} failed to run: {error}")
    return reports


def get_topic_names(skip_topics: Collection[str] = ()) -> list[str]:
    """Return the names of the topics in the graph but those of `skip_topics`."""
    from ros2cli.node.strategy import NodeStrategy

    with NodeStrategy(None) as node:
        return [name for name, _ in node.get_topic_names_and_types() if name not in skip_topics]


def _instances(group: str, exclude_packages: bool | Collection[str]) -> Iterator[Any]:
    for point in importlib.metadata.entry_points(group=group):
        about_packages = point.name in _ABOUT_PACKAGES
        if about_packages and exclude_packages is True:
            continue
        try:
            one = point.load()()
        except Exception as error:  # code of other packages may raise anything
            doctor_warn(f"{point.name} of {group} cannot be loaded: {error}")
            continue
        if about_packages and not isinstance(exclude_packages, bool):
            one.excluded = exclude_packages
        yield one
