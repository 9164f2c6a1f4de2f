"""Identification of the packages that this extension builds."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from colcon_core.logging import colcon_logger
from colcon_core.package_identification import IgnoreLocationException, PackageIdentificationExtensionPoint
from colcon_core.plugin_system import satisfies_version
from colcon_ros.package_identification.ros import RosPackageIdentification, get_package_with_build_type

from daidalos.distribution import complete_environment
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.manifest import read

TYPES = {"ament_cmake": "ros.ament_cmake.daidalos", "catkin": "ros.catkin.daidalos"}
"""Our types of packages, by the build type in package.xml."""
_logger = colcon_logger.getChild(__name__)


class CmakePackageIdentification(PackageIdentificationExtensionPoint):  # type: ignore[misc]
    """Identification of packages of build type ament_cmake and of ROS 1, unless ament_cmake is installed."""

    # Before the extension that knows all ROS packages.
    PRIORITY = RosPackageIdentification.PRIORITY + 10

    def __init__(self) -> None:
        super().__init__()
        satisfies_version(PackageIdentificationExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")
        _prepare_environment()

    def identify(self, desc: Any) -> None:
        """Fill in name and type of a package that this extension builds."""
        if desc.type is not None or any((desc.path / name).exists() for name in ("AMENT_IGNORE", "CATKIN_IGNORE")):
            return
        self._check_manifest(desc.path)
        package, build_type = get_package_with_build_type(str(desc.path))
        if build_type not in TYPES or _has_ament_cmake():
            return
        desc.type = TYPES[build_type]
        desc.name = desc.name or package.name

    def _check_manifest(self, folder: Path) -> None:
        """Report what is wrong with a package.xml in one line, and skip its package."""
        path = folder / "package.xml"
        if not path.is_file():
            return
        try:
            read(path)
        except WorkspaceError as error:
            _logger.error(str(error))
            raise IgnoreLocationException from None


def _prepare_environment() -> None:
    """Set the variables of ROS 2's setup files, for conditions in manifests and for programs of the build.

    The packages of today's courses tell setuptools of their tests as an older one understood; that is no news.
    """
    complete_environment()
    quiet = "ignore:Unknown distribution option:UserWarning"
    before = os.environ.get("PYTHONWARNINGS", "")
    if quiet not in before:
        os.environ["PYTHONWARNINGS"] = f"{before},{quiet}" if before else quiet


def _has_ament_cmake() -> bool:
    """Return whether ROS 2 itself is installed with its build tools."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return any(prefix and os.path.isdir(os.path.join(prefix, "share", "ament_cmake", "cmake")) for prefix in prefixes)
