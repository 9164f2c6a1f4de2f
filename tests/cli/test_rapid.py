"""`daidalos rapid` from the shell."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.cli.daidalos import main

GOOD = 'MODULE m\nPROC main()\nTPWrite "hello";\nENDPROC\nENDMODULE\n'
BAD = "MODULE m\nPROC main()\nTPWrite 5\nx := 1;\nENDPROC\nENDMODULE\n"


@pytest.fixture
def good(tmp_path: Path) -> Path:
    path = tmp_path / "good.mod"
    path.write_text(GOOD)
    return path


@pytest.fixture
def bad(tmp_path: Path) -> Path:
    path = tmp_path / "bad.mod"
    path.write_text(BAD)
    return path


def test_check_of_a_correct_module(good: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "check", str(good)]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == "1 file, 0 errors, 0 warnings\n"


def test_check_prints_every_error_with_its_place(bad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "check", str(bad)]) == 2
    assert capsys.readouterr().out.splitlines() == [
        f"{bad}:3:9: semantic error: string is expected here, not a number",
        f"{bad}:3:10: syntax error: ';' is missing before 'x'",
        f"{bad}:4:1: semantic error: 'x' is not declared",
    ]


def test_check_as_json(good: Path, bad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "check", str(bad), "--json"]) == 2
    (report,) = json.loads(capsys.readouterr().out)
    assert report["file"] == str(bad)
    assert report["errors"][1] == {"line": 3, "column": 10, "kind": "syntax", "message": "';' is missing before 'x'"}
    assert main(["rapid", "check", str(good), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == [{"file": str(good), "errors": [], "warnings": []}]


def test_check_of_a_file_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "check", str(tmp_path / "gone.mod")]) == 2
    assert capsys.readouterr().err.endswith("gone.mod: No such file or directory\n")


def test_signals_from_a_configuration(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "m.mod"
    path.write_text(GOOD.replace('TPWrite "hello"', "IF diPart = 1 Stop"))
    (tmp_path / "EIO.cfg").write_text('EIO_SIGNAL:\n  -Name "diPart" -SignalType "DI"\n')
    assert main(["rapid", "check", str(path)]) == 2
    assert main(["rapid", "check", str(path), "--io", str(tmp_path / "EIO.cfg")]) == 0


def test_format_writes_in_the_encoding_of_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "m.mod"
    path.write_bytes("module m\n! H\u00f6he\nendmodule\n".encode("cp1252"))
    assert main(["rapid", "format", str(path), "--check"]) == 1
    assert main(["rapid", "format", str(path), "--diff"]) == 0
    printed = capsys.readouterr().out
    assert f"would format {path}\n" in printed
    assert "+  ! H\u00f6he" in printed
    assert path.read_bytes().startswith(b"module")
    assert main(["rapid", "format", str(path)]) == 0
    assert path.read_bytes() == "MODULE m\n  ! H\u00f6he\nENDMODULE\n".encode("cp1252")
    assert [file.name for file in tmp_path.iterdir()] == ["m.mod"]
    assert main(["rapid", "format", str(path), "--check"]) == 0


def test_format_leaves_a_file_with_errors(bad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "format", str(bad)]) == 2
    assert "syntax error: ';' is missing" in capsys.readouterr().err
    assert bad.read_text() == BAD


POINT = "[[100,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
RUNS = f"""MODULE runs
PERS num count:=1;
CONST robtarget p := {POINT};
PROC main()
MoveL p, v100, fine, tool0;
count := count + 1;
IF diGo = 1 TPWrite "go" \\Num:=count;
WaitDI diGo, 1;
ENDPROC
PROC endless()
WHILE TRUE DO
count := count + 1;
ENDWHILE
ENDPROC
PROC fails()
count := 1 / (count - count);
ENDPROC
ENDMODULE
"""


@pytest.fixture
def runs(tmp_path: Path) -> Path:
    path = tmp_path / "runs.mod"
    path.write_text(RUNS)
    return path


def test_run_prints_what_the_program_writes(runs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "run", str(runs), "--fast", "--signal", "diGo=1"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "go2\n"
    assert captured.err == "main ended after 1.000 s, 1 movement\n"
    assert runs.read_text() == RUNS


def test_run_saves_persistents_where_asked(runs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "run", str(runs), "--fast", "--signal", "diGo=1", "--save"]) == 0
    assert capsys.readouterr().err.endswith(f"saved {runs}\n")
    assert runs.read_text() == RUNS.replace("count:=1;", "count:=2;", 1)


def test_run_names_errors_with_file_and_line(runs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "run", str(runs), "--fast", "--proc", "fails"]) == 2
    assert capsys.readouterr().err == f"error: {runs}:16: ERR_DIVZERO: division by zero\n"
    assert main(["rapid", "run", str(runs), "--fast"]) == 2
    assert capsys.readouterr().err.startswith(f"error: {runs}:8: waits for diGo = 1 for ever")
    assert main(["rapid", "run", str(runs), "--fast", "--proc", "mian"]) == 2
    assert "there is no procedure 'mian'; did you mean 'main'?" in capsys.readouterr().err


def test_run_refuses_a_program_with_errors(bad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rapid", "run", str(bad)]) == 2
    assert "semantic error: 'x' is not declared" in capsys.readouterr().err


def test_run_needs_to_know_which_task(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for number in (1, 2):
        folder = tmp_path / f"TASK{number}"
        folder.mkdir()
        (folder / "m.mod").write_text(GOOD.replace("hello", f"task {number}"))
    assert main(["rapid", "run", str(tmp_path), "--fast"]) == 2
    assert "choose with --task: TASK1, TASK2" in capsys.readouterr().err
    assert main(["rapid", "run", str(tmp_path), "--fast", "--task", "T_ROB2"]) == 0
    assert capsys.readouterr().out == "task 2\n"


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's")
def test_an_endless_loop_is_named_and_ends_with_ctrl_c(runs: Path) -> None:
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "rapid", "run", str(runs), "--fast", "--proc", "endless"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        line = process.stderr.readline()
        assert line.startswith(
            (f"{runs}:11: warning: the program runs for", f"{runs}:12: warning: the program runs for")
        )
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 130
        assert ": interrupted" in process.stderr.read()


def backup(folder: Path, tasks: dict[str, str]) -> Path:
    """Write a backup of a controller with tasks of these names and lines."""
    (folder / "BACKINFO").mkdir()
    names = []
    for number, (name, lines) in enumerate(tasks.items(), 1):
        home = folder / "RAPID" / f"TASK{number}" / "PROGMOD"
        home.mkdir(parents=True)
        data = 'PERS tasks both{2} := [["T_ROB_R"],["T_ROB_L"]];\nVAR syncident met;\nPERS num n := 0;'
        (home / f"m{number}.mod").write_text(f"MODULE m{number}\n{data}\nPROC main()\n{lines}\nENDPROC\nENDMODULE\n")
        names.append(f">>TASK{number}: ({name},,)")
    (folder / "BACKINFO" / "backinfo.txt").write_text("\n".join(names))
    return folder


def test_tasks_of_a_backup_run_together(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = {"T_ROB_R": "WaitTime 2; n := 7; WaitSyncTask met, both;", "T_ROB_L": "WaitSyncTask met, both;"}
    command = ["rapid", "run", str(backup(tmp_path, lines)), "--fast", "--save", "--task", "T_ROB_L"]
    assert main([*command, "--task", "t_rob_r"]) == 0
    assert capsys.readouterr().err.splitlines()[:2] == [
        "T_ROB_L main ended after 2.000 s, 0 movements",
        "T_ROB_R main ended after 2.000 s, 0 movements",
    ]
    assert all("PERS num n := 7;" in file.read_text() for file in tmp_path.rglob("*.mod"))
    assert main(["rapid", "run", str(tmp_path)]) == 2
    assert "choose with --task: T_ROB_R, T_ROB_L" in capsys.readouterr().err
    assert main([*command, "--task", "T_ROB_X"]) == 2
    assert "there is no task 'T_ROB_X'; did you mean 'T_ROB_L' or 'T_ROB_R'?" in capsys.readouterr().err


@pytest.mark.slow
def test_ctrl_c_ends_all_tasks(tmp_path: Path) -> None:
    lines = {"T_ROB_R": 'TPWrite "runs"; WHILE TRUE DO n := n + 1; ENDWHILE', "T_ROB_L": "WaitTime 100;"}
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "rapid", "run", str(backup(tmp_path, lines))]
    process = subprocess.Popen(
        [*command, "--task", "T_ROB_R", "--task", "T_ROB_L"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "runs\n"
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "m1.mod:6: interrupted" in err
