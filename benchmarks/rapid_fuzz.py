"""Mutated programs in RAPID, read, checked and run: faults, and the longest time that one takes.

`DAIDALOS_FUZZ_INPUTS` says how many programs are tried (2,000 by default; 100,000 take about ten minutes),
`DAIDALOS_FUZZ_SEED` with which random numbers. A program at fault is printed.
"""

from __future__ import annotations

import os
import random
import sys
import time
from pathlib import Path
from types import FrameType
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.lexing import tokenize
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.errors import FatalError, ProgramEnd
from daidalos.industry.rapid.runtime.pendant import TextPendant
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.sources import Source
from industry.rapid.programs import EVERYTHING

INPUTS = int(os.environ.get("DAIDALOS_FUZZ_INPUTS", "2000"))
SEED = int(os.environ.get("DAIDALOS_FUZZ_SEED", "0"))
MOST_LINES = 2_000
"""Lines after which a run is ended: a loop without end is none of the runtime's faults."""

_EXCHANGED = 0.5
_OPERATORS = ("+", "-", "*", "/", "DIV", "MOD", "<", ">", "=", "<>")
_NUMBERS = ("0", "1", "2", "5", "6", "0.5", "1E30", "9E9", "1E308", "100000")

RUNNING = """MODULE run
  PERS num kept := 1;
  VAR num list{5} := [1,2,3,4,5];
  VAR pos place := [1,2,3];
  VAR string text := "abc";
  CONST robtarget p := [[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR num i := 0;
    VAR bool flag := TRUE;
    FOR k FROM 1 TO 5 STEP 2 DO
      list{k} := list{k} * 2 + k DIV 2 - k MOD 3;
      MoveL Offs(p, list{k}, k, 0), v100, z10, tool0;
    ENDFOR
    WHILE i < 4 AND flag DO
      i := i + 1;
      IF i = 2 THEN place.x := place.y / i; ELSEIF i > 3 THEN flag := FALSE; ELSE text := text + "d"; ENDIF
      TEST i CASE 1, 2: SetDO doA, 1; DEFAULT: Reset doA; ENDTEST
    ENDWHILE
    twice kept; TPWrite text \\Num:=half(kept); WaitTime 0.1;
    again: IF i > 0 THEN i := i - 1; GOTO again; ENDIF
    %"twice"% kept;
  ERROR
    IF ERRNO = ERR_DIVZERO TRYNEXT;
    RETURN;
  ENDPROC
  PROC twice(INOUT num x) x := x * 2; ENDPROC
  FUNC num half(num x) IF x = 0 RETURN 0; RETURN x / 2; ENDFUNC
ENDMODULE
"""


def run() -> dict[str, float]:
    """Try all programs."""
    generator = random.Random(SEED)
    seeds = [[token.text for token in tokenize(text)[0]] for text in (EVERYTHING, RUNNING)]
    words = sorted({token for tokens in seeds for token in tokens})
    faults = ran = 0
    slowest = 0.0
    for _ in range(INPUTS):
        if generator.random() < _EXCHANGED:
            text = exchanged(generator, list(seeds[-1]))
        else:
            text = mutated(generator, list(generator.choice(seeds)), words)
        begin = time.perf_counter()
        try:
            ran += tried(text)
        except Exception as error:
            faults += 1
            print(f"{type(error).__name__}: {error}\n{text}\n", file=sys.stderr)
        slowest = max(slowest, time.perf_counter() - begin)
    return {
        "rapid_fuzz.programs": INPUTS,
        "rapid_fuzz.programs_run": ran,
        "rapid_fuzz.faults": faults,
        "rapid_fuzz.slowest_s": slowest,
    }


def mutated(generator: random.Random, tokens: list[str], words: list[str]) -> str:
    """Return a program with a few tokens inserted, deleted, replaced, exchanged or doubled."""
    for _ in range(generator.randint(1, 4)):
        one, other = (generator.randrange(len(tokens)) for _ in range(2))
        kind = generator.randrange(5)
        if kind == 0:
            tokens.insert(one, generator.choice(words))
        elif kind == 1 and len(tokens) > 1:
            del tokens[one]
        elif kind == 2:
            tokens[one] = generator.choice(words)
        elif kind == 3:
            tokens[one], tokens[other] = tokens[other], tokens[one]
        else:
            tokens[one:one] = tokens[other : other + 10]
    return "\n".join(tokens)


def exchanged(generator: random.Random, tokens: list[str]) -> str:
    """Return a program with some numbers and operators replaced by others: most of these still run."""
    for _ in range(generator.randint(1, 3)):
        places = [i for i, one in enumerate(tokens) if one[0].isdigit() or one in _OPERATORS]
        place = generator.choice(places)
        tokens[place] = generator.choice(_OPERATORS if tokens[place] in _OPERATORS else _NUMBERS)
    return "\n".join(tokens)


def tried(text: str) -> bool:
    """Read, check and run a program; return whether it was run."""
    parsed = parse(Source("m.mod", text))
    checker = Checker([parsed])
    if any(not one.runs for one in checker.check()["m.mod"]):
        return False
    try:
        task = Task([parsed], checker, pendant=TextPendant(lambda _: "1", lambda _: None), limit=60.0)
    except FatalError:
        return False
    left = [MOST_LINES]

    def trace(frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line" and frame.f_code.co_filename == "<rapid>":
            left[0] -= 1
            if left[0] < 0:
                raise ProgramEnd("its number of lines")
        return trace

    task.tracer = trace
    task.run()
    return True
