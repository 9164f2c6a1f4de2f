"""Manifests of packages."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.transport.graph import Graph

_VERSION = re.compile(r"\d+\.\d+\.\d+")


class Package(Subject):
    """Packages and their versions."""

    category = "package"
    excluded: frozenset[str] = frozenset()

    def check(self, graph: Graph) -> Findings:
        """Warn of packages whose version cannot be read."""
        bad = [name for name, version in self._versions().items() if not _VERSION.fullmatch(version)]
        return Findings(
            warnings=[f"The version of package {name} cannot be read from its package.xml." for name in bad]
        )

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the versions."""
        items = tuple((name, f"local={version or 'unknown'}") for name, version in self._versions().items())
        yield Report("PACKAGE VERSIONS", items)

    def _versions(self) -> dict[str, str]:
        from ament_index_python.packages import get_packages_with_prefixes

        found = sorted(get_packages_with_prefixes().items())
        return {name: _version(Path(prefix), name) for name, prefix in found if name not in self.excluded}


def _version(prefix: Path, name: str) -> str:
    try:
        root = ElementTree.parse(prefix / "share" / name / "package.xml").getroot()
    except (OSError, LookupError, ElementTree.ParseError):
        return ""
    return (root.findtext("version") or "").strip()


SUBJECT = Package
