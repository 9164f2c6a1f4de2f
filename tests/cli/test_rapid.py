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
    assert "choose one by --task: TASK1, TASK2" in capsys.readouterr().err
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
