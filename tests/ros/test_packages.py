"""Every drop-in Python package is a ROS package, too, which tools find by its name."""

from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_path

PACKAGES = sorted(path.parent.name for path in Path(__file__).parents[2].glob("src/ros/*/__init__.py"))


@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_is_in_the_index(name):
    text = (get_package_share_path(name) / "package.xml").read_text()
    assert f"<name>{name}</name>" in text
