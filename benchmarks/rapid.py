"""How many public programs in RAPID parse, how long that takes, and how fast programs run.

`DAIDALOS_PUBLIC_RAPID` names a folder with modules (.mod, .sys, .prg, .modx); without it the program of the tests is
used, many times over.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.sources import SUFFIXES, Source, read_source

LINES = 2000
REPEATS = 3
ROUNDS = 200_000
STATEMENTS = 5.5
"""Statements of a round of `LOOP`: FOR, two assignments, IF, and a call with its RETURN or an assignment."""

LOOP = """MODULE loop
VAR num total;
VAR num a{{100}};
PROC main()
  VAR num x;
  FOR i FROM 1 TO {rounds} DO
    x := i MOD 100 + 1;
    a{{x}} := a{{x}} + 1;
    IF x > 50 THEN
      total := total + double(x);
    ELSE
      total := total + 1;
    ENDIF
  ENDFOR
ERROR
  TRYNEXT;
ENDPROC
FUNC num double(num x)
  RETURN x * 2;
ENDFUNC
ENDMODULE
"""


def run() -> dict[str, float]:
    """Measure everything."""
    figures = {"rapid.check_command_s": command_seconds(), "rapid.statements_per_s": statements_per_second()}
    folder = os.environ.get("DAIDALOS_PUBLIC_RAPID", "")
    if not folder:
        print("DAIDALOS_PUBLIC_RAPID names no folder: no public programs", file=sys.stderr)
        figures["rapid.parse_2000_lines_ms"] = 1e3 * parse_seconds(Source("lines.mod", program(LINES)))
        return figures
    sources = [read_source(path) for path in sorted(Path(folder).rglob("*")) if path.suffix.lower() in SUFFIXES]
    times = [parse_seconds(source) for source in sources]
    parsed = sum(not parse(source).problems for source in sources)
    return figures | {
        "rapid.public_files": len(sources),
        "rapid.public_files_parsed_percent": 100.0 * parsed / len(sources),
        "rapid.public_files_parse_ms_mean": 1e3 * sum(times) / len(times),
        "rapid.public_files_parse_ms_worst": 1e3 * max(times),
    }


def parse_seconds(source: Source) -> float:
    """Return the least time that parsing a module takes."""
    best = float("inf")
    for _ in range(REPEATS):
        begin = time.perf_counter()
        parse(source)
        best = min(best, time.perf_counter() - begin)
    return best


def program(lines: int) -> str:
    """Return a module with that many movements."""
    target = "[[{},450,138.8],[-0.174713,0.907209,0.375778,0.072368],[0,-1,-1,0],[0,9E9,9E9,9E9,9E9,9E9]]"
    moves = "".join(f"  MoveL {target.format(i)}, v150, z20, tool0 \\WObj:=wobj0;\n" for i in range(lines))
    return f"MODULE lines\nPROC main()\n{moves}ENDPROC\nENDMODULE\n"


def statements_per_second() -> float:
    """Return how many statements a second a loop of assignments, branches and calls runs."""
    text = LOOP.format(rounds=ROUNDS)
    parsed = parse(Source("loop.mod", text))
    checker = Checker([parsed])
    checker.check()
    task = Task([parsed], checker)
    begin = time.perf_counter()
    outcome = task.run()
    seconds = time.perf_counter() - begin
    assert outcome.reason == "end", outcome.message
    return ROUNDS * STATEMENTS / seconds


def command_seconds() -> float:
    """Return the time from the shell to the end of `daidalos rapid check` of a small module."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lines.mod"
        path.write_text(program(10))
        command = [sys.executable, "-m", "daidalos.cli.daidalos", "rapid", "check", str(path)]
        best = float("inf")
        for _ in range(REPEATS):
            begin = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            best = min(best, time.perf_counter() - begin)
        return best
