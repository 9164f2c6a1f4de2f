"""Package lookup for the libraries."""

from __future__ import annotations


def package_share(name: str) -> str | None:
    """Return a package's share directory, None when there is no such package."""
    from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

    try:
        return str(get_package_share_directory(name))
    except (PackageNotFoundError, ValueError):
        return None
