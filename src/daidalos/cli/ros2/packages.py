"""Names and prefixes of packages."""

from __future__ import annotations

from pathlib import Path

from daidalos.cli.ros2.errors import CliError
from daidalos.common.suggestions import did_you_mean


def package_names() -> list[str]:
    """Return the names of all packages, sorted."""
    from ament_index_python.packages import get_packages_with_prefixes

    return sorted(get_packages_with_prefixes())


def package_prefix(name: str) -> Path:
    """Return a package's prefix; CliError if the package does not exist."""
    from ament_index_python.packages import PackageNotFoundError, get_package_prefix

    try:
        return Path(get_package_prefix(name))
    except (PackageNotFoundError, ValueError):
        from daidalos.cli.ros2.workspace_hints import unknown_package

        raise CliError(f"Package not found{unknown_package(name) or did_you_mean(name, package_names())}") from None
