"""Programs in RAPID that tests read, and what is made of lines that stand in none."""

from daidalos.industry.rapid.checking import check
from daidalos.industry.rapid.parsing import Parsed, parse
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import Source

EVERYTHING = r"""%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Everything(SYSMODULE, NOSTEPIN)
  ! every construct of the language
  RECORD part
    string label;
    robtarget place;
    num count;
  ENDRECORD
  LOCAL ALIAS num level;
  PERS tooldata pen := [TRUE,[[0,0,120],[1,0,0,0]],[0.5,[0,0,60],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata sheet := [FALSE,TRUE,"",[[400,0,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pHome := [[400,0,600],[0,0,1,0],[0,-1,0,1],[9E+09,9E9,9E9,9E9,9E9,9E9]];
  CONST num size{2,3} := [[1,2,3],[4,5,0x1F]];
  LOCAL VAR level height := -1.5E-3;
  VAR intnum alarm;
  VAR part parts{3};
  PERS tasks both{2} := [["T_ROB1"],["T_ROB2"]];

  PROC main()
    VAR num i;
    VAR string name := "say ""hello"" \\ \0A";
    CONNECT alarm WITH onAlarm;
    ISignalDI\Single, diStop, 1, alarm;
    again:
    FOR k FROM 1 TO Dim(parts, 1) STEP 2 DO
      parts{k}.place := Offs(pHome, 10 * k, -k, 0);
      parts{k}.count := k DIV 2 + k MOD 2;
    ENDFOR
    WHILE i < 3 AND NOT (i = 7 OR FALSE) DO
      Incr i;
      draw parts{1}.place \Fast, 5 \height:=2 \Loud:=FALSE;
    ENDWHILE
    TEST i
    CASE 1, 2:
      TPWrite "low" \Num:=i;
    CASE 3:
      %"draw"% pHome, 3;
    DEFAULT:
      GOTO again;
    ENDTEST
    IF area(2) >= 4 RETURN;
    IF i = 1 THEN
      Stop;
    ELSEIF i <> 2 THEN
      EXIT;
    ELSE
      RAISE ERR_WAIT_MAXTIME;
    ENDIF
  BACKWARD
    TPWrite "back";
  ERROR (ERR_WAIT_MAXTIME, 42)
    IF ERRNO = ERR_WAIT_MAXTIME THEN
      RETRY;
    ENDIF
    TRYNEXT;
  UNDO
    TPWrite "undone";
  ENDPROC

  PROC draw(robtarget at \switch Fast | switch Slow, num times \num height, \bool Loud)
    IF Present(height) MoveL Offs(at, 0, 0, height), v100, z10, pen \WObj:=sheet;
    IF times > 1 draw at, times - 1 \height?height \Loud?Loud;
    MoveJ at, v1000\V:=200, fine\Inpos:=inpos50, pen;
  ENDPROC

  LOCAL FUNC num area(num side)
    RETURN side * side;
  ENDFUNC

  PROC take(INOUT num a, VAR part b{*}, PERS tooldata c)
    a := b{1}.count;
  ENDPROC

  TRAP onAlarm
    TPWrite "stopped";
  ENDTRAP
ENDMODULE
"""


def parsed(text: str) -> Parsed:
    """Parse a text."""
    return parse(Source("test.mod", text))


def problems(text: str) -> list[Problem]:
    """Return all problems of a module."""
    return check([parsed(text)])["test.mod"]


def module(routine_lines: str = "", declarations: str = "") -> str:
    """Return a module with declarations, and lines in its procedure `main`."""
    return f"MODULE m\n{declarations}\nPROC main()\n{routine_lines}\nENDPROC\nENDMODULE\n"


def messages(routine_lines: str = "", declarations: str = "") -> list[str]:
    """Return what is wrong with a module, without the places."""
    return [problem.message for problem in problems(module(routine_lines, declarations)) if not problem.is_warning]
