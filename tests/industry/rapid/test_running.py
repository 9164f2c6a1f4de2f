"""The runtime: statements, calls, recovery from errors, interrupts and movements."""

import math
import socket
import threading
from pathlib import Path

import pytest

from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.errors import FatalError
from daidalos.industry.rapid.runtime.persistence import save_persistents
from daidalos.industry.rapid.runtime.robot import SimpleRobot
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.sources import read_source

from .programs import module
from .running import board, load, run, written

POINT = "[[{},{},{}],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


@pytest.mark.parametrize(
    ("lines", "output"),
    [
        ('FOR i FROM 1 TO 3 DO TPWrite ""\\Num:=i; ENDFOR', ["1", "2", "3"]),
        ('FOR i FROM 3 TO 1 DO TPWrite ""\\Num:=i; ENDFOR', ["3", "2", "1"]),
        ('FOR i FROM 1 TO 2 STEP 0.5 DO TPWrite ""\\Num:=i; ENDFOR', ["1", "1.5", "2"]),
        ('FOR i FROM 1 TO 0 STEP 1 DO TPWrite "x"; ENDFOR', []),
        ('VAR num i; WHILE i < 2 DO Incr i; ENDWHILE TPWrite ""\\Num:=i;', ["2"]),
        ('VAR num i := 2; TEST i CASE 1: TPWrite "1"; CASE 2,3: TPWrite "2"; DEFAULT: TPWrite "d"; ENDTEST', ["2"]),
        ('VAR num i := 9; TEST i CASE 1: TPWrite "1"; DEFAULT: TPWrite "d"; ENDTEST', ["d"]),
        ('IF 1 > 2 THEN TPWrite "a"; ELSEIF 2 > 1 THEN TPWrite "b"; ELSE TPWrite "c"; ENDIF', ["b"]),
        ('IF 2 > 1 TPWrite "yes"; IF 1 > 2 TPWrite "no";', ["yes"]),
        ('VAR num i; again: Incr i; IF i < 3 GOTO again; TPWrite ""\\Num:=i;', ["3"]),
        (
            'FOR i FROM 1 TO 9 DO FOR j FROM 1 TO 9 DO IF i * j = 12 GOTO out; ENDFOR ENDFOR out: TPWrite "out";',
            ["out"],
        ),
        ('TPWrite "a"; EXIT; TPWrite "b";', None),
        ('TPWrite ""\\Bool:=7 DIV 2 = 3 AND 7 MOD 4 = 3 AND -7 DIV 2 = -3 AND -7 MOD 4 = -3;', ["TRUE"]),
        ('TPWrite ""\\Bool:=TRUE XOR FALSE; TPWrite ""\\Bool:=NOT 1 = 2 AND FALSE;', ["TRUE", "FALSE"]),
        ('VAR pos p := [1,2,3]; p := -p / 2; TPWrite ""\\Pos:=p;', ["[-0.5,-1,-1.5]"]),
        ('VAR num a{2,3}; a{2,3} := 5; TPWrite ValToStr(a); TPWrite ""\\Num:=Dim(a, 2);', ["[[0,0,0],[0,0,5]]", "3"]),
    ],
)
def test_statements(lines: str, output: list[str] | None) -> None:
    outcome, found = run(lines)
    if output is not None:
        assert outcome.reason == "end", outcome.message
        assert found == output


def test_records_and_arrays_are_values() -> None:
    lines = """VAR pose a := [[1,2,3],[1,0,0,0]]; VAR pose b; VAR pos c{2};
    b := a; b.trans.x := 9; c{1} := a.trans; c{1}.y := 8; c{2} := c{1}; c{2}.z := 7;
    TPWrite ValToStr(a.trans); TPWrite ValToStr(b.trans); TPWrite ValToStr(c); changed a; TPWrite ValToStr(a.trans);"""
    declarations = "PROC changed(pose p)\np.trans.x := 100;\nENDPROC"
    assert written(lines, declarations) == ["[1,2,3]", "[9,2,3]", "[[1,8,3],[1,8,7]]", "[1,2,3]"]


def test_constants_of_aggregates_are_not_changed_by_data_made_of_them() -> None:
    declarations = "PROC once()\nVAR pos p := [1,2,3];\np.x := p.x + 1;\nTPWrite ValToStr(p);\nENDPROC"
    assert written("once; once;", declarations) == ["[2,2,3]", "[2,2,3]"]


def test_parameters_by_reference() -> None:
    lines = """VAR num n := 1; VAR num a{2} := [1,2]; VAR pos p := [1,2,3]; VAR string s;
    more n; more a{2}; more p.y; more kept; whole p; text s; all a; nested n;
    TPWrite "" \\Num:=n; TPWrite ValToStr(a); TPWrite ValToStr(p); TPWrite "" \\Num:=kept; TPWrite s;"""
    declarations = """PERS num kept := 5;
    PROC more(INOUT num x) x := x + 10; ENDPROC
    PROC whole(VAR pos x) x := [x.x, x.y, 30]; ENDPROC
    PROC text(INOUT string x) x := x + "text"; ENDPROC
    PROC all(INOUT num x{*}) x{1} := 100; ENDPROC
    PROC nested(INOUT num x) more x; ENDPROC"""
    assert written(lines, declarations) == ["21", "[100,12]", "[1,12,30]", "15", "text"]


def test_optional_and_conditional_arguments() -> None:
    declarations = """PROC show(string text \\num more | switch Loud \\num last)
      IF Present(more) text := text + " more" + NumToStr(more, 0);
      IF Present(Loud) text := text + "!";
      IF Present(last) text := text + " last";
      TPWrite text;
    ENDPROC
    PROC through(\\num more \\switch Loud) show "through" \\more?more \\Loud?Loud; ENDPROC"""
    lines = 'show "a"; show "b" \\more:=1; show "c" \\Loud \\last:=1; through; through \\more:=2; through \\Loud;'
    assert written(lines, declarations) == ["a", "b more1", "c! last", "through", "through more2", "through!"]


def test_late_binding() -> None:
    declarations = (
        'PROC job1(num n \\num more) TPWrite "job"\\Num:=n; ENDPROC\nPROC add(INOUT num n) n := n + 1; ENDPROC'
    )
    lines = 'VAR num n := 5; %"job" + NumToStr(1, 0)% n; %"add"% n; %"JOB1"% n \\more:=1;'
    assert written(lines, declarations) == ["job5", "job6"]
    outcome, _ = run('%"job2"%;', declarations)
    assert outcome.message == "test.mod:5: ERR_REFUNKPRC: there is no procedure 'job2'"


def test_recursion() -> None:
    declarations = "FUNC num fact(num n) IF n < 2 RETURN 1; RETURN n * fact(n - 1); ENDFUNC"
    assert written('TPWrite "" \\Num:=fact(10);', declarations) == ["3.6288E+06"]
    outcome, _ = run("endless;", "PROC endless() endless; ENDPROC")
    assert "calls itself too often" in outcome.message


# Recovery


def test_retry_tries_a_statement_again() -> None:
    lines = 'VAR num d; TPWrite "" \\Num:=6 / d; ERROR IF ERRNO = ERR_DIVZERO THEN d := 2; RETRY; ENDIF'
    assert written(lines) == ["3"]


def test_trynext_goes_on_behind_a_statement() -> None:
    lines = (
        'VAR num d; d := 1 / 0; TPWrite "next" \\Num:=d; IF 1 / d > 0 TPWrite "not this"; TPWrite "end"; ERROR TRYNEXT;'
    )
    assert written(lines) == ["next0", "end"]


def test_trynext_goes_on_behind_the_whole_block_whose_condition_failed() -> None:
    lines = """VAR num d;
    FOR k FROM 1 TO 4 DO
      IF k = 1 THEN TPWrite "one"; ELSEIF 1 / (k - 2) > 0.9 THEN TPWrite "three"; ELSE TPWrite "four"; ENDIF
    ENDFOR
    WHILE 1 / d > 0 DO TPWrite "no"; ENDWHILE
    TEST 1 / d CASE 1: TPWrite "no"; DEFAULT: TPWrite "no"; ENDTEST
    TEST d CASE 1: TPWrite "no"; DEFAULT: TPWrite "default"; ENDTEST
    ERROR TRYNEXT;"""
    assert written(lines) == ["one", "three", "four", "default"]


def test_return_from_an_error_handler() -> None:
    declarations = "FUNC num safe(num a, num b) RETURN a / b; ERROR RETURN -1; ENDFUNC"
    assert written('TPWrite "" \\Num:=safe(1, 0); TPWrite "" \\Num:=safe(1, 2);', declarations) == ["-1", "0.5"]


def test_raise_hands_an_error_to_the_caller() -> None:
    declarations = """PROC inner() RAISE 17; ERROR TPWrite "inner" \\Num:=ERRNO; RAISE; ENDPROC"""
    lines = 'inner; TPWrite "on"; ERROR TPWrite "outer" \\Num:=ERRNO; TRYNEXT;'
    assert written(lines, declarations) == ["inner17", "outer17", "on"]


def test_an_error_without_a_handler_stops_whatever_the_caller_has() -> None:
    declarations = "PROC inner() reg1 := 1 / 0; ENDPROC"
    outcome, _ = run("inner; ERROR TRYNEXT;", declarations)
    assert outcome.reason == "error"
    assert outcome.message == "test.mod:2: ERR_DIVZERO: division by zero"
    assert outcome.calls == ["test.mod:2", "test.mod:4"]


def test_a_list_of_errors_catches_them_across_routines() -> None:
    declarations = "PROC inner() reg1 := 1 / 0; ENDPROC"
    assert written('inner; TPWrite "on"; ERROR (ERR_DIVZERO) TRYNEXT;', declarations) == ["on"]
    outcome, _ = run("inner; ERROR (ERR_OUTOFBND) TRYNEXT;", declarations)
    assert "ERR_DIVZERO" in outcome.message


def test_undo_handlers_run_where_a_routine_is_left_early() -> None:
    declarations = """PROC inner() reg1 := 1 / 0; TPWrite "not this"; UNDO TPWrite "undone"; ENDPROC
    PROC cycle() ExitCycle; UNDO TPWrite "cycle"; ENDPROC
    PROC whole() TPWrite "whole"; UNDO TPWrite "not this"; ENDPROC"""
    lines = 'whole; inner; TPWrite "on"; cycle; ERROR (ERR_DIVZERO) TRYNEXT;'
    outcome, found = run(lines, declarations)
    assert outcome.reason == "ExitCycle"
    assert found == ["whole", "undone", "on", "cycle"]


def test_retry_has_an_end() -> None:
    outcome, _ = run("reg1 := 1 / 0; ERROR RETRY;")
    assert outcome.message.endswith("ERR_EXCRTYMAX: RETRY more than 4 times after ERR_DIVZERO: division by zero")


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("reg1 := 1 / reg2;", "ERR_DIVZERO: division by zero"),
        ("reg1 := 1 MOD reg2;", "ERR_DIVZERO: division by zero"),
        ("VAR num a{2}; reg1 := a{reg2};", "ERR_OUTOFBND: 0 is no index of an array"),
        ("VAR num a{2}; reg1 := a{reg2 + 3};", "ERR_OUTOFBND: an array index is out of bounds"),
        ('TPWrite StrPart("abc", 3, 2);', "ERR_OUTOFBND: a string of 3 has no 2 from 3 on"),
        (
            'VAR string s := "1234567890"; FOR i FROM 1 TO 4 DO s := s + s; ENDFOR',
            "ERR_STRTOOLNG: a string of 160 characters",
        ),
        ("reg1 := Sqrt(-1);", "ERR_ARGVALERR: there is no square root of -1"),
        ("RAISE 5;", "5: error 5 was raised"),
        ("WaitDI di1, 1 \\MaxTime:=2;", "ERR_WAIT_MAXTIME: waited 2 s for di1 = 1"),
        ("WaitDI di1, 1;", "waits for di1 = 1 for ever: nothing else is left that could change it"),
        ('TPReadNum reg1, "n";', "ERR_TP_NO_CLIENT: nobody answers at the pendant"),
        ("PathLengthReset;", "'PathLengthReset' runs on a controller only"),
    ],
)
def test_errors_are_named_with_their_line(lines: str, message: str) -> None:
    declarations = f"CONST robtarget p0 := {POINT.format(0, 0, 0)}; VAR seamdata sm1; VAR welddata wd1;"
    outcome, _ = run(lines, declarations)
    assert outcome.reason == "error"
    assert outcome.message.startswith(f"test.mod:4: {message}")


def test_a_function_that_ends_without_return() -> None:
    outcome, _ = run("reg1 := f(0);", "FUNC num f(num x) IF x > 0 RETURN 1; ENDFUNC")
    assert outcome.message == "test.mod:2: the function 'f' has ended without RETURN"


# Time, signals and interrupts


def test_clocks_run_on_robot_time() -> None:
    lines = (
        "VAR clock c; ClkStart c; WaitTime 1.5; ClkStop c; WaitTime 1; ClkStart c; WaitTime 0.25; reg1 := ClkRead(c);"
    )
    task = load(module(lines + ' TPWrite ""\\Num:=reg1; TPWrite CTime();'))
    assert task.run().time == 2.75
    assert task.pendant.lines == ["1.75", "00:00:02"]  # type: ignore[attr-defined]


def test_waiting_for_signals() -> None:
    lines = """VAR bool late; WaitDI di1, 1; WaitUntil di1 = 1 \\MaxTime:=1;
    WaitDI di2, 1 \\MaxTime:=3 \\TimeFlag:=late;
    TPWrite "" \\Bool:=late; SetDO do1, 1; PulseDO \\PLength:=0.5, do2; TPWrite "" \\Num:=do2;
    WaitTime 1; TPWrite ""\\Num:=do2;"""
    outcome, lines_written = run(lines, board=board(di1=1))
    assert outcome.reason == "end", outcome.message
    assert lines_written == ["TRUE", "1", "0"]
    assert math.isclose(outcome.time, 4.0)


def test_timers_and_signals_run_traps() -> None:
    declarations = """VAR intnum tick; VAR intnum edge; VAR num ticks;
    TRAP onTick ticks := ticks + 1; IF ticks = 3 SetDO do1, 1; ENDTRAP
    TRAP onEdge TPWrite "edge" \\Num:=ticks; IDelete tick; ENDTRAP"""
    lines = """CONNECT tick WITH onTick; CONNECT edge WITH onEdge; ITimer 0.5, tick; ISignalDO do1, 1, edge;
    WaitTime 10; TPWrite "ticks" \\Num:=ticks;"""
    assert written(lines, declarations) == ["edge3", "ticks3"]


# Movements


def test_movements_are_handed_to_the_robot() -> None:
    declarations = f"""CONST robtarget p1 := {POINT.format(100, 0, 0)};
    CONST jointtarget j1 := [[90,0,0,0,0,0],[9E9,0,0,0,0,0]];
    PERS wobjdata w := [FALSE,TRUE,"",[[10,0,0],[1,0,0,0]],[[0,0,5],[1,0,0,0]]];
    PERS tooldata t := [TRUE,[[0,0,50],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];"""
    lines = """MoveJ p1, v100, fine, tool0; MoveL Offs(p1, 0, 50, 0), v100 \\T:=3, z10, t \\WObj:=w;
    MoveAbsJ j1, vmax, tool0;
    MoveC Offs(p1, 0, 50, 0), Offs(p1, 100, 0, 0), v50 \\V:=25, fine, tool0;"""
    task = load(module(lines, declarations))
    outcome = task.run()
    assert outcome.reason == "end", outcome.message
    robot = task.robot
    assert isinstance(robot, SimpleRobot)
    assert [one.instruction for one in robot.moves] == ["MoveJ", "MoveL", "MoveAbsJ", "MoveC"]
    assert [one.line for one in robot.moves] == ["test.mod:7", "test.mod:7", "test.mod:8", "test.mod:9"]
    assert robot.moves[1].tool_pose()[0] == [110.0, 50.0, 5.0]
    assert robot.moves[2].zone[0] is True
    assert robot.moves[3].speed[0] == 25.0
    # 100 mm at 100 mm/s, 3 s as ordered, 90 degrees at 500 deg/s; the arc is known from its three points.
    arc = _arc([110.0, 50.0, -45.0], [100.0, 50.0, 0.0], [200.0, 0.0, 0.0])
    assert math.isclose(outcome.time, 1.0 + 3.0 + 90 / 500 + arc / 25.0, rel_tol=1e-9)


def _arc(a: list[float], b: list[float], c: list[float]) -> float:
    """Return the length of an arc by its centre, from the perpendicular bisectors."""
    import numpy as np

    p, q, r = (np.array(one) for one in (a, b, c))
    u, v = q - p, r - p
    normal = np.cross(u, v)
    centre = p + np.cross(u @ u * v - v @ v * u, normal) / (2 * (normal @ normal))
    normal /= np.linalg.norm(normal)
    x = (p - centre) / np.linalg.norm(p - centre)
    angle = math.atan2((r - centre) @ np.cross(normal, x), (r - centre) @ x) % (2 * math.pi)
    return float(angle * np.linalg.norm(p - centre))


def test_where_the_robot_is() -> None:
    declarations = f"CONST robtarget p1 := {POINT.format(100, 20, 3)};"
    lines = """VAR robtarget here; MoveL p1, v100, fine, tool0; here := CRobT(); TPWrite ValToStr(here.trans);
    MoveL RelTool(p1, 0, 0, 10 \\Rz:=90), v100, fine, tool0; TPWrite ValToStr(CPos());"""
    assert written(lines, declarations) == ["[100,20,3]", "[100,20,13]"]


# Files, sockets and limits


def test_files_below_a_folder(tmp_path: Path) -> None:
    lines = """VAR iodev f; VAR dir d; VAR string s; MakeDir "HOME:/log"; Open "HOME:" \\File:="log/a.txt", f \\Write;
    Write f, "x = " \\Num:=1.5; Write f, "no end" \\NoNewLine; Close f; TPWrite "" \\Num:=FileSize("HOME:/log/a.txt");
    Open "HOME:/log/a.txt", f \\Read; TPWrite ReadStr(f); TPWrite ReadStr(f); TPWrite ReadStr(f); Close f;
    CopyFile "log/a.txt", "log/b.txt"; RemoveFile "log/a.txt"; TPWrite "" \\Bool:=IsFile("log/a.txt");
    OpenDir d, "HOME:/log"; WHILE ReadDir(d, s) DO TPWrite s; ENDWHILE CloseDir d;"""
    outcome, found = run(lines, home=tmp_path)
    assert outcome.reason == "end", outcome.message
    assert found == ["14", "x = 1.5", "no end", "EOF", "FALSE", ".", "..", "b.txt"]
    assert (tmp_path / "log" / "b.txt").read_text() == "x = 1.5\nno end"


@pytest.mark.parametrize("name", ["../out.txt", "HOME:/../out.txt", "HOME:\\\\..\\\\out.txt", "HOME:/a/../../out.txt"])
def test_files_elsewhere_are_out_of_reach(tmp_path: Path, name: str) -> None:
    outcome, _ = run(f'VAR iodev f; Open "{name}", f \\Write;', home=tmp_path / "home")
    assert "ERR_FILEACC" in outcome.message
    assert not (tmp_path / "out.txt").exists()


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    outcome, _ = run('VAR iodev f; Open "HOME:/no.txt", f \\Read;', home=tmp_path)
    assert outcome.message == "test.mod:4: ERR_FILNOTFND: there is no 'no.txt'"


def test_sockets_on_this_machine() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        answers = []

        def serve() -> None:
            client, _ = server.accept()
            with client:
                answers.append(client.recv(100))
                client.sendall(b"pong\x00\xff")

        thread = threading.Thread(target=serve)
        thread.start()
        lines = f"""VAR socketdev s; VAR rawbytes r; VAR num n; SocketCreate s; SocketConnect s, "127.0.0.1", {port};
        SocketSend s \\Str:="ping"; SocketReceive s \\RawData:=r \\ReadNoOfBytes:=6 \\NoRecBytes:=n \\Time:=5;
        TPWrite "" \\Num:=n; UnpackRawBytes r, 6, n \\Hex1; TPWrite "" \\Num:=n; SocketReceive s \\RawData:=r \\Time:=5;
        ERROR TPWrite "" \\Bool:=ERRNO = ERR_SOCK_CLOSED; SocketClose s; TRYNEXT;"""
        assert written(lines) == ["6", "255", "TRUE"]
        thread.join(10)
        assert answers == [b"ping"]
    outcome, _ = run('VAR socketdev s; SocketCreate s; SocketConnect s, "192.0.2.1", 80;')
    assert "ERR_SOCK_ADDR_INVALID" in outcome.message


def test_a_limit_of_robot_time() -> None:
    outcome, _ = run("WHILE TRUE DO WaitTime 1; ENDWHILE", limit=10.5)
    assert (outcome.reason, outcome.time) == ("its time limit", 10.5)


# Dialogs and persistents


def test_dialogs() -> None:
    lines = """TPReadNum reg1, "how many"; TPReadFK reg2, "which", "left", "", "right", stEmpty, stEmpty;
    reg3 := UIMessageBox(\\Header:="go on" \\Buttons:=btnYesNo); TPWrite UIAlphaEntry(\\Message:="name");
    TPWrite ValToStr([reg1, reg2, reg3]);"""
    assert written(lines, "", ["x", "4", "2", "right", "1", "Ada"]) == [
        "'x' is no number",
        "'2' is none of them: 1 to 5",
        "Ada",
        "[4,3,6]",
    ]


def test_persistents_are_written_back(tmp_path: Path) -> None:
    path = tmp_path / "kept.mod"
    text = "MODULE kept\nPERS num n:=1; ! counts\nPERS pos p := [ 1, 2,3 ];\nPERS num same := 1.50;\nVAR num v := 1;\n"
    text += "PROC main()\nn := n + 1/3; p.x := 7; same := 1.5; v := 5;\nENDPROC\nENDMODULE\n"
    path.write_bytes(text.replace("\n", "\r\n").encode())
    found = parse(read_source(path))
    checker = Checker([found])
    checker.check()
    task = Task([found], checker)
    task.run()
    assert save_persistents(task) == [path]
    expected = text.replace("n:=1;", "n:=1.33333333;").replace("[ 1, 2,3 ]", "[7,2,3]")
    assert path.read_bytes().decode() == expected.replace("\n", "\r\n")


def test_values_may_depend_on_others() -> None:
    declarations = "CONST num b := a * 2; CONST num a := 3; VAR num c{b}; CONST pos p := [a, b, 0];"
    assert written('TPWrite "" \\Num:=Dim(c, 1); TPWrite "" \\Pos:=p;', declarations) == ["6", "[3,6,0]"]
    with pytest.raises(FatalError, match=r"test\.mod:2: the value of 'x' depends on itself"):
        load(module("", "CONST num x := y; CONST num y := x;"))


def test_an_array_that_no_memory_holds() -> None:
    with pytest.raises(FatalError, match=r"test\.mod:2: the value of 'a': an array of 2000000 elements"):
        load(module("", "CONST num n := 2000000; VAR num a{n};"))


def test_a_local_procedure_can_be_run() -> None:
    assert load(module("", "LOCAL PROC own() EXIT; ENDPROC")).run("Own").reason == "EXIT"


def test_unknown_procedure() -> None:
    assert load(module("")).run("mian").message == "there is no procedure 'mian'; did you mean 'main'?"


def test_names_with_letters_that_python_takes_for_others() -> None:
    assert written('VAR num µ := 1; VAR num ª := 2; µ := µ + ª; TPWrite ""\\Num:=µ;') == ["3"]


def test_an_assignment_to_a_signal_is_refused_with_its_line() -> None:
    with pytest.raises(FatalError, match=r"test.mod:5: 'doA' is a signal; SetDO"):
        load(module("SetDO doA, 1;\ndoA := 0;"))
