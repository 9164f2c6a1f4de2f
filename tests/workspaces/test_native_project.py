"""What CMake's complaints mean."""

import pytest

from daidalos.workspaces.native.project import missing_package


@pytest.mark.parametrize(
    ("text", "package"),
    [
        ('Could not find a package\n  configuration file provided by "moveit_core" with any of', "moveit_core"),
        ("Could NOT find OpenCV (missing: OpenCV_DIR)", "OpenCV"),
        ("ament_target_dependencies() the passed package name 'class_loader' was not\n  found before", "class_loader"),
        ("CMake Error at CMakeLists.txt:1: Parse error.", None),
    ],
)
def test_the_missing_package_is_named(text: str, package: str | None) -> None:
    assert missing_package(text) == package
