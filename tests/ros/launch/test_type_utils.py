"""Typed values and substitutions."""

from typing import List  # noqa: UP035 - callers use it

import pytest
from hypothesis import given
from hypothesis import strategies as st
from launch import LaunchContext
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import (
    coerce_list,
    coerce_to_type,
    extract_type,
    get_typed_value,
    is_instance_of,
    is_instance_of_valid_type,
    is_normalized_substitution,
    is_substitution,
    is_typing_list,
    is_valid_scalar_type,
    normalize_typed_substitution,
    perform_typed_substitution,
)

TEXT = TextSubstitution(text="asd")


@pytest.mark.parametrize("scalar", [int, float, bool, str])
def test_types(scalar):
    assert extract_type(scalar) == (scalar, False)
    assert extract_type(List[scalar]) == (scalar, True)  # noqa: UP006
    assert extract_type(list[scalar]) == (scalar, True)
    assert is_typing_list(list[scalar])
    assert not is_typing_list(scalar)
    assert is_valid_scalar_type(scalar)


@pytest.mark.parametrize("wrong", [dict, list, list[bytes], tuple[int, ...], "int", None, 1])
def test_other_types(wrong):
    with pytest.raises(ValueError, match="unrecognized data type"):
        extract_type(wrong)


@pytest.mark.parametrize(
    ("value", "data_type", "can_be_str", "expected"),
    [
        (1, int, False, True),
        (1, float, False, False),
        (True, int, False, False),
        (True, bool, False, True),
        ("1", int, False, False),
        ("1", int, True, True),
        ([1, 2], list[int], False, True),
        ([1, "2"], list[int], False, False),
        ([1, "2"], list[int], True, True),
        ([1, 2], int, False, False),
        (1, list[int], False, False),
        ([], list[str], False, True),
        ({}, None, False, False),
        ([1, 2.0], None, False, False),
        ([1, "a"], None, True, True),
        ("a", None, False, True),
    ],
)
def test_is_instance_of(value, data_type, can_be_str, expected):
    assert is_instance_of(value, data_type, can_be_str=can_be_str) is expected
    if data_type is None:
        assert is_instance_of_valid_type(value, can_be_str=can_be_str) is expected


@pytest.mark.parametrize(
    ("text", "data_type", "value"),
    [
        ("asd", str, "asd"),
        ("1", str, "1"),
        ("1", int, 1),
        ("-3", int, -3),
        ("0x10", int, 16),
        ("1", float, 1.0),
        ("1.5", float, 1.5),
        (".inf", float, float("inf")),
        ("1e-3", float, 0.001),
        ("1e-3", None, "1e-3"),
        ("true", bool, True),
        ("off", bool, False),
        ("1", bool, True),
        ("0", bool, False),
        ("[1, 2]", list[int], [1, 2]),
        ("[true, no]", list[bool], [True, False]),
        ("[a, 'b']", list[str], ["a", "b"]),
        ("1", None, 1),
        ("1.0", None, 1.0),
        ("true", None, True),
        ("asd", None, "asd"),
        ("'1'", None, "1"),
        ("[1, 2]", None, [1, 2]),
        ("", None, ""),
    ],
)
def test_coercion(text, data_type, value):
    coerced = coerce_to_type(text, data_type)
    assert coerced == value
    assert type(coerced) is type(value)


@pytest.mark.parametrize(
    ("text", "data_type"),
    [
        ("asd", int),
        ("1.5", int),
        ("true", int),
        ("asd", float),
        ("2", bool),
        ("asd", bool),
        ("1", list[int]),
        ("[1, 2", list[int]),
        ("{a: 1}", None),
        ("a: b: c", None),
    ],
)
def test_failed_coercion(text, data_type):
    with pytest.raises(ValueError, match="convert"):
        coerce_to_type(text, data_type)
    assert coerce_to_type(text, data_type, can_be_str=True) == text


def test_texts_within_a_list():
    assert coerce_to_type("[1, a]", list[int], can_be_str=True) == [1, "a"]
    for data_type in (list[int], None):
        with pytest.raises(ValueError, match="convert"):
            coerce_to_type("[1, a]", data_type)


def test_only_text_is_coerced():
    with pytest.raises(TypeError, match="'value' of coerce_to_type is expected to be str"):
        coerce_to_type(1, int)
    with pytest.raises(ValueError, match="unrecognized"):
        coerce_to_type("1", dict, can_be_str=True)


def test_lists_are_coerced_item_by_item():
    assert coerce_list(["1", "2"], int) == [1, 2]
    assert coerce_list(["1", "2"]) == [1, 2]
    assert coerce_list(["1", "$(x)"], int, can_be_str=True) == [1, "$(x)"]
    for wrong in ("a", [1, 2]):
        with pytest.raises(TypeError, match="is expected to be"):
            coerce_list(wrong)
    with pytest.raises(ValueError, match="not of one type"):
        coerce_list(["1", "a"])
    with pytest.raises(ValueError, match="convert"):
        coerce_list(["1", "a"], int)


def test_typed_values():
    assert get_typed_value("1", int) == 1
    assert get_typed_value(["1", "2"], list[float]) == [1.0, 2.0]
    assert get_typed_value(["1", "2"], None) == [1, 2]
    with pytest.raises(TypeError, match="is a list"):
        get_typed_value(["1"], int)


@given(st.integers(), st.floats(allow_nan=False), st.booleans())
def test_coercion_reads_what_python_writes(integer, number, truth):
    assert coerce_to_type(str(integer), int) == integer
    assert coerce_to_type(str(truth), bool) is truth
    assert coerce_to_type(repr(number), float) == number


@pytest.mark.parametrize(
    ("value", "expected"),
    [(TEXT, True), ([TEXT], True), (["a", TEXT], True), ("a", False), (["a"], False), (1, False), ([TEXT, 1], False)],
)
def test_is_substitution(value, expected):
    assert is_substitution(value) is expected


def test_is_normalized_substitution():
    assert is_normalized_substitution([TEXT])
    assert not is_normalized_substitution(TEXT)
    assert not is_normalized_substitution([])
    assert not is_normalized_substitution(["a"])


@pytest.mark.parametrize(
    ("value", "data_type", "result"),
    [
        (1, int, 1),
        (1, None, 1),
        (1, float, 1.0),
        (True, bool, True),
        ("1", None, "1"),
        ("1", str, "1"),
        ("asd", None, "asd"),
        ([1, 2], list[int], [1, 2]),
        ([1, 2], list[float], [1.0, 2.0]),
        ([1, 2], None, [1, 2]),
        ([1, 2.5], None, [1.0, 2.5]),
        (["1", "2"], None, ["1", "2"]),
        (["1", TextSubstitution(text="2")], int, 12),
        (["1", TextSubstitution(text="2")], None, 12),
        (["[", TextSubstitution(text="1, 2]")], list[int], [1, 2]),
        ([["1", TextSubstitution(text="2")], 3], list[int], [12, 3]),
        (LaunchConfiguration("n"), int, 7),
        ([LaunchConfiguration("n"), "5"], float, 75.0),
        ([[LaunchConfiguration("n")], [LaunchConfiguration("n"), "1"]], list[str], ["7", "71"]),
        (TextSubstitution(text="[1, 2]"), list[int], [1, 2]),
        ([], list[int], []),
    ],
)
def test_typed_substitutions(value, data_type, result):
    context = LaunchContext()
    context.launch_configurations["n"] = "7"
    performed = perform_typed_substitution(context, normalize_typed_substitution(value, data_type), data_type)
    assert performed == result
    assert type(performed) is type(result)


@pytest.mark.parametrize(
    ("value", "data_type"),
    [
        (1, str),
        (1.5, int),
        (True, float),
        ([1, 2], int),
        (1, list[int]),
        ("1", int),
        ("1", float),
        ("true", bool),
        ("[a, b]", list[str]),
        (["1", 2], list[int]),
        ([1, True], None),
        ([1, "2"], list[bool]),
        ([b"x"], None),
        ({}, int),
    ],
)
def test_values_that_can_not_be_normalized(value, data_type):
    with pytest.raises(TypeError):
        normalize_typed_substitution(value, data_type)


def test_texts_that_can_not_be_performed():
    context = LaunchContext()
    with pytest.raises(ValueError, match="convert"):
        perform_typed_substitution(context, normalize_typed_substitution(TEXT, int), int)
    with pytest.raises(ValueError, match="one type"):
        perform_typed_substitution(context, normalize_typed_substitution([[TEXT], 1], None), None)


@given(st.lists(st.text(), min_size=1))
def test_texts_in_a_row_are_joined(texts):
    subs = normalize_to_list_of_substitutions(texts)
    assert perform_substitutions(LaunchContext(), subs) == "".join(texts)
