"""Identification of the packages that this extension builds."""

from __future__ import annotations

import os
import sys
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
"""Our types of packages without CMake, by the build type in package.xml."""
PYTHON_TYPE = "ros.ament_python.daidalos"
"""Our type of packages of build type ament_python."""
_OLD_NEWS = ("ignore:Unknown distribution option:UserWarning", "ignore:License classifiers are deprecated")
"""Warnings of setuptools about what the setup.py of nearly every package of ROS 2 says."""

_logger = colcon_logger.getChild(__name__)


class CmakePackageIdentification(PackageIdentificationExtensionPoint):  # type: ignore[misc]
    """Identification of packages of build type ament_python, and of ament_cmake and ROS 1 unless that is installed."""

    # Before the extension that knows all ROS packages.
    PRIORITY = RosPackageIdentification.PRIORITY + 10

    def __init__(self) -> None:
        super().__init__()
        satisfies_version(PackageIdentificationExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")
        _prepare_environment()
        _warn_inside_sources()

    def identify(self, desc: Any) -> None:
        """Fill in name and type of a package that this extension builds."""
        if desc.type is not None or any((desc.path / name).exists() for name in ("AMENT_IGNORE", "CATKIN_IGNORE")):
            return
        self._check_manifest(desc.path)
        package, build_type = get_package_with_build_type(str(desc.path))
        if build_type == "ament_python":
            desc.type = PYTHON_TYPE
        elif build_type in TYPES and not _has_ament_cmake():
            desc.type = TYPES[build_type]
        else:
            return
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

    The packages of today's courses tell setuptools of their tests and licenses as an older one understood.
    """
    complete_environment()
    wanted = os.environ.get("PYTHONWARNINGS", "").split(",")
    os.environ["PYTHONWARNINGS"] = ",".join(filter(None, dict.fromkeys([*wanted, *_OLD_NEWS])))


def _warn_inside_sources() -> None:
    """Warn of a build within the folder of the sources, whose results no other terminal would look for there."""
    here = Path.cwd()
    sources = here if here.name == "src" else here.parent
    own_places = {"--build-base", "--install-base", "--base-paths"}
    if "build" not in sys.argv[1:] or own_places.intersection(sys.argv) or sources.name != "src":
        return
    if here == sources or (here / "package.xml").is_file():
        _logger.warning(
            f"'{here}' is a folder of sources: 'build', 'install' and 'log' are made in it. "
            f"To build the workspace run 'colcon build' in '{sources.parent}'"
        )


def _has_ament_cmake() -> bool:
    """Return whether ROS 2 itself is installed with its build tools."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return any(prefix and os.path.isdir(os.path.join(prefix, "share", "ament_cmake", "cmake")) for prefix in prefixes)
