"""The semantic check: what a controller finds when it links a program."""

import pytest

from daidalos.industry.rapid import predefined
from daidalos.industry.rapid.checking import check
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source

from .programs import EVERYTHING, messages, module, problems

DATA = """VAR num n; VAR dnum d; VAR string s; VAR bool b; VAR pos p; VAR robtarget t; CONST num c := 1; VAR num a{3};
PERS tooldata tool := [TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];"""


def test_a_program_with_everything_has_no_problems() -> None:
    assert problems(EVERYTHING) == []


@pytest.mark.parametrize(
    "line",
    [
        "n := 1; d := 1; d := 4294967295; n := n + 1 * 2;",
        's := "a" + NumToStr(n, 2); b := s = "x" AND n > 3;',
        "p := p + p * 2; p := 2 * p * [1,2,3];",
        "t := [p,[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; t.trans.x := 3;",
        "a{2} := a{n} + 1; n := Dim(a, 1); b := a = [1,2,3];",
        "n := Round(1.5 \\Dec:=1); d := Abs(d); n := Max(n, 1);",
        "MoveL Offs(t, 1, 2, 3), v1000, z50, tool \\WObj:=wobj0;",
        "MoveJ t, [100,500,5000,1000], fine, tool0; MoveL t, vmax \\V:=250, z10 \\Z:=5, tool0;",
        "SetDO do1, 1; IF do1 = 1 WaitDI di7, high \\MaxTime:=3;",
        'IF NOT n = 3 TPWrite "x" \\Num:=n; reg1 := 1;',
        "FOR i FROM 1 TO 3 DO FOR j FROM i TO 1 STEP -1 DO n := i * j; ENDFOR ENDFOR",
        'TEST s CASE "a", "b": n := 1; DEFAULT: n := 2; ENDTEST',
    ],
)
def test_correct_lines(line: str) -> None:
    assert messages(line, DATA) == []


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('n := "one";', "num is expected here, not string"),
        ("n := d;", "num is expected here, not dnum"),
        ("b := n + d > 1;", "'+' does not take num and dnum"),
        ('s := "a" + 1;', "'+' does not take string and a number"),
        ("p := -[1,2,3];", "'-' does not take a list in brackets"),
        ("p := [1,2,3] + [1,2,3];", "'+' does not take two lists in brackets, whose type is not known"),
        ("IF n THEN ENDIF", "bool is expected here, not num"),
        ("b := NOT n;", "NOT needs bool, not num"),
        ("n := nn;", "'nn' is not declared"),
        ("tool0.tframe.trans.w := 1;", "pos has no component 'w'; it has: x, y, z"),
        ("n := t.trans;", "num is expected here, not pos"),
        ("n := n.x;", "num has no components"),
        ("n := a{1,2};", "2 indices for an array of 1 dimensions"),
        ("n := n{1};", "1 indices for num, which is no array"),
        ("c := 2;", "'c' is a constant and cannot be assigned to"),
        ("FOR i FROM 1 TO 2 DO i := 3; ENDFOR", "'i' is the counter of a loop and cannot be assigned to"),
        ("p := [1,2];", "2 values for a pos, which has 3: x, y, z"),
        ("p := [1,\"2\",3];", 'a num is expected where "2" stands (component y of pos)'),
        ("a := [1,2];", None),
        ("TPWrit \"x\";", "procedure 'TPWrit' is not declared; did you mean 'TPWrite' or 'Write'?"),
        ("n := Sinus(1);", "function 'Sinus' is not declared; did you mean 'Sin'?"),
        ("MoveL t, v1000, z50;", "MoveL: 'Tool' (tooldata) is missing"),
        ("MoveL t, v1000, z50, tool0, 5;", "MoveL: one argument too many; 4 are expected"),
        ("MoveL t, z50, v1000, tool0;", "speeddata is expected here, not zonedata"),
        ("MoveL t, v1000 \\Q:=1, z50, tool0;", "MoveL: there is no optional argument 'Q'"),
        ("MoveL t, v1000, z50, tool0 \\Conc;", "MoveL: 'Conc' stands too late; it belongs before what is"),
        ("MoveL t, v1000 \\V:=1 \\T:=2, z50, tool0;", "MoveL: 'T' and 'V' exclude each other"),
        ("TPWrite \"a\" \\Num;", "TPWrite: 'Num' needs a value: \\Num:=..."),
        ("ConfL \\On:=TRUE;", "ConfL: 'On' is a switch and has no value"),
        ("Incr c;", "Incr: 'Name' needs a variable or a persistent; 'c' is a constant"),
        ("Incr 5;", "Incr: 'Name' needs a variable or a persistent, not a value"),
        ("VAR tooldata own; MoveL t, v10, fine, own;", "MoveL: 'Tool' needs a persistent; 'own' is a variable"),
        ("Sin 5;", "'Sin' is a function; its result has to be used"),
        ("n := Stop();", "'Stop' is a procedure and has no value"),
        ("n := Sin;", "'Sin' is a function; its call needs ()"),
        ("GOTO there;", "there is no label 'there' here or around this block"),
        ("RETRY;", "RETRY stands in error handlers only"),
        ("RAISE;", "RAISE needs an error number outside of an error handler"),
        ("RETURN 1;", "RETURN of a procedure has no value"),
        ("VAR num n2; VAR num N2;", "'N2' is declared twice; the first is in line 5"),
        ("n := 1; VAR num late;", "data of a routine are declared before its first instruction"),
        ("PERS num kept := 1;", "data of a routine cannot be PERS; declare it in the module"),
        ("<SMT>", "<SMT> is still to be replaced by an instruction"),
        ("s := \"" + "x" * 81 + "\";", "a string has at most 80 characters"),
        ("CONNECT n WITH main;", "'main' is no trap"),
        ("TEST n CASE \"a\": ENDTEST", "num is expected here, not string"),
        ("VAR thing x;", "there is no data type 'thing'"),
    ],
)  # fmt: skip
def test_a_wrong_line(line: str, message: str | None) -> None:
    found = messages(line, DATA)
    if message is None:
        return
    assert any(text.startswith(message) for text in found), found


@pytest.mark.parametrize(
    ("declaration", "message"),
    [
        ("VAR num v; VAR num V;", "'V' is declared twice; the first is in line 2"),
        ("LOCAL VAR num v; VAR num v;", "'v' is declared twice; the first is in line 2"),
        ("VAR speeddat v;", "there is no data type 'speeddat'; did you mean 'speeddata' or 'capspeeddata'?"),
        ("CONST num v;", "the constant 'v' has no value"),
        ("VAR clock v := 1;", "data of type clock cannot have a value"),
        ("VAR num v{2} := [1,2,3];", "3 elements for an array of 2"),
        ("VAR num v{2,2} := [[1,2],[3]];", "1 elements for an array of 2"),
        ("VAR num v{0};", "an array has 1 element or more, not 0"),
        ("VAR num v{1.5};", "an array has 1 element or more, not 1.5"),
        ("VAR num v{1000,1000,1000};", "an array has at most 1000000 elements"),
        (f"VAR num v{{{'9' * 5000}}};", "an array has at most 1000000 elements"),
        (f"VAR num v := 0x{'F' * 5000};", "this number is too large"),
        ("VAR num v := 1E999;", "this number is too large"),
        ("RECORD r num x; num X; ENDRECORD", "the record has a component 'X' already"),
        ("FUNC num f() ENDFUNC", "the function 'f' has no RETURN"),
        ('FUNC num f() RETURN "a"; ENDFUNC', "num is expected here, not string"),
        ("FUNC num f() RETURN; ENDFUNC", "RETURN of a function needs a value of type num"),
        ("PROC p() RETURN; Stop; ENDPROC", "this is never reached, after line 2"),
        ("PROC p(num x, num X) ENDPROC", "'X' is declared twice; the first is in line 2"),
        ("PROC p(switch x) ENDPROC", "the switch 'x' has to be optional: \\switch"),
        (f"VAR num {'v' * 33};", f"a name has at most 32 characters; '{'v' * 33}' has 33"),
    ],
)
def test_a_wrong_declaration(declaration: str, message: str) -> None:
    assert message in messages("", declaration)


def test_places_of_semantic_errors() -> None:
    (one,) = problems(module("TPWrite 5;"))
    assert (one.line, one.column, one.kind, one.message) == (4, 9, "semantic", "string is expected here, not a number")


def test_the_end_of_a_function_is_followed() -> None:
    safe = "FUNC num f(num x) IF x > 0 THEN RETURN 1; ELSE RETURN 2; ENDIF ENDFUNC"
    assert problems(module("", safe)) == []
    open_end = "FUNC num f(num x) IF x > 0 RETURN 1; ENDFUNC"
    (one,) = problems(module("", open_end))
    assert one.is_warning
    assert one.message == "the function 'f' can end without RETURN"


def test_a_signal_needs_no_declaration_where_a_signal_is_expected() -> None:
    assert messages("SetDO doGrip, 1;") == []
    assert messages("IF diPart = 1 Stop;") == ["'diPart' is not declared"]
    assert messages("IF diPart = 1 Stop; WaitDI diPart, 1;") == []
    text = module("IF diPart = 1 Stop;")
    assert check([parse(Source("a.mod", text))], ["DIPART"])["a.mod"] == []


def test_a_name_in_a_call_with_unknown_parameters_is_still_looked_for_elsewhere() -> None:
    lines = "ContactL p0, v100, sm1, wd1, fine, tGun; MoveL p0, v100, fine, tGun;"
    declarations = "PERS robtarget p0 := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    assert messages(lines, declarations) == ["'tGun' is not declared"]


def test_modules_of_a_task_see_each_other_but_for_local_names() -> None:
    one = parse(Source("a.mod", "MODULE a\nVAR num x;\nLOCAL VAR num y;\nPROC p() ENDPROC\nENDMODULE"))
    other = parse(Source("b.mod", "MODULE b\nVAR num x;\nPROC main()\np; x := 1; y := 2;\nENDPROC\nENDMODULE"))
    found = check([one, other])
    assert found["a.mod"] == []
    assert [problem.message for problem in found["b.mod"]] == [
        "'x' is declared twice; the first is in a.mod:2",
        "'y' is not declared",
    ]


SEED = """MoveC p10, p20, v1000,
fine, tool0; MoveJ
p10, v1000, fine,
tool0; MoveAbsJ j10,
v50, tool0;
"""


def test_a_listing_that_a_page_has_broken_is_accepted_with_warnings() -> None:
    found = problems(SEED)
    assert all(problem.is_warning for problem in found)
    assert [(problem.line, problem.column) for problem in found] == [(1, 1), (4, 8)]
    assert found[0].message == "MoveC goes on in line 2, where 'MoveJ' begins too; one instruction a line"
    assert found[1].message == "MoveAbsJ has no zone; 'fine' is taken, so write: ..., fine, tool"


def test_every_predefined_declaration_can_be_read() -> None:
    names = predefined.names()
    assert len(names) > 1400
    for name in names:
        assert predefined.find(name.lower()) is not None, name


def test_speeds_and_zones_have_the_values_of_the_manual() -> None:
    values = {name: getattr(predefined.find(name), "value", "") for name in ("v1000", "z10", "z50", "z1", "fine")}
    assert values == {
        "v1000": "[1000,500,5000,1000]",
        "z10": "[FALSE,10,15,15,1.5,15,1.5]",
        "z50": "[FALSE,50,75,75,7.5,75,7.5]",
        "z1": "[FALSE,1,1,1,0.1,1,0.1]",
        "fine": "[TRUE,0,0,0,0,0,0]",
    }
