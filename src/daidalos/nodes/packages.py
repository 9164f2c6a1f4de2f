"""Package lookup for the libraries."""

from __future__ import annotations


def package_share(name: str) -> str | None:
    """Return a package's share directory, None when there is no such package."""
    from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
    from ament_index_python.resources import InvalidResourceNameError, has_resource

    try:
        # Asked first, since the error of a package that is not there searches all names for the nearest.
        return str(get_package_share_directory(name)) if has_resource("packages", name) else None
    except (InvalidResourceNameError, PackageNotFoundError, ValueError):
        return None
