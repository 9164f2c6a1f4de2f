"""Expressions compute values, and nothing else."""

import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.description.expressions import MAX_LENGTH, MAX_STEPS, Evaluator, ExpressionError
from properties import examples

NAMES = {
    **{name: getattr(math, name) for name in ("pi", "sin", "cos", "radians", "sqrt", "atan2")},
    **{kind.__name__: kind for kind in (list, dict, str, float, int, bool)},
    **{function.__name__: function for function in (len, min, max, abs, all, any, enumerate, isinstance, repr, sorted)},
    "zip": zip,
    "side": "left",
    "size": 0.5,
    "values": [3, 1, 2],
    "table": {"a": {"b": 7}},
}

VALUES = [
    ("pi/2", math.pi / 2),
    ("-size * 2 ** 3 % 3", -0.5 * 8 % 3),
    ("'front_' + side if size > 0.1 else side", "front_left"),
    ("len(values) == 3 and not (1 in [2])", True),
    ("0 < size <= 0.5", True),
    ("values[1:] + [4]", [1, 2, 4]),
    ("[v * k for k, v in enumerate(values) if v > 1]", [0, 4]),
    ("{k: v for k, v in zip('ab', values)}", {"a": 3, "b": 1}),
    ("sorted(values, key=lambda v: -v)", [3, 2, 1]),
    ("(lambda a, b=2: a * b)(3)", 6),
    ("'{}_{:.2f}_{x}'.format(side, size, x=1)", "left_0.50_1"),
    ("'%s_%04d' % (side, 7)", "left_0007"),
    ("f'{side}_{size:5.1f}'", "left_  0.5"),
    ("' '.join(str(v) for v in range(3))", "0 1 2"),
    ("side.upper().replace('L', 'R').startswith('R')", True),
    ("table['a']['b']", 7),
    ("table.get('c', 5)", 5),
    ("sum(values) + sum([size, size])", 7.0),
    ("list(map(lambda v: v + 1, values))", [4, 2, 3]),
    ("round(2.345, 1)", 2.3),
    ("factorial(5) + comb(4, 2)", 126),
    ("type(size) == float", True),
    ("(1).bit_length()", 1),
    ("1 << 4 | 2", 18),
    (" 3 ", 3),
]

HOSTILE = [
    "().__class__.__bases__[0].__subclasses__()",
    "(lambda: 0).__code__",
    "(lambda: 0).__globals__['__builtins__']",
    "__import__('os')",
    "__builtins__",
    "_guarded_call",
    "(lambda _guarded_call: 0)(1)",
    "[0 for _guarded_sum in [1]]",
    "'{0.__class__}'.format(1)",
    "'{0[__class__]}'.format({})",
    "'{0.real}'.format(1)",
    "f'{values:9999}'",
    "'{:9999999999}'.format(1)",
    "'{:{w}}'.format(1, w=9999999999)",
    "'%9999999999d' % 1",
    "'%*d' % (9999999999, 1)",
    "str.format('{0.__class__}', 1)",
    "'{0.__class__}'.format_map({})",
    "list(map(str.format, ['{0.__class__}'], [1]))",
    "(x for x in [1]).gi_frame",
    "type(type(1))",
    "type(len)",
    "type('X', (), {})",
    "type(lambda: 0)",
    "len.__self__",
    "'a'.encode()",
    "9**9**9**9",
    "9**9**9",
    "2**100000",
    "1 << 100000",
    "(9**999)**999",
    "10**3000 * 10**3000",
    "'a' * 10**10",
    "10**10 * 'a'",
    "[0] * 10**10",
    "[[0] * 99999 for i in range(99999)]",
    "range(10**12)",
    "sum(range(10**12))",
    "[1 for a in range(99999) for b in range(99999)]",
    "[a for a in range(99999) if a in list(range(99999))]",
    "sum([[0] * 999 for i in range(999)], [])",
    "sorted(list(range(99999)) for i in range(99999))",
    "factorial(10**6)",
    "comb(10**6, 10**5)",
    "round(1, -10**9)",
    "'a'.zfill(10**10)",
    "('a' * 9999).replace('a', 'a' * 9999)",
    "('a' * 9999).join('a' * 9999)",
    "[v.extend(v) for v in [[1]] for i in range(99)]",
    "(lambda f: f(f))(lambda f: f(f))",
    "(yield 1)",
    "(x := 1)",
    "await x",
    "(" * 300,
    "1" + "+1" * 4000,
    "-" * 9000 + "1",
    "9" * 9000,
    "x" * 20000,
    "prod([9**900] * 99999)",
    "\x00",
    "",
]


ENDS = (
    ExpressionError, ArithmeticError, AttributeError, LookupError, NameError, RecursionError, SyntaxError, TypeError,
    ValueError,
)  # fmt: skip


@pytest.fixture
def evaluate():
    evaluator = Evaluator()
    names = {**NAMES, **evaluator.functions()}
    return lambda text: evaluator.evaluate(text, names)


@pytest.mark.parametrize(("text", "value"), VALUES)
def test_values(evaluate, text, value):
    assert evaluate(text) == value


@pytest.mark.slow
@pytest.mark.parametrize("text", HOSTILE)
def test_what_reaches_beyond_values_or_grows_is_refused(evaluate, text):
    with pytest.raises(ENDS):
        evaluate(text)


def test_the_allowance_is_for_all_expressions_together():
    evaluator = Evaluator()
    names = evaluator.functions()
    evaluator.charge(MAX_STEPS - 10)
    with pytest.raises(ExpressionError, match="steps"):
        evaluator.evaluate("[a for a in range(9)]", names)


@examples(300)
@given(
    st.recursive(
        st.sampled_from(["1", "size", "values", "side", "9**9", "table", "''", "str", "range(9)", "(lambda: 0)"]),
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from(["+", "*", "**", "%", "<<", "==", "in", "if 1 else"]), inner).map(
                lambda parts: f"({' '.join(parts)})"
            ),
            st.tuples(inner, st.sampled_from(["format", "join", "__class__", "real", "keys"])).map(".".join),
            st.tuples(inner, inner).map(lambda parts: f"{parts[0]}({parts[1]})"),
            st.tuples(inner, inner).map(lambda parts: f"[{parts[0]} for v in {parts[1]}]"),
            st.tuples(inner, inner).map(lambda parts: f"{parts[0]}[{parts[1]}]"),
        ),
        max_leaves=12,
    )
)
def test_any_expression_ends_with_a_value_or_an_error(text):
    evaluator = Evaluator()
    value = None
    with contextlib.suppress(*ENDS):
        value = evaluator.evaluate(text, {**NAMES, **evaluator.functions()})
    assert len(str(value)) < 10 * MAX_LENGTH
