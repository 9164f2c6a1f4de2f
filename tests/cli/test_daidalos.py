"""`daidalos` itself, and `daidalos extensions`."""

import io
import json

import pytest

from daidalos import __version__
from daidalos.cli.daidalos import main
from daidalos.cli.daidalos.extensions import kinds
from daidalos.common.extensions import first_line, listing, load


def test_the_help_lists_the_verbs_by_their_descriptions(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    shown = capsys.readouterr().out
    (verbs,) = (kind for kind in kinds() if kind.name == "daidalos_verb")
    for extension in listing(verbs):
        assert first_line(load(verbs, extension)) == extension.description
        assert f"  {extension.name:<10}  {extension.description}\n" in shown


def test_the_version_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert (ended.value.code, capsys.readouterr().out) == (0, f"daidalos {__version__}\n")


def test_an_unknown_verb_is_named_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["dmeo"])
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith("Did you mean 'demo'?\n")


@pytest.mark.slow
def test_all_kinds_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["extensions"]) == 0
    shown = capsys.readouterr().out
    for kind in kinds():
        assert f" {kind.name} " in shown
        assert f" {kind.group} " in shown


@pytest.mark.parametrize("word", ["sensor", "sensors"])
def test_extensions_are_listed_with_where_they_come_from(capsys: pytest.CaptureFixture[str], word: str) -> None:
    assert main(["extensions", word]) == 0
    shown = capsys.readouterr().out
    line = next(line for line in shown.splitlines() if "gpu_lidar" in line or "lidar:Lidar" in line)
    assert "daidalos.simulation.sensors.lidar:Lidar" in line
    assert "built in" in line


def test_long_classes_are_folded_and_not_truncated(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr("sys.stdout", shown := Terminal())
    assert main(["extensions", "behavior"]) == 0
    *table, _ = shown.getvalue().splitlines()
    assert max(len(line) for line in table) <= 100
    rows = [line.split() for line in table]
    after = next(i for i, row in enumerate(rows) if row and row[0] == "nav2_behaviors::DriveOnHeading")
    assert rows[after][1] + rows[after + 1][0] == "daidalos.navigation.behaviors.drive_on_heading:DriveOnHeading"


def test_extensions_are_printed_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["extensions", "sensor", "--json"]) == 0
    (sensors,) = json.loads(capsys.readouterr().out).values()
    assert sensors["group"] == "daidalos.sensors"
    assert {
        "name": "ray",
        "aliases": ["lidar", "gpu_ray", "gpu_lidar"],
        "class": "daidalos.simulation.sensors.lidar:Lidar",
        "origin": "built in",
    } in sensors["extensions"]


def test_an_unknown_kind_is_named_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["extensions", "senser"]) == 2
    assert capsys.readouterr().err == "daidalos extensions: there is no kind 'senser'; did you mean 'sensor'?\n"


def test_a_kind_that_is_like_no_other_is_answered_with_where_they_are_listed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["extensions", "zzz"]) == 2
    expected = "daidalos extensions: there is no kind 'zzz'; 'daidalos extensions' lists all kinds\n"
    assert capsys.readouterr().err == expected
