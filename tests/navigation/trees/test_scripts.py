"""The script language of trees."""

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.scripts import Script


def run(source, **values):
    board = Blackboard()
    for name, value in values.items():
        board.set(name, value)
    return Script(source, "tree.xml:3").run(board), board


@pytest.mark.parametrize(
    ("source", "value"),
    [
        ("1 + 2 * 3", 7),
        ("(1 + 2) * 3", 9),
        ("7 - 2 - 1", 4),
        ("-2 * -3", 6),
        ("1 / 4", 0.25),
        ("0xff & 0x0f | 0x20", 0x2F),
        ("~0 ^ 1", -2),
        ("1.5e1 == 15", True),
        ("1 < 2 && 2 < 1 || !false", True),
        ("1 < 2 <= 2 < 3", True),
        ("3 > 2 > 2", False),
        ("'a' + 'b'", "ab"),
        ("'abc' != 'abd'", True),
        ("mode == 'fast' ? 2.0 : 1.0", 2.0),
        ("text == 3", True),
        ("flag == true", True),
        ("error == 208", True),
        ("false && missing", False),
        ("true || missing", True),
        (" 1 ; 2 ;; ", 2),
        ("", None),
    ],
)
def test_expressions(source, value):
    class Code(str):
        number = 208

    assert run(source, mode="fast", text="3", flag="true", error=Code("TIMEOUT"))[0] == value


def test_assignments_create_and_change_entries():
    _, board = run("a := 2; a += 3; b := a; b *= 2; b -= 1; b /= 3; c = 'x'; c += 'y'; d := a > 3", c="old")
    assert [board.get(name) for name in "abcd"] == [5, 3, "xy", True]


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("a = 1", "there is no entry 'a' on the blackboard that = could change; := creates one"),
        ("1 + b", "there is no entry 'b' on the blackboard"),
        ("'x' * 2", "'x' is not a number"),
        ("1 / 0", "division by zero"),
        ("1.5 & 1", "1.5 is not a whole number"),
        ("1 < 'x'", "not supported"),
        ("1 +", "there is the end where it cannot be"),
        ("1 + ) 2", r"there is '\) 2' where it cannot be"),
        ("a := := 2", "there is ':= 2' where it cannot be"),
        ("a $ 2", r"there is '\$ 2' where it cannot be"),
    ],
)
def test_mistakes_are_named(source, words):
    with pytest.raises(TreeError, match=f"^tree.xml:3: script .*{words}"):
        run(source)


_NUMBERS = st.integers(0, 1000).map(str) | st.floats(0.0, 1e6).map(repr)
_EXPRESSIONS = st.recursive(
    _NUMBERS,
    lambda inner: st.builds("({} {} {})".format, inner, st.sampled_from(["+", "-", "*", "<", "<=", "=="]), inner),
    max_leaves=8,
)


@given(_EXPRESSIONS)
def test_expressions_mean_what_they_do_in_python(source):
    assert math.isclose(run(source)[0], eval(source), rel_tol=1e-12)


@given(st.text(alphabet="ab1 .+-*/=:;<>!&|?()'~^@", max_size=12))
def test_a_text_is_a_script_or_a_tree_error(source):
    with suppress(TreeError):
        run(source, a=1, b="2")
