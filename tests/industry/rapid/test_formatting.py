"""The formatter: the tree and the comments stay, and what is formatted stays as it is."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from daidalos.industry.rapid import tree
from daidalos.industry.rapid.formatting import format_source
from daidalos.industry.rapid.lexing import header_end, tokenize
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source
from properties import examples

from .programs import EVERYTHING

TOKENS = [token.text for token in tokenize(EVERYTHING)[0]]
FORMATTED = """MODULE m
  ! before

  PERS num x := 1; ! behind
  PROC main()
    ! inside
    IF x = 1 AND
        -x < 2 THEN
      MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],
          [9E9,9E9,9E9,9E9,9E9,9E9]], v100 \\T:=3, fine, tool0;
    ELSE
      ! nothing
    ENDIF
    %"p" + "q"% 1, -2;
    IF x > 1 Stop;
  ERROR
    RETRY;
  ENDPROC
ENDMODULE
"""
UNTIDY = """module m
! before


pers num x:=1;! behind
Proc main( )
      ! inside
if x=1 and
-x<2 then MoveL [ [1,2,3] ,[1,0,0,0],[0,0,0,0],
  [9E9,9E9,9E9,9E9,9E9,9E9]],v100\\T:=3,fine,tool0;
else
! nothing
endif %"p"+"q"%1,-2; IF x>1 Stop;
error RETRY;
endproc endmodule"""


def formatted(text: str) -> str:
    return format_source(Source("m.mod", text))


def test_an_untidy_module() -> None:
    assert formatted(UNTIDY) == FORMATTED
    assert formatted(FORMATTED) == FORMATTED


def test_header_and_line_ends_stay() -> None:
    text = "%%%\r\n  VERSION:1\r\n%%%\r\nMODULE m\r\nENDMODULE"
    assert formatted(text) == text + "\r\n"


def test_a_module_with_errors_is_not_formatted() -> None:
    with pytest.raises(UserError, match=r"m\.mod:3:1: syntax error"):
        formatted("MODULE m\n  PROC\nENDMODULE")


@examples(300)
@given(st.integers(0, 2**32))
def test_white_space_and_comments_change_nothing(seed: int) -> None:
    random_ = random.Random(seed)
    separators = [" ", "\n", "\n\n\n", "\t", " ! note; IF\n", "\n! note\n", "\r\n"]
    text = EVERYTHING[: header_end(EVERYTHING)]
    for token in TOKENS:
        text += random_.choices(separators, [20, 5, 1, 2, 1, 1, 1])[0]
        text += token.upper() if random_.random() < 0.1 and not token.startswith('"') else token
    before = parse(Source("m.mod", text))
    assert not before.problems
    once = formatted(text)
    after = parse(Source("m.mod", once))
    assert not after.problems
    assert tree.same(before.tree, after.tree)
    assert [one.text.strip() for one in before.comments] == [one.text.strip() for one in after.comments]
    assert formatted(once) == once
