"""Packages and their versions."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from xml.etree import ElementTree

from ament_index_python.packages import get_packages_with_prefixes

from ros2doctor.api import DoctorCheck, DoctorReport, Report, Result
from ros2doctor.api.format import doctor_warn

_VERSION = re.compile(r"\d+\.\d+\.\d+")


class PackageCheck(DoctorCheck):
    """Check that warns of packages whose version cannot be read.

    Parameters
    ----------
    excluded
        Names of packages that are left out.
    """

    def __init__(self, excluded: Collection[str] = ()) -> None:
        self.excluded = excluded

    def category(self) -> str:
        """Implement `DoctorCheck`."""
        return "package"

    def check(self) -> Result:
        """Implement `DoctorCheck`."""
        result = Result()
        for name, version in _versions(self.excluded).items():
            if not _VERSION.fullmatch(version):
                doctor_warn(f"The version of package {name} cannot be read from its package.xml.")
                result.add_warning()
        return result


class PackageReport(DoctorReport):
    """Report of the versions.

    Parameters
    ----------
    excluded
        Names of packages that are left out.
    """

    def __init__(self, excluded: Collection[str] = ()) -> None:
        self.excluded = excluded

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "package"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("PACKAGE VERSIONS")
        for name, version in _versions(self.excluded).items():
            report.add_to_report(name, f"local={version or 'unknown'}")
        return report


def _versions(excluded: Collection[str]) -> dict[str, str]:
    found = sorted(get_packages_with_prefixes().items())
    return {name: _version(Path(prefix), name) for name, prefix in found if name not in excluded}


def _version(prefix: Path, name: str) -> str:
    try:
        root = ElementTree.parse(prefix / "share" / name / "package.xml").getroot()
    except (OSError, LookupError, ElementTree.ParseError):
        return ""
    return (root.findtext("version") or "").strip()
