"""Names, remappings and parameters: prepared and worked out."""

import io
import pathlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from launch import LaunchContext
from launch.frontend import Parser
from launch.substitutions import LaunchConfiguration, SubstitutionFailure, TextSubstitution
from launch.utilities import perform_substitutions
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from launch_ros.utilities import (
    add_node_name,
    evaluate_parameter_dict,
    evaluate_parameters,
    get_node_name_count,
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    normalize_parameter_dict,
    normalize_parameters,
    normalize_remap_rule,
    normalize_remap_rules,
    prefix_namespace,
    to_parameters_list,
)
from launch_ros.utilities.namespace_utils import check_namespace, check_node_name
from launch_ros.utilities.plugin_support import get_upper_bound_caret_version, satisfies_version


@pytest.fixture
def context():
    context = LaunchContext()
    context.launch_configurations.update(one="1", word="text", truth="true")
    return context


# Names ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("base", "name", "expected"),
    [
        (None, None, None),
        (None, "foo", "foo"),
        (None, "/foo", "/foo"),
        ("", "foo", "foo"),
        ("foo", None, "foo"),
        ("foo", "", "foo"),
        ("foo", "bar", "foo/bar"),
        ("/foo", "bar", "/foo/bar"),
        ("/foo/", "bar", "/foo/bar"),
        ("foo", "/bar", "/bar"),
        ("foo", "/", "/"),
        ("/", "bar", "/bar"),
        ("/", "bar/", "/bar"),
    ],
)
def test_prefixes(base, name, expected):
    assert prefix_namespace(base, name) == expected


def test_absolute_namespaces():
    assert is_root_namespace("/")
    assert not is_root_namespace("/a")
    assert is_namespace_absolute("/a")
    assert not is_namespace_absolute("a")
    assert make_namespace_absolute("a/b") == "/a/b"
    assert make_namespace_absolute("/a") == "/a"


@pytest.mark.parametrize("good", ["/", "/a", "/a1/_b"])
def test_good_namespaces(good):
    check_namespace(good)


@pytest.mark.parametrize("bad", ["", "a", "/1a", "/a//b", "/a/", "/a-b", "/a b", "/ä"])
def test_bad_namespaces(bad):
    with pytest.raises(SubstitutionFailure, match="malformed"):
        check_namespace(bad)


def test_node_names():
    check_node_name("node_1")
    for bad in ("", "1node", "a/b", "a b", "a.b"):
        with pytest.raises(SubstitutionFailure, match="malformed"):
            check_node_name(bad)


def test_counting_names(context):
    assert get_node_name_count(context, "/a") == 0
    add_node_name(context, "/a")
    add_node_name(context, "/a")
    assert get_node_name_count(context, "/a") == 2
    assert get_node_name_count(context, "/b") == 0
    assert get_node_name_count(LaunchContext(), "/a") == 0


# Remappings -------------------------------------------------------------------------------------------


def test_remappings(context):
    [(source, destination)] = normalize_remap_rules([("from", ["to_", LaunchConfiguration("word")])])
    assert perform_substitutions(context, source) == "from"
    assert perform_substitutions(context, destination) == "to_text"
    for wrong in ("ab", ["a", "b"], ("a",), ("a", "b", "c"), (1, 2)):
        with pytest.raises(TypeError):
            normalize_remap_rule(wrong)
    with pytest.raises(TypeError):
        list(normalize_remap_rules(5))


# Parameters -------------------------------------------------------------------------------------------


def evaluated(context, parameters):
    return evaluate_parameter_dict(context, normalize_parameter_dict(parameters))


ONE, WORD, TRUTH = LaunchConfiguration("one"), LaunchConfiguration("word"), LaunchConfiguration("truth")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (1, 1),
        (1.5, 1.5),
        (True, True),
        (b"\xff\x00", b"\xff\x00"),
        ("text", "text"),
        ("8080", "8080"),
        ("true", "true"),
        ("'1'", "'1'"),
        ("", ""),
        ("a: b: # c", "a: b: # c"),
        ("[1, 2]", "[1, 2]"),
        (TextSubstitution(text="1.5"), 1.5),
        (TextSubstitution(text="'1'"), "1"),
        (TextSubstitution(text='"true"'), "true"),
        (TextSubstitution(text=""), ""),
        (TextSubstitution(text="two words # and no comment"), "two words # and no comment"),
        (TextSubstitution(text="a\n\n  b"), "a\n\n  b"),
        (TextSubstitution(text="[1, 2]"), (1, 2)),
        (ONE, 1),
        ([ONE, "5"], 15),
        ([WORD, "_", ONE], "text_1"),
        (TRUTH, True),
        ([1, 2, 3], (1, 2, 3)),
        ((1, 2), (1, 2)),
        ([1, 2.5], (1.0, 2.5)),
        ([True, False], (True, False)),
        (["a", "b"], ("a", "b")),
        (["1", "2"], ("1", "2")),
        (["1", "a"], ("1", "a")),
        ([["1", TextSubstitution(text="2")], ["3"]], (12, 3)),
        ([[ONE], [ONE, "2"]], (1, 12)),
        ([[WORD], "x"], ("text", "x")),
        (ParameterValue(ONE, value_type=str), "1"),
        (ParameterValue("1"), "1"),
        (ParameterValue("a: b: # c", value_type=str), "a: b: # c"),
        (ParameterValue(["[", ONE, ", 2]"], value_type=list[int]), [1, 2]),
        (ParameterValue(2.5), 2.5),
    ],
)
def test_values(context, value, expected):
    result = evaluated(context, {"name": value})["name"]
    assert result == expected
    assert type(result) is type(expected)


def test_names(context):
    parameters = {
        "plain": 1,
        ("tuple_", ONE): 2,
        ONE: 3,
        "nested": {"a": {"b": 4}, ("c_", WORD): 5},
    }
    assert evaluated(context, parameters) == {
        "plain": 1,
        "tuple_1": 2,
        "1": 3,
        "nested.a.b": 4,
        "nested.c_text": 5,
    }


@pytest.mark.parametrize("wrong", [None, {1: 2}, {"a": None}, {"a": {1, 2}}, {"a": object()}, {"a": [None]}, ["a"]])
def test_what_is_no_parameter(wrong):
    with pytest.raises(TypeError):
        normalize_parameter_dict(wrong)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (TextSubstitution(text="a: b: c"), "Unable to parse the value of parameter name as yaml.*ParameterValue"),
        (TextSubstitution(text="{a: b}"), "Got dict for the parameter name"),
        (TextSubstitution(text="[1, a]"), "Expected a non-empty sequence.*the parameter name"),
        (TextSubstitution(text="[]"), "Expected a non-empty sequence"),
        (TextSubstitution(text="2024-01-01"), "Got date"),
        ([True, 2.0, 3], "Expected a non-empty sequence"),
        ([True, 1], "Expected a non-empty sequence"),
        ([1, "a"], "Expected a non-empty sequence"),
        ([[ONE], [WORD]], "Expected a non-empty sequence"),
        ([], "Expected a non-empty sequence"),
    ],
)
def test_values_that_no_parameter_can_have(context, value, reason):
    with pytest.raises(TypeError, match=reason):
        evaluated(context, {"name": value})


@given(st.text())
def test_strings_stay_what_they_are(text):
    assert evaluated(LaunchContext(), {"one": text, "some": [text, "1"]}) == {"one": text, "some": (text, "1")}


@given(
    st.dictionaries(
        st.text(alphabet="abc", min_size=1), st.one_of(st.booleans(), st.integers(), st.floats(allow_nan=False))
    )
)
def test_numbers_stay_what_they_are(parameters):
    assert evaluated(LaunchContext(), parameters) == parameters


def test_all_kinds_together(context, tmp_path):
    path = tmp_path / "a.yaml"
    described = Parameter("p", 1)
    normalized = normalize_parameters(
        [str(path), path, [str(tmp_path), "/a.yaml"], ParameterFile(path), {"a": 1}, described]
    )
    result = evaluate_parameters(context, normalized)
    assert result == (path, path, path, path, {"a": 1}, described)
    for wrong in ({"a": 1}, "file.yaml", 5, [5], [None]):
        with pytest.raises(TypeError):
            normalize_parameters(wrong)
    with pytest.raises(TypeError):
        evaluate_parameters(context, [5])
    with pytest.raises(TypeError):
        evaluate_parameter_dict(context, [5])
    with pytest.raises(TypeError):
        evaluate_parameter_dict(context, {"name": 5})


def test_parameter_descriptions(context):
    parameter = Parameter(["p_", ONE], [ONE, "2"], value_type=int)
    assert isinstance(parameter.name[0], TextSubstitution)
    assert parameter.value_type is int
    assert parameter.evaluate(context) == ("p_1", 12)
    assert (parameter.name, parameter.value) == ("p_1", 12)
    value = ParameterValue(ONE)
    assert value.value == [ONE]
    assert value.evaluate(context) == 1
    assert value.value == 1


def test_parameter_files(context, tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("/**:\n  ros__parameters:\n    a: $(var one)\n")
    plain = ParameterFile([str(tmp_path), "/a.yaml"])
    assert isinstance(plain.param_file, list)
    assert plain.evaluate(context) == path
    assert plain.param_file == path
    assert plain.allow_substs is False
    replaced = ParameterFile(path, allow_substs=TRUTH)
    temporary = replaced.evaluate(context)
    assert replaced.allow_substs is True
    assert temporary.read_text() == "/**:\n  ros__parameters:\n    a: 1\n"
    again = replaced.evaluate(context)  # for the next node, while the first one has yet to read its file
    assert temporary.exists()
    replaced.cleanup()
    assert not temporary.exists()
    assert not again.exists()
    assert "a.yaml" in str(ParameterFile(path))
    path.write_text("a: $(env LT_BROKEN)")
    context.environment["LT_BROKEN"] = "["
    with pytest.raises(SubstitutionFailure, match="not YAML"):
        ParameterFile(path, allow_substs=True).evaluate(context)


FILE = """
/**: {ros__parameters: {everyone: 1, deep: {er: 2}}}
/*: {ros__parameters: {root_only: 3}}
/ns/node: {ros__parameters: {mine: 4}}
ns: {node: {ros__parameters: {nested: 5}}, other: {ros__parameters: {not_mine: 6}}}
/ns/*: {ros__parameters: {mine: 7}}
/**/node: {ros__parameters: {any_ns: 8}}
node: {ros__parameters: {without_ns: 9}}
"""


@pytest.mark.parametrize(
    ("name", "namespace", "expected"),
    [
        ("node", "/ns", {"everyone": 1, "deep.er": 2, "nested": 5, "mine": 7, "any_ns": 8}),
        ("node", "/", {"everyone": 1, "deep.er": 2, "root_only": 3, "any_ns": 8, "without_ns": 9}),
        ("else", "/a/b", {"everyone": 1, "deep.er": 2}),
    ],
)
def test_parameters_as_messages(context, tmp_path, name, namespace, expected):
    path = tmp_path / "a.yaml"
    path.write_text(FILE)
    messages = to_parameters_list(
        context, name, namespace, [path, {"list": (1, 2), "everyone": 10}, Parameter("s", "x")]
    )
    values = {message.name: message.value for message in messages}
    assert set(values) == {*expected, "list", "s"}
    for parameter, number in {**expected, "everyone": 10}.items():
        assert values[parameter].integer_value == number
    assert list(values["list"].integer_array_value) == [1, 2]
    assert values["s"].string_value == "x"


def test_flat_parameter_files(context, tmp_path):
    path = tmp_path / "flat.yaml"
    path.write_text("a: 1\ndeep: {b: two}\n")
    messages = to_parameters_list(context, "node", "/", [path])
    assert {message.name: message.value.type for message in messages} == {"a": 2, "deep.b": 4}
    path.write_text("other: {ros__parameters: {a: 1}}\n")
    assert to_parameters_list(context, "node", "/", [path]) == []


def test_versions():
    assert get_upper_bound_caret_version("1.2.3") == "2.0.0"
    assert get_upper_bound_caret_version("0.2.3") == "0.3.0"
    assert get_upper_bound_caret_version("0.0.3") == "0.0.4"
    assert satisfies_version("1.2.3", "^1.2")
    assert satisfies_version("0.1.5", "^0.1")
    assert not satisfies_version("2.0.0", "^1.2")
    assert not satisfies_version("1.1.0", "^1.2")
    assert not satisfies_version("0.2.0", "^0.1")
    with pytest.raises(ValueError, match="caret"):
        satisfies_version("1.0", "1.0")


def test_substitution_in_a_path(context):
    [path] = evaluate_parameters(context, normalize_parameters([[WORD, ".yaml"]]))
    assert path == pathlib.Path("text.yaml")


def test_a_parameter_given_twice_stays_in_order(context):
    messages = to_parameters_list(context, "n", "/", [{"a": 1, "b": 2}, {"a": 3}])
    assert [(message.name, message.value.integer_value) for message in messages] == [("a", 1), ("b", 2), ("a", 3)]


@pytest.mark.parametrize(
    "text",
    [
        "<launch><load_composable_node target='c'><composable_node pkg='p' plugin='q' name='n'>"
        "<extra_arg name='yes' value='true'/><param name='list' value='1, 2' value-sep=', '/>"
        "</composable_node></load_composable_node></launch>",
        "launch: [load_composable_node: {target: c, composable_node: [{pkg: p, plugin: q, name: n, "
        "extra_arg: [{name: 'yes', value: 'true'}], param: [{name: list, value: [1, 2]}]}]}]",
    ],
)
def test_texts_in_markup_are_yaml(context, text):
    root, parser = Parser.load(io.StringIO(text))
    [load] = parser.parse_description(root).entities
    request = get_composable_node_load_request(load._LoadComposableNodes__composable_node_descriptions[0], context)
    assert [one.value.bool_value for one in request.extra_arguments] == [True]
    assert [list(one.value.integer_array_value) for one in request.parameters] == [[1, 2]]


def test_parameters_of_a_named_node_count_more_than_those_of_all(context, tmp_path):
    path = tmp_path / "parameters.yaml"
    path.write_text(
        "/ns:\n  node:\n    ros__parameters: {first: 1, second: 2}\n/**:\n  ros__parameters: {second: 22, third: 33}\n"
    )
    messages = to_parameters_list(context, "node", "/ns", [path])
    assert [(one.name, one.value.integer_value) for one in messages] == [("second", 2), ("third", 33), ("first", 1)]
