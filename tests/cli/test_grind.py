"""`daidalos grind`: what is written and printed, and what is wrong with what was typed."""

import json

import numpy as np
import pytest

from daidalos.cli.daidalos import main
from daidalos.industry.grinding.height_field import as_arrays
from daidalos.industry.grinding.workpieces import plate


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.npz"
    np.savez(path, **as_arrays(plate(0.12, 60e-6, resolution=1e-3)))
    return str(path)


@pytest.mark.slow
def test_plate_is_ground_written_and_compared(small, tmp_path, capsys):
    out = tmp_path / "out"
    command = ["grind", "plate", "--input", small, "--depth", "60", "--force", "20"]
    assert main([*command, "-o", str(out), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["after"]["within_percent"] > 99.0
    assert printed["passes"][0]["removed_mm3"] == pytest.approx(printed["passes"][0]["predicted_mm3"], rel=0.2)
    assert sorted(file.name for file in out.iterdir()) == [
        "figures.json", "pass_1.npz", "report.html", "workpiece.npz",
    ]  # fmt: skip
    assert main([*command, "-o", str(out)]) == 2
    assert "out: is not empty; choose another folder" in capsys.readouterr().err
    assert main(["grind", "compare", str(out), str(out), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert {"figure": "task", "first": "plate", "second": "plate"} not in rows
    assert all(row["first"] == row["second"] for row in rows)


@pytest.mark.slow
def test_a_fault_ends_with_its_reason_and_an_exit_status(small, tmp_path, capsys):
    out = tmp_path / "out"
    command = ["grind", "plate", "--input", small, "--fault", "sensor_nan@1.5", "-o", str(out)]
    assert main(command) == 1
    error = capsys.readouterr().err
    assert error.startswith("daidalos grind: plate: pass 1: the force sensor sends nan (at 1.5")
    assert error.count("\n") == 1
    assert "sensor sends nan" in json.loads((out / "figures.json").read_text())["problem"]


@pytest.mark.slow
def test_force_control_is_compared(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["grind", "force", "--controller", "pi", "--set", "integral=5", "-o", str(out), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["controllers"]["pi"]
    assert found["within_goals"]
    assert sorted(file.name for file in out.iterdir()) == ["figures.json", "pi.npz", "report.html"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["force", "--controller", "p"], "there is no force controller 'p'"),
        (["force", "--controller", "pi", "--set", "integral"], "--set is 'integral', but NAME=VALUE is expected"),
        (["force", "--controller", "pi", "--set", "integral=x"], "--set integral: 'x' is no finite number"),
        (["force", "--controller", "pi", "--set", "integrl=1"], "'integrl'"),
        (["force", "--set", "integral=1"], "--set needs one --controller"),
        (["force", "--fault", "sensor@1"], "there is no fault 'sensor'"),
        (["force", "--fault", "sensor_nan"], "'sensor_nan' is no fault; KIND@SECONDS is expected"),
        (["force", "--cell", "none.yaml"], "none.yaml: there is no such file"),
        (["force", "--seed", "-1"], "--seed is -1"),
        (["plate", "--input", "none.npz"], "none.npz: there is no such file"),
        (["plate", "--depth", "0"], "--depth is 0, but must be 1 to 1000 um"),
        (["plate", "--spacing", "100"], "--spacing is 100"),
        (["plate", "--force", "500", "--depth", "500"], "the force is 500 N, but must be 5 to 120 N"),
        (["plate", "--depth", "1", "--force", "100"], "needs a feed of"),
        (["plate", "--resolution", "0"], "--resolution is 0"),
        (["plate", "--resolution", "2", "--place", "9000", "0", "0"], "can not follow the path: point 1 is out of"),
        (["plate", "--resolution", "2", "--robot", "irb870"], "there is no arm 'irb870'; did you mean 'irb8700'"),
        (["plate", "--place", "1"], "--place has 1 values"),
        (["clamp", "--tolerance", "1"], "--tolerance is 1, but must be 20 to 2000 um"),
        (["clamp", "--excess", "50"], "--excess is 50"),
        (["clamp", "--max-passes", "0"], "--max-passes is 0"),
        (["compare", "here", "there"], "here: there is no such file"),
    ],
)
def test_what_is_wrong_is_one_line(arguments, message, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    output = [] if arguments[0] == "compare" else ["-o", "out"]
    assert main(["grind", *arguments, *output]) in (1, 2)
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
