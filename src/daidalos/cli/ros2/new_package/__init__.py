"""Files of new packages."""

from __future__ import annotations

from collections.abc import Iterator

from daidalos.cli.ros2.new_package.package import Entry, NewPackage

__all__ = ["Entry", "NewPackage", "files_of"]


def files_of(package: NewPackage) -> Iterator[Entry]:
    """Yield the files and folders of a package in the order of their creation."""
    # Every command loads this module, and few write XML.
    from daidalos.cli.ros2.new_package import cmake, python
    from daidalos.cli.ros2.new_package.manifest import package_xml

    yield Entry("package.xml", package_xml(package))
    yield from (python if package.build_type == "ament_python" else cmake).files(package)
