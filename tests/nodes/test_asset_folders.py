"""Which files of the disk the studio serves to the page."""

import os
from pathlib import Path

import pytest

from daidalos.nodes.asset_folders import is_asset_readable, record_model_path, record_named_files


@pytest.fixture(autouse=True)
def environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Set a runtime folder, a home and no packages but ours."""
    runtime = tmp_path / "runtime"
    runtime.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(runtime))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    for variable in ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"):
        monkeypatch.delenv(variable, raising=False)
    return tmp_path


def made(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"")
    return path.resolve()


def test_files_of_built_in_packages(environment: Path) -> None:
    from ament_index_python.packages import get_package_share_path

    share = get_package_share_path("turtlebot3_gazebo").resolve()
    assert is_asset_readable(share / "meshes" / "any.stl")
    assert not is_asset_readable(share.parent / "no_such_package" / "any.stl")
    assert not is_asset_readable(share.parent / "any.stl")
    assert not is_asset_readable(Path("/etc/any.png"))


@pytest.mark.parametrize("prefix", ["install", "install/arm"])
def test_sources_of_a_workspace(environment: Path, monkeypatch: pytest.MonkeyPatch, prefix: str) -> None:
    workspace = environment / "ws"
    made(workspace / prefix / "share" / "ament_index" / "resource_index" / "packages" / "arm")
    (workspace / "build").mkdir()
    mesh = made(workspace / "src" / "arm" / "meshes" / "a.stl")
    elsewhere = made(environment / "git" / "leg" / "b.stl")
    assert not is_asset_readable(mesh)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(workspace / prefix))
    assert is_asset_readable(mesh)
    assert is_asset_readable(workspace.resolve() / prefix / "share" / "arm" / "c.stl")
    assert not is_asset_readable(elsewhere)
    assert not is_asset_readable(made(workspace / "private.png"))
    try:
        os.symlink(elsewhere.parent, workspace / "src" / "leg")
        os.symlink(environment, workspace / "src" / "arm" / "everything")
    except OSError:
        pytest.skip("this system makes no links")
    assert is_asset_readable(elsewhere)
    assert not is_asset_readable(environment.resolve() / "a.png")


def test_the_model_path_and_what_a_simulator_recorded_of_it(environment: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = made(environment / "models" / "rock" / "rock.dae")
    assert not is_asset_readable(mesh)
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(environment / "models"))
    assert is_asset_readable(mesh)
    record_model_path()
    monkeypatch.delenv("GZ_SIM_RESOURCE_PATH")
    assert is_asset_readable(mesh)


def test_files_on_a_command_line(environment: Path) -> None:
    description = made(environment / "robot" / "urdf" / "robot.urdf")
    mesh = made(environment / "robot" / "meshes" / "arm.stl")
    beside = made(environment / "robot" / "urdf" / "arm.stl")
    assert not is_asset_readable(beside)
    record_named_files(["--ros-args", str(description), "a" * 100_000, "missing.urdf", "\0.urdf"])
    assert is_asset_readable(beside)
    assert not is_asset_readable(mesh)
    made(environment / "robot" / "package.xml")
    record_named_files([f"model:={description}"])
    assert is_asset_readable(mesh)


def test_a_file_in_the_home_folder_opens_not_the_folders_within(environment: Path) -> None:
    description = made(environment / "home" / "robot.urdf")
    made(environment / "home" / "package.xml")
    record_named_files([str(description)])
    assert is_asset_readable(made(environment / "home" / "arm.stl"))
    assert not is_asset_readable(made(environment / "home" / "photos" / "a.png"))


def test_other_files_on_a_command_line_open_nothing(environment: Path) -> None:
    parameters = made(environment / "parameters.yaml")
    record_named_files(["--params-file", str(parameters)])
    assert not is_asset_readable(made(environment / "a.png"))
    record = next((environment / "runtime").rglob("*.json"), None)
    assert record is None
