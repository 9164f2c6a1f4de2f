"""The command `daidalos studio`."""

from pathlib import Path

import pytest

from daidalos.bags.writer import BagWriter, WriterOptions
from daidalos.cli.daidalos import main


def call(*words: object) -> int:
    return main(["studio", *map(str, words)])


def test_an_unknown_panel_is_refused_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert call("--open", "plots") == 2
    assert capsys.readouterr().err == "daidalos studio: there is no panel 'plots'; did you mean 'plot'?\n"


@pytest.mark.parametrize(
    ("option", "name", "reason"),
    [
        ("--bag", "absent", "there is no bag at 'absent'"),
        ("--layout", "layout.json", "expected a file .rviz or .xml"),
    ],
)
def test_files_that_cannot_be_used_are_named(
    option: str, name: str, reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(option, name) == 2
    error = capsys.readouterr().err
    assert reason in error
    assert error.count("\n") == 1


def test_a_folder_that_is_no_bag_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call("--bag", tmp_path) == 2
    error = capsys.readouterr().err
    assert str(tmp_path) in error
    assert error.count("\n") == 1


def test_an_empty_bag_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    BagWriter(tmp_path / "empty", WriterOptions("mcap")).close()
    assert call("--bag", tmp_path / "empty") == 2
    assert capsys.readouterr().err == f"daidalos studio: the bag '{tmp_path / 'empty'}' holds no messages\n"


def test_a_layout_that_is_absent_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        call("--layout", "absent.rviz")
    assert ended.value.code == 2
    assert "there is no file 'absent.rviz'" in capsys.readouterr().err
