"""Packages and their folders."""

from __future__ import annotations

import os
import pathlib
import re
import warnings

from .resources import get_resource, get_resources
from .search_paths import get_all_prefixes


class PackageNotFoundError(KeyError):
    """There is no package of this name in any prefix."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the names of all packages, each with the prefix in which it was found first."""
    return get_resources("packages")


def get_package_prefix(package_name: str) -> str:
    """Return the prefix of a package.

    Raises
    ------
    PackageNotFoundError
        If there is no such package.
    ValueError
        If the name cannot be one of a package.
    """
    if not re.fullmatch(r"[a-zA-Z][a-zA-Z0-9_-]*", package_name, re.ASCII):
        raise ValueError(f"'{package_name}' is not a valid package name")
    try:
        return get_resource("packages", package_name)[1]
    except LookupError as error:
        from daidalos.common.suggestions import hint

        meant = hint(package_name, get_packages_with_prefixes())
        raise PackageNotFoundError(
            f"package '{package_name}' not found, searching: {get_all_prefixes()}{meant}"
        ) from error


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the folder `share/<package>` of a package.

    Parameters
    ----------
    package_name
        The package.
    print_warning
        Whether to warn when there is no such folder.

    Raises
    ------
    PackageNotFoundError
        If there is no such package.
    ValueError
        If the name cannot be one of a package.
    """
    path = os.path.join(get_package_prefix(package_name), "share", package_name)
    if print_warning and not os.path.exists(path):
        warnings.warn(f"Share directory for package '{package_name}' ({path}) does not exist.", stacklevel=2)
    return path


def get_package_share_path(package_name: str, print_warning: bool = True) -> pathlib.Path:
    """Return the folder `share/<package>` of a package as a path; see `get_package_share_directory`."""
    return pathlib.Path(get_package_share_directory(package_name, print_warning=print_warning))
