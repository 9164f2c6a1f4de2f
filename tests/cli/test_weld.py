"""`daidalos weld`: what is written and printed, and what is wrong with what was typed."""

import json

import pytest

from daidalos.cli.daidalos import main

WRENCH = ["--wrench", "420", "-175", "8000", "0", "0", "7"]
LINE = "x_mm,y_mm,z_mm\n2300,200,900\n2300,-200,900\n"


@pytest.fixture
def line(tmp_path):
    path = tmp_path / "line.csv"
    path.write_text(LINE)
    return path


def test_plan_writes_programs_points_figures_and_a_report(line, tmp_path, capsys):
    out = tmp_path / "corrected"
    assert main(["weld", "plan", str(line), *WRENCH, "--no-backlash", "-o", str(out), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["before"]["across_rms_mm"] == pytest.approx(2.6, abs=0.1)
    assert printed["before"]["along_tool_rms_mm"] == pytest.approx(5.9, abs=0.1)
    assert printed["after"]["along_tool_rms_mm"] < 0.001
    assert printed["convergence"][-1]["distance_mm"] < 1e-3
    assert sorted(file.name for file in out.iterdir()) == [
        "plan.json", "report.html", "weld_line.csv", "weld_line.mod", "weld_line.src",
    ]  # fmt: skip
    assert json.loads((out / "plan.json").read_text())["points"] == 100
    page = (out / "report.html").read_text()
    assert page.count("<svg") == 9
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    assert main(["rapid", "check", str(out / "weld_line.mod")]) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "has no columns fx, fy, fz, mx, my, mz; give --wrench"),
        (["--wrench", "1", "2"], "--wrench has 2 values, but FX FY FZ [N] MX MY MZ [Nm] are expected"),
        ([*WRENCH, "--robot", "kr500"], "there is no arm 'kr500'; did you mean 'kr500_2mt'"),
        (
            [*WRENCH, "--robot", "irb6700"],
            "the stiffness of ABB IRB 6700-150/3.20 is not known; give --elasticity FILE",
        ),
        ([*WRENCH, "--elasticity", "none.yaml"], "none.yaml: there is no such file"),
        ([*WRENCH, "--place", "3000", "0", "0"], "can not follow the path: point 1 is out of reach"),
        ([*WRENCH, "--place", "3000", "0"], "--place has 2 values"),
        ([*WRENCH, "--speed", "0"], "--speed is 0, but must be greater than 0"),
        ([*WRENCH, "--points", "1"], "--points is 1, but must be 2"),
        ([*WRENCH, "--rotation", "x"], "--rotation is 'x'"),
        ([*WRENCH, "--process", "fsw"], "--wrench and --process exclude each other"),
        (["--process", "fws"], "fws: there is no such file, and no process model of this name but 'fsw'"),
        (["--process", "fsw", "--spindle", "0"], "--spindle is 0, but must be greater than 0 rpm"),
        (["--process", "fsw", "--speed", "5000"], "the feed is 5000 mm/min, but the process model 'fsw' holds for"),
        (["--wrench", "0", "0", "9e6", "0", "0", "0"], "the load winds axis"),
    ],
)
def test_what_is_wrong_is_one_line(arguments, message, line, tmp_path, capsys):
    assert main(["weld", "plan", str(line), "-o", str(tmp_path / "out"), *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_process_model_tells_the_wrench(line, tmp_path, capsys):
    out = str(tmp_path / "out")
    assert main(["weld", "plan", str(line), "--process", "fsw", "--spindle", "1600", "-o", out, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["wrench"]["fz"]["least"] == pytest.approx(8000.0 * 2.0**-0.3, abs=0.01)
    assert printed["process"]["components"]["fz"]["spindle_exponent"] == -0.3


def test_nothing_is_written_over(line, tmp_path, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / "report.html").write_text("mine")
    assert main(["weld", "plan", str(line), *WRENCH, "-o", str(out)]) == 2
    assert "report.html: is there already" in capsys.readouterr().err
    assert [file.name for file in out.iterdir()] == ["report.html"]


def test_experiment_refuses_what_is_wrong(tmp_path, capsys):
    assert main(["weld", "experiment", "line", "--truth", str(tmp_path / "none.yaml")]) == 2
    assert "none.yaml: there is no such file" in capsys.readouterr().err
    assert main(["weld", "experiment", "line", "--seed", "-1"]) == 2
    assert "--seed is -1" in capsys.readouterr().err


def test_a_robot_is_identified_from_poses_to_its_elasticity(tmp_path, capsys):
    poses, measured, runs, mine = (str(tmp_path / name) for name in ("p.csv", "m.csv", "f.csv", "mine.yaml"))
    assert main(["weld", "poses", "--count", "8", "-o", poses]) == 0
    assert main(["weld", "measure", poses, "-o", measured, "--friction-output", runs]) == 0
    capsys.readouterr()
    assert main(["weld", "identify", measured, "--runs", runs, "-o", mine, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["axes"][0]["stiffness_nm_per_rad"] == pytest.approx(2.3e6, rel=0.1)
    assert found["axes"][0]["backlash_arcmin"] == pytest.approx(5.01, abs=0.6)
    assert [one["axis"] for one in found["friction"]] == [1, 2, 3, 4, 5, 6]
    line = tmp_path / "line.csv"
    line.write_text(LINE)
    assert main(["weld", "plan", str(line), *WRENCH, "--elasticity", mine, "-o", str(tmp_path / "out")]) == 0
    assert main(["weld", "identify", measured, "-o", mine]) == 2
    assert "mine.yaml: is there already" in capsys.readouterr().err
    assert main(["weld", "identify", poses]) == 2
    assert "p.csv:1: has no column 'x_mm'" in capsys.readouterr().err
    assert main(["weld", "poses", "--count", "1", "-o", poses]) == 2
    assert main(["weld", "poses", "--tool", "0", "0", "500", "-o", str(tmp_path / "q.csv")]) == 2
    assert "no poses load all axes" in capsys.readouterr().err
