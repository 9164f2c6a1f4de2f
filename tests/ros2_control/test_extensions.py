"""Classes of ros2_control by the names that files give them."""

from pathlib import Path

import pytest

from daidalos.common.extensions import ExtensionError, UnknownExtension, find, listing
from daidalos.control.controllers.diff_drive import DiffDriveController
from daidalos.control.extensions import CONTROLLERS, HARDWARE, hardware_class
from daidalos.control.hardware.generic import GenericSystem
from daidalos.description import urdf
from daidalos.description.ros2_control import read_hardware

OWN = """
from daidalos.control.contracts import Controller
class Mine(Controller): ...
class Other: ...
"""
ROBOT = """<robot name="r"><link name="a"/>
<ros2_control name="arm" type="system">
<hardware><plugin>mock_component/GenericSystem</plugin></hardware>
</ros2_control></robot>"""


def test_ours_have_upstreams_names() -> None:
    assert find(CONTROLLERS, "diff_drive_controller/DiffDriveController") is DiffDriveController
    assert find(HARDWARE, "mock_components/GenericSystem") is GenericSystem
    assert all(one.name.count("/") == 1 for one in listing(CONTROLLERS))


@pytest.mark.parametrize("name", ["own_controllers.Mine", "own_controllers/Mine", "own_controllers::Mine"])
def test_the_users_are_found_by_their_class_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    (tmp_path / "own_controllers.py").write_text(OWN, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    assert find(CONTROLLERS, name).__name__ == "Mine"
    with pytest.raises(ExtensionError, match="own_controllers:Other is not a Controller"):
        find(CONTROLLERS, "own_controllers/Other")
    with pytest.raises(ExtensionError, match="own_controllers:Mine is not a Hardware"):
        find(HARDWARE, "own_controllers/Mine")


def test_unknown_hardware_is_named_with_the_file_and_the_nearest_names() -> None:
    (info,) = read_hardware(urdf.parse(ROBOT, "arm.urdf"))
    with pytest.raises(UnknownExtension) as caught:
        hardware_class(info)
    assert str(caught.value) == (
        "arm.urdf:2: 'arm': there is no hardware 'mock_component/GenericSystem'; "
        "did you mean 'mock_components/GenericSystem' or 'fake_components/GenericSystem'?"
    )
    with pytest.raises(UnknownExtension, match="there is no controller 'Plain'"):
        find(CONTROLLERS, "Plain")
