"""Packages: which there are and where they are."""

from __future__ import annotations

from typing import Any

from ament_index_python.packages import get_packages_with_prefixes
from ament_index_python.resources import has_resource


class PackageNotFound(Exception):
    """There is no such package.

    Parameters
    ----------
    package_name
        Of the package.
    """

    def __init__(self, package_name: str) -> None:
        super().__init__(f"Package '{package_name}' not found")
        self.package_name = package_name


def get_package_names() -> list[str]:
    """Return the names of all packages."""
    return list(get_packages_with_prefixes())


def get_prefix_path(package_name: str) -> str | None:
    """Return the prefix of a package; None where there is no such package."""
    return has_resource("packages", package_name) or None


def package_name_completer(**kwargs: Any) -> list[str]:
    """Return the packages that an argument may be."""
    return get_package_names()
