"""Package lookup for the libraries."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree


def package_share(name: str) -> str | None:
    """Return a package's share directory, None when there is no such package."""
    from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
    from ament_index_python.resources import InvalidResourceNameError, has_resource

    try:
        # Asked first, since the error of a package that is not there searches all names for the nearest.
        return str(get_package_share_directory(name)) if has_resource("packages", name) else None
    except (InvalidResourceNameError, PackageNotFoundError, ValueError):
        return None


def exported_model_folders() -> list[str]:
    """Return the folders that packages export to Gazebo as ``gazebo_model_path`` and ``gazebo_media_path``.

    A ``${prefix}`` in them stands for the package's share directory, as in gazebo_ros and ros_gz_sim.
    """
    from ament_index_python.packages import get_packages_with_prefixes

    found: list[str] = []
    for name, prefix in sorted(get_packages_with_prefixes().items()):
        share = Path(prefix) / "share" / name
        for exported in _gazebo_exports(share / "package.xml"):
            for attribute in ("gazebo_model_path", "gazebo_media_path"):
                folders = exported.get(attribute, "").replace("${prefix}", str(share)).split(os.pathsep)
                found += [folder for folder in folders if folder and folder not in found]
    return found


def model_path_with_exports(environment: Mapping[str, str]) -> dict[str, str]:
    """Return ``GZ_SIM_RESOURCE_PATH`` of an environment, followed by what packages export."""
    name = "GZ_SIM_RESOURCE_PATH"
    folders = filter(None, (environment.get(name, ""), *exported_model_folders()))
    return {name: os.pathsep.join(folders)}


def _gazebo_exports(manifest: Path) -> list[ElementTree.Element]:
    """Return the ``gazebo_ros`` elements among a manifest's exports; none where it cannot be read."""
    try:
        text = manifest.read_bytes()
        return ElementTree.fromstring(text).findall("export/gazebo_ros") if b"<gazebo_ros" in text else []
    except (OSError, ElementTree.ParseError):
        return []
