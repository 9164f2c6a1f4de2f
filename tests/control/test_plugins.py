"""Classes by the names that files give them."""

from pathlib import Path

import pytest

from daidalos.control.controllers.diff_drive import DiffDriveController
from daidalos.control.errors import ControlError, UnknownError
from daidalos.control.hardware.generic import GenericSystem
from daidalos.control.plugins import controller_class, controllers, hardware_class

MODULE = """
import nothing_that_is_there
"""
OWN = """
from daidalos.control.controllers.base import Controller
class Mine(Controller): ...
class Other: ...
"""


def test_ours_have_upstreams_names() -> None:
    assert controller_class("diff_drive_controller/DiffDriveController") is DiffDriveController
    assert hardware_class("mock_components/GenericSystem") is GenericSystem
    assert all(name.count("/") == 1 for name in controllers())


@pytest.mark.parametrize("name", ["own_controllers.Mine", "own_controllers/Mine", "own_controllers::Mine"])
def test_the_users_are_found_by_their_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    (tmp_path / "own_controllers.py").write_text(OWN, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    assert controller_class(name).__name__ == "Mine"
    with pytest.raises(ControlError, match="module 'own_controllers' has no Controller class 'Other'"):
        controller_class("own_controllers/Other")
    with pytest.raises(ControlError, match="has no Hardware class 'Mine'"):
        hardware_class("own_controllers/Mine")


def test_what_is_not_there_is_said_with_what_is_near(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UnknownError, match="no hardware plugin 'mock_component/GenericSystem'; did you mean mock_comp"):
        hardware_class("mock_component/GenericSystem")
    with pytest.raises(UnknownError, match="no controller type 'Plain'"):
        controller_class("Plain")
    (tmp_path / "needs_more.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(
        ControlError, match="'needs_more/It' can not be imported: No module named 'nothing_that_is_there'"
    ):
        controller_class("needs_more/It")
