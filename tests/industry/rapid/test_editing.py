"""What editors ask: definitions, uses, hover, completions and renaming."""

from pathlib import Path

import pytest

from daidalos.common.errors import UserError
from daidalos.industry.rapid.editing.completion import complete
from daidalos.industry.rapid.editing.workspace import Program, Workspace

MAIN = r"""MODULE Main
  RECORD part
    num count;
    pos place;
  ENDRECORD
  ! number of parts
  VAR num total := 0;
  VAR part parts{3};

  PROC main()
    VAR num total2;
    FOR i FROM 1 TO 3 DO
      parts{i}.count := i + total;
      show parts{i}, i \loud:=TRUE;
    ENDFOR
    GOTO done;
    done:
    TPWrite "" \Num:=Sin(total);
    MoveL p, v100, fine, tool0;
  ENDPROC

  PROC show(part one, num n \bool loud)
    total := total + one.count + n;
  ENDPROC
ENDMODULE
"""
OTHER = "MODULE Other\n  CONST robtarget p := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n"


@pytest.fixture
def program(tmp_path: Path) -> Program:
    (tmp_path / "Main.mod").write_text(MAIN)
    (tmp_path / "Other.mod").write_text(OTHER)
    workspace = Workspace()
    workspace.update(str(tmp_path / "Main.mod"), MAIN)
    return workspace.program(str(tmp_path / "Main.mod"))


def main_of(program: Program) -> str:
    return next(file for file in program.modules if file.endswith("Main.mod"))


def offset(text: str, shift: int = 0) -> int:
    return MAIN.index(text) + shift


@pytest.mark.parametrize(
    ("use", "shift", "declaration"),
    [
        ("i + total;", 4, "total := 0"),
        ("i + total;", 0, "i FROM"),
        ("show parts", 0, "show(part"),
        ("parts{i}.count", 1, "parts{3}"),
        ("parts{i}.count", 10, "count;"),
        ("\\loud:=TRUE", 2, "loud)"),
        ("one.count + n", 0, "one, num"),
        ("one.count + n", 5, "count;"),
        ("GOTO done", 6, "done:"),
        ("part parts", 0, "part\n"),
    ],
)
def test_definitions(program: Program, use: str, shift: int, declaration: str) -> None:
    target = program.definition(main_of(program), offset(use, shift))
    assert target is not None
    assert MAIN[target.start :].startswith(declaration)


def test_a_definition_in_another_module(program: Program) -> None:
    target = program.definition(main_of(program), offset("MoveL p,", 6))
    assert target is not None
    assert target.file.endswith("Other.mod")


def test_predefined_names_have_no_definition_but_are_explained(program: Program) -> None:
    file = main_of(program)
    assert program.definition(file, offset("MoveL p")) is None
    assert str(program.hover(file, offset("MoveL p"))).startswith("PROC MoveL(\\switch Conc, robtarget ToPoint")
    assert program.hover(file, offset("v100")) == "CONST speeddata v100 := [100,500,5000,1000]"
    assert program.hover(file, offset("total := 0")) == "! number of parts\nVAR num total := 0;"
    assert program.hover(file, offset("GOTO")) is None


def test_uses(program: Program) -> None:
    target = program.definition(main_of(program), offset("total := 0"))
    assert target is not None
    starts = sorted(start for _, start, _ in program.uses(target))
    assert [MAIN[: start + 5].count("\n") + 1 for start in starts] == [7, 13, 18, 23, 23]


def test_completions(program: Program) -> None:
    file = main_of(program)

    def texts(where: int) -> list[str]:
        return [one.text for one in complete(program, file, where)]

    inside = texts(offset("i + total;"))
    assert {"i", "total", "total2", "parts", "show", "p", "MoveL", "v1000", "WHILE", "robtarget"} <= set(inside)
    assert "loud" not in inside
    assert "i" not in texts(offset("GOTO done"))
    assert texts(offset("parts{i}.count", 9)) == ["count", "place"]
    assert texts(offset("one.count", 4)) == ["count", "place"]
    assert texts(offset("\\loud", 1)) == ["loud"]
    assert texts(offset("\\Num:=", 1)) == ["Bool", "Dnum", "Num", "Orient", "Pos"]


@pytest.mark.parametrize(
    ("where", "shift", "name", "count"),
    [("total := 0", 0, "sum", 5), ("loud)", 0, "noisy", 2), ("count;", 0, "amount", 3), ("done:", 0, "end_", 2)],
)
def test_renaming_changes_every_use_and_nothing_else(
    program: Program, where: str, shift: int, name: str, count: int
) -> None:
    file = main_of(program)
    (places,) = program.rename(file, offset(where, shift), name).values()
    assert len(places) == count
    text = MAIN
    for start, end in reversed(places):
        text = text[:start] + name + text[end:]
    workspace = Workspace()
    workspace.update(file, text)
    assert [one for problems in workspace.program(file).problems().values() for one in problems] == []


@pytest.mark.parametrize(
    ("where", "name", "message"),
    [
        ("total := 0", "parts", r"'parts' is declared in Main\.mod:8 already"),
        ("total := 0", "total2", r"'total2' is declared in Main\.mod:11 already"),
        ("total := 0", "while", "'while' is a keyword"),
        ("total := 0", "2x", "'2x' is no name"),
        ("MoveL", "Move", "'MoveL' is predefined"),
        ("GOTO", "x", "there is no name here"),
    ],
)
def test_names_that_cannot_be_given(program: Program, where: str, name: str, message: str) -> None:
    with pytest.raises(UserError, match=message):
        program.rename(main_of(program), offset(where), name)


def test_a_module_with_errors_still_has_its_names(tmp_path: Path) -> None:
    workspace = Workspace()
    file = str(tmp_path / "m.mod")
    workspace.update(file, MAIN.replace("i + total;", "i + total"))
    program = workspace.program(file)
    assert program.definition(file, offset("total := 0")) is not None
    assert "show" in [one.text for one in complete(program, file, offset("GOTO"))]
