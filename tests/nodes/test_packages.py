"""What packages export to Gazebo."""

import os
from pathlib import Path

import pytest

from daidalos.nodes.packages import exported_model_folders, model_path_with_exports


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a prefix with its packages' index that comes first in the search path."""
    (tmp_path / "share/ament_index/resource_index/packages").mkdir(parents=True)
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(tmp_path), os.environ.get("AMENT_PREFIX_PATH", "")]))
    return tmp_path


def add_package(prefix: Path, name: str, exports: str) -> Path:
    share = prefix / "share" / name
    share.mkdir(parents=True)
    (prefix / "share/ament_index/resource_index/packages" / name).touch()
    (share / "package.xml").write_text(f"<package><name>{name}</name><export>{exports}</export></package>")
    return share


def test_exported_folders_stand_in_the_share_directory(install: Path) -> None:
    share = add_package(install, "a_robot", '<gazebo_ros gazebo_model_path="${prefix}/models:${prefix}/more"/>')
    assert exported_model_folders()[:2] == [f"{share}/models", f"{share}/more"]


def test_the_model_path_of_the_environment_comes_first(install: Path) -> None:
    share = add_package(install, "a_robot", '<gazebo_ros gazebo_media_path="${prefix}/.."/>')
    path = model_path_with_exports({"GZ_SIM_RESOURCE_PATH": "/mine"})["GZ_SIM_RESOURCE_PATH"]
    assert path.split(os.pathsep)[:2] == ["/mine", f"{share}/.."]


def test_a_manifest_that_is_no_xml_exports_nothing(install: Path) -> None:
    share = add_package(install, "a_robot", "")
    before = exported_model_folders()
    (share / "package.xml").write_text('<package><export><gazebo_ros gazebo_model_path="x"')
    assert exported_model_folders() == before
