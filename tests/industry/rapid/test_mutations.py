"""Mutated programs: whatever is in a file, it is read to its end, and each problem has a place in it."""

import time

from hypothesis import given
from hypothesis import strategies as st

from daidalos.industry.rapid.checking import check
from daidalos.industry.rapid.lexing import tokenize
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source
from properties import examples

from .programs import EVERYTHING

TOKENS = [token.text for token in tokenize(EVERYTHING)[0]]
LIMIT_S = 5.0
_PLACES = st.integers(0, len(TOKENS) - 1)
_NEW = st.one_of(st.sampled_from(sorted(set(TOKENS))), st.text(max_size=3), st.sampled_from(["<SMT>", '"', "!", "%%%"]))
_EDITS = st.lists(
    st.tuples(st.sampled_from(["insert", "delete", "replace", "swap", "cut"]), _PLACES, _PLACES, _NEW), min_size=1
)


def mutated(edits: list[tuple[str, int, int, str]]) -> str:
    tokens = list(TOKENS)
    for kind, one, other, new in edits:
        size = len(tokens)
        if not size:
            break
        one, other = one % size, other % size
        if kind == "insert":
            tokens.insert(one, new)
        elif kind == "delete":
            del tokens[one]
        elif kind == "replace":
            tokens[one] = new
        elif kind == "swap":
            tokens[one], tokens[other] = tokens[other], tokens[one]
        else:
            del tokens[one : one + 5]
    return "\n".join(tokens)


def assert_read(text: str) -> None:
    begin = time.perf_counter()
    found = check([parse(Source("m.mod", text))])["m.mod"]
    assert time.perf_counter() - begin < LIMIT_S
    lines = text.splitlines() or [""]
    for problem in found:
        assert 1 <= problem.line <= len(lines) + 1
        assert problem.column >= 1
        assert problem.message


@examples(300)
@given(_EDITS)
def test_mutated_programs_are_read(edits: list[tuple[str, int, int, str]]) -> None:
    assert_read(mutated(edits))


@examples(200)
@given(st.text(max_size=200))
def test_any_text_is_read(text: str) -> None:
    assert_read(text)


@examples(100)
@given(st.lists(st.sampled_from([*sorted(set(TOKENS)), "("]), max_size=60))
def test_any_words_are_read(words: list[str]) -> None:
    assert_read(" ".join(words))
