"""Launch files in YAML."""

import io
import re
import sys
import textwrap

import pytest
from launch import LaunchContext
from launch.actions import ExecuteProcess, Shutdown, TimerAction
from launch.frontend import Entity as BaseEntity
from launch.launch_file_error import LaunchFileError
from launch.utilities import perform_substitutions
from launch_yaml import Entity, Parser
from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource

PYTHON = sys.executable


def load(text):
    return Parser.load(io.StringIO(textwrap.dedent(text)))


def first_action(text):
    root, parser = load(text)
    return parser.parse_description(root).entities[0]


def test_elements():
    root, _ = load("launch:\n- a:\n    x: 1\n    children:\n    - b: {}\n    - c: [d: {}]\n- e:\n  - f: {y: 2}\n")
    assert root.type_name == "launch"
    assert root.parent is None
    a, e = root.children
    assert (a.type_name, a.parent, a.location) == ("a", root, (None, 3))
    b, c = a.children
    assert (b.type_name, c.children[0].type_name) == ("b", "d")
    assert e.children[0].get_attr("y", data_type=int) == 2
    assert e.get_attr("anything", optional=True) is None


@pytest.mark.parametrize(
    ("value", "data_type", "expected"),
    [
        ("asd", str, "asd"),
        ("1", int, 1),
        ("1", float, 1.0),
        ("1.5", float, 1.5),
        ("true", bool, True),
        ("'1'", str, "1"),
        ("1", None, 1),
        ("[1, 2]", list[int], [1, 2]),
        ("[a, b]", list[str], ["a", "b"]),
        ("[1, $(x)]", list[int], [1, "$(x)"]),
        ("$(x)", int, "$(x)"),
        ("[1, 2]", None, [1, 2]),
    ],
)
def test_attributes(value, data_type, expected):
    root, _ = load(f"launch: {{v: {value}}}")
    found = root.get_attr("v", data_type=data_type)
    assert found == expected
    assert type(found) is type(expected) or isinstance(found, list)
    root.assert_entity_completely_parsed()


@pytest.mark.parametrize(
    ("value", "data_type"), [("asd", int), ("1", str), ("1", bool), ("[1, a]", list[int]), ("{a: 1}", None)]
)
def test_attributes_of_wrong_types(value, data_type):
    root, _ = load(f"launch: {{v: {value}}}")
    with pytest.raises(TypeError, match="`v` of `launch` is expected to be of type"):
        root.get_attr("v", data_type=data_type, can_be_str=False)


def test_missing_attributes_and_children():
    root, _ = load("launch: {a: 1, b: [{c: 1}], d: [1]}")
    with pytest.raises(AttributeError, match="`v` is missing in `launch`"):
        root.get_attr("v")
    with pytest.raises(ValueError, match="to have children"):
        root.children  # noqa: B018
    [b] = root.get_attr("b", data_type=list[BaseEntity])
    assert b.get_attr("c", data_type=int) == 1
    with pytest.raises(TypeError, match="list of mappings"):
        root.get_attr("d", data_type=list[BaseEntity])
    with pytest.raises(TypeError, match="to be a list"):
        Entity({"children": 5}, "x").children  # noqa: B018
    with pytest.raises(RuntimeError, match="only one key"):
        Entity([{"a": 1, "b": 2}], "x").children  # noqa: B018


def test_what_nobody_reads():
    root, _ = load("launch: {v: 1, w: 2}")
    root.get_attr("v", data_type=int)
    with pytest.raises(ValueError, match=r"key\(s\) found in `launch`: w"):
        root.assert_entity_completely_parsed()
    with pytest.raises(ValueError, match="nested"):
        Entity([{"a": {}}], "x").assert_entity_completely_parsed()
    with pytest.raises(ValueError, match="mapping or a list"):
        Entity(5, "x").assert_entity_completely_parsed()


def test_files(tmp_path):
    path = tmp_path / "a.launch.yaml"
    path.write_text("# grün\nlaunch: []\n", encoding="utf-8")
    root, parser = Parser.load(str(path))
    assert isinstance(parser, Parser)
    assert root.children == []
    source = YAMLLaunchDescriptionSource(str(path))
    assert source.method == "interpreted YAML launch file"
    assert source.get_launch_description(LaunchContext()).entities == []


@pytest.mark.parametrize("text", ["", "5", "- a", "a: 1\nb: 2", "launch: [", "launch: {a: 1, a: [}"])
def test_malformed_files(text):
    with pytest.raises(LaunchFileError):
        Parser.load(io.StringIO(text))


def test_anchors_and_merges(run_text, capsys):
    run_text(
        """
        launch:
        - log: &first {message: one, level: WARNING}
        - log:
            <<: *first
            message: two
        """
    )
    assert re.findall(r"\[(\w+)\] \[launch.user\]: (.*)", capsys.readouterr().out) == [
        ("WARNING", "one"),
        ("WARNING", "two"),
    ]


def test_variables_scopes_and_conditions(run_text, capsys):
    run_text(
        """
        launch:
        - arg:
            name: a
            default: 'asd'
            description: something
            choice: [{value: 'asd'}, {value: 'bsd'}]
        - let: {name: b, value: $(var a)x}
        - group:
          - let: {name: b, value: inner}
          - log: {message: 1 $(var b)}
        - log: {message: 2 $(var b)}
        - group:
            scoped: false
            children:
            - let: {name: b, value: leaked}
        - log: {message: 3 $(var b)}
        - group:
            forwarding: false
            keep: [{name: c, value: $(var b)}]
            children:
            - log: {message: 4 $(var b gone) $(var c)}
        - log: {message: never, if: 'false'}
        - log: {message: '5', unless: $(not true)}
        - reset: {keep: [{name: d, value: $(var b)}]}
        - log: {message: 6 $(var b gone) $(var d)}
        - set_env: {name: LT_A, value: x}
        - append_env: {name: LT_A, value: y, prepend: true, separator: '+'}
        - log: {message: 7 $(env LT_A)}
        - unset_env: {name: LT_A}
        - reset_env: {}
        - log: {message: 8 $(env LT_A gone)}
        """
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == ["1 inner", "2 asdx", "3 leaked", "4 gone leaked", "5", "6 gone leaked", "7 y+x", "8 gone"]


def test_executable(run_text, capsys, tmp_path):
    run_text(
        f"""
        launch:
        - executable:
            cmd: {PYTHON} -c 'import os, sys; print(sys.argv[1:], os.environ["LT_A"], os.getcwd())' a 'b c'
            cwd: {tmp_path}
            name: shower
            output: screen
            shell: false
            env:
            - {{name: LT_A, value: x}}
        """
    )
    assert re.search(rf"\[shower-\d+\] \['a', 'b c'\] x {tmp_path}\n", capsys.readouterr().out)


def test_executable_attributes():
    action = first_action(
        """
        launch:
        - executable:
            cmd: ls -l
            launch-prefix: time
            sigkill_timeout: 4
            sigterm_timeout: '7.0'
            respawn: true
            respawn_max_retries: 2
            respawn_delay: 0.5
            shell: true
            emulate_tty: true
            on_exit: shutdown
        """
    )
    context = LaunchContext()
    assert isinstance(action, ExecuteProcess)
    assert [perform_substitutions(context, word) for word in action.cmd] == ["ls", "-l"]
    assert action.shell is True
    assert action.emulate_tty is True
    assert perform_substitutions(context, action.sigterm_timeout) == "7.0"
    assert perform_substitutions(context, action.sigkill_timeout) == "4.0"
    assert isinstance(action.get_sub_entities()[0], Shutdown)


def test_includes_timers_and_loops(run_text, capsys, tmp_path):
    (tmp_path / "inner.launch.yaml").write_text(
        "launch:\n- arg: {name: a}\n- log: {message: in $(var a) $(dirname)}\n", encoding="utf-8"
    )
    run_text(
        f"""
        launch:
        - include:
            file: {tmp_path}/inner.launch.yaml
            arg: [{{name: a, value: '1'}}]
        - include:
            file: {tmp_path}/inner.launch.yaml
            let: [{{name: a, value: '2'}}]
        - timer:
            period: 0.01
            children:
            - log: {{message: timer}}
        - for_each:
            values: "{{name: a}};{{name: b}}"
            children:
            - log: {{message: $(for-var name)}}
        - for:
            len: '2'
            name: i
            children:
            - log: {{message: $(index i)}}
        - shutdown: {{reason: enough, if: 'false'}}
        """
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == [f"in 1 {tmp_path}", f"in 2 {tmp_path}", "a", "b", "0", "1", "timer"]
    timer = first_action("launch:\n- timer: {period: 5, children: [log: {message: x}]}\n")
    assert isinstance(timer, TimerAction)
    assert timer.period == 5.0
