"""Launch files in XML."""

import io
import os
import re
import sys
import textwrap

import pytest
from launch import LaunchContext
from launch.actions import ExecuteProcess, Shutdown, TimerAction
from launch.frontend import Entity as BaseEntity
from launch.frontend import Parser as AnyParser
from launch.launch_file_error import LaunchFileError
from launch.utilities import perform_substitutions
from launch_xml import Entity, Parser
from launch_xml.launch_description_sources import XMLLaunchDescriptionSource

PYTHON = sys.executable


def load(text):
    root, parser = Parser.load(io.StringIO(textwrap.dedent(text)))
    return root, parser


def first_action(text):
    root, parser = load(f"<launch>{text}</launch>")
    return parser.parse_description(root).entities[0]


# Elements ---------------------------------------------------------------------------------------------


def test_elements():
    root, _ = load("<launch>\n  <a x='1'>\n    <b/>\n    <c/>\n    <b/>\n  </a>\n</launch>")
    assert root.type_name == "launch"
    assert root.parent is None
    [a] = root.children
    assert (a.type_name, a.parent, a.location) == ("a", root, (None, 2))
    assert [child.type_name for child in a.children] == ["b", "c", "b"]
    found = a.get_attr("b", data_type=list[BaseEntity])
    assert [entity.location[1] for entity in found] == [3, 5]


@pytest.mark.parametrize(
    ("attributes", "data_type", "value"),
    [
        ("v='asd'", str, "asd"),
        ("v='1'", str, "1"),
        ("v='1'", int, 1),
        ("v='1'", float, 1.0),
        ("v='1.5'", float, 1.5),
        ("v='true'", bool, True),
        ("v='off'", bool, False),
        ("v='1'", None, 1),
        ("v='asd'", None, "asd"),
        ("v='1,2,3' v-sep=','", list[int], [1, 2, 3]),
        ("v='1;2.5' v-sep=';'", list[float], [1.0, 2.5]),
        ("v='a, b' v-sep=', '", list[str], ["a", "b"]),
        ("v='true no' v-sep=' '", list[bool], [True, False]),
        ("v='1,2' v-sep=','", None, [1, 2]),
        ("v='1' v-sep=','", list[int], [1]),
        ("v='[1, 2]'", list[int], [1, 2]),
        ("v='$(x)'", int, "$(x)"),
        ("v='1,$(x)' v-sep=','", list[int], [1, "$(x)"]),
        ("v=''", str, ""),
    ],
)
def test_attributes(attributes, data_type, value):
    root, _ = load(f"<launch {attributes}/>")
    assert root.get_attr("v", data_type=data_type) == value
    root.assert_entity_completely_parsed()


@pytest.mark.parametrize(
    ("attributes", "data_type"),
    [("v='asd'", int), ("v='2'", bool), ("v='1,a' v-sep=','", list[int]), ("v='1'", list[int])],
)
def test_attributes_of_wrong_types(attributes, data_type):
    root, _ = load(f"<launch {attributes}/>")
    with pytest.raises(TypeError, match="`v` of `launch` is expected to be of type"):
        root.get_attr("v", data_type=data_type, can_be_str=False)


def test_missing_attributes():
    root, _ = load("<launch><a/></launch>")
    assert root.get_attr("v", optional=True) is None
    assert root.get_attr("b", data_type=list[BaseEntity], optional=True) is None
    with pytest.raises(AttributeError, match="attribute `v` is missing in `launch`"):
        root.get_attr("v")
    with pytest.raises(AttributeError, match="nested entity `b` is missing"):
        root.get_attr("b", data_type=list[BaseEntity])


def test_what_nobody_reads():
    root, _ = load("<launch v='1' w='2'><a/><b/></launch>")
    root.get_attr("v")
    with pytest.raises(ValueError, match=r"attribute\(s\) found in `launch`: w"):
        root.assert_entity_completely_parsed()
    root.get_attr("w")
    root.get_attr("a", data_type=list[BaseEntity])
    with pytest.raises(ValueError, match=r"entity\(ies\) found in `launch`: b"):
        root.assert_entity_completely_parsed()
    assert len(root.children) == 2
    root.assert_entity_completely_parsed()


def test_elements_of_the_standard_library():
    import xml.etree.ElementTree as ET

    entity = Entity(ET.fromstring("<a x='1'><b/></a>"))
    assert entity.get_attr("x", data_type=int) == 1
    assert entity.location == (None, None)


def test_files(tmp_path):
    path = tmp_path / "a.launch.xml"
    path.write_text("<?xml version='1.0' encoding='UTF-8'?>\n<!-- grün -->\n<launch/>", encoding="utf-8")
    root, parser = Parser.load(str(path))
    assert isinstance(parser, Parser)
    assert root.location == (str(path), 3)
    source = XMLLaunchDescriptionSource(str(path))
    assert source.method == "interpreted XML launch file"
    assert source.get_launch_description(LaunchContext()).entities == []
    assert Parser.get_file_extensions() >= {"launch.xml", "xml"}


def test_malformed_files():
    with pytest.raises(LaunchFileError, match="line 2: malformed XML: not well-formed"):
        Parser.load(io.StringIO("<launch>\n<a &/></launch>"))


# Actions ----------------------------------------------------------------------------------------------


def test_arguments(run_text, capsys):
    service = run_text(
        r"""
        <launch>
            <arg name="my_\$name" default="asd" description="something \$important">
                <choice value="asd"/>
                <choice value="bsd"/>
            </arg>
            <arg name="passed"/>
            <log message="$(var my_\$name) $(var passed)"/>
        </launch>
        """,
        passed="given",
    )
    assert service.context.launch_configurations["my_$name"] == "asd"
    assert "asd given" in capsys.readouterr().out
    argument = first_action('<arg name="a" default="b" description="c"/>')
    assert (argument.name, argument.description) == ("a", "c")


def test_let_and_scopes(run_text, capsys):
    run_text(
        """
        <launch>
            <let name="a" value="outer"/>
            <let name="kept" value="k"/>
            <group>
                <let name="a" value="inner"/>
                <log message="1 $(var a)"/>
            </group>
            <log message="2 $(var a)"/>
            <group scoped="false"><let name="a" value="leaked"/></group>
            <log message="3 $(var a)"/>
            <group forwarding="false">
                <keep name="kept" value="$(var kept)"/>
                <log message="4 $(var a gone) $(var kept)"/>
            </group>
            <group if="$(equals $(var a) other)"><log message="never"/></group>
            <reset><keep name="b" value="$(var a)"/></reset>
            <log message="5 $(var a gone) $(var b)"/>
            <unlet name="b"/>
            <log message="6 $(var b gone)"/>
        </launch>
        """
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == ["1 inner", "2 outer", "3 leaked", "4 gone k", "5 gone leaked", "6 gone"]


def test_environment(run_text, capsys):
    os.environ["LT_PATH"] = "p"
    run_text(
        """
        <launch>
            <set_env name="LT_A" value="a"/>
            <append_env name="LT_PATH" value="q" separator=":"/>
            <append_env name="LT_PATH" value="o" prepend="true" separator=":"/>
            <append_env name="LT_PATH" value="r" prepend="$(eval '1 == 2')" separator="|"/>
            <log message="1 $(env LT_A) $(env LT_PATH)"/>
            <unset_env name="LT_A"/>
            <log message="2 $(env LT_A gone)"/>
            <reset_env/>
            <log message="3 $(env LT_PATH)"/>
        </launch>
        """
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == ["1 a o:p:q|r", "2 gone", "3 p"]


def test_executable(run_text, capsys, tmp_path):
    run_text(
        f"""
        <launch>
            <let name="word" value="two words"/>
            <let name="program" value="import os, sys; print(sys.argv[1:], os.environ['LT_A'], os.getcwd())"/>
            <executable cmd="{PYTHON} -c $(var program) a $(var word) 'b c'"
                cwd="{tmp_path}" name="shower" output="screen" shell="false" emulate_tty="false">
                <env name="LT_A" value="$(var word)!"/>
            </executable>
        </launch>
        """
    )
    printed = capsys.readouterr().out
    assert re.search(rf"\[shower-\d+\] \['a', 'two words', 'b c'\] two words! {tmp_path}\n", printed)


def test_executable_attributes():
    action = first_action(
        '<executable cmd="ls" output="log" launch-prefix="time" sigkill_timeout="4.0" sigterm_timeout="7.0" '
        'respawn="true" respawn_max_retries="2" respawn_delay="0.5" shell="true" emulate_tty="true" '
        'on_exit="shutdown" log_cmd="true" name="n"/>'
    )
    context = LaunchContext()
    assert isinstance(action, ExecuteProcess)
    assert action.shell is True
    assert action.emulate_tty is True
    assert perform_substitutions(context, action.sigkill_timeout) == "4.0"
    assert perform_substitutions(context, action.sigterm_timeout) == "7.0"
    assert perform_substitutions(context, action.process_description.prefix) == "time"
    assert perform_substitutions(context, action.output) == "log"
    assert isinstance(action.get_sub_entities()[0], Shutdown)


@pytest.mark.parametrize(
    ("cmd", "words"),
    [
        ("ls -l /tmp", ["ls", "-l", "/tmp"]),
        ("  a   b ", ["a", "b"]),
        ("a 'b c' &quot;d e&quot;", ["a", "b c", "d e"]),
        ("a$(var x)b c", ["aX Yb", "c"]),
        ("$(var x)", ["X Y"]),
        ("a '$(var x) c'd", ["a", "X Y cd"]),
        ("a ''", ["a", ""]),
        (r"a\\ b", ["a b"]),
        (r"'a\\b' &quot;c\\d\\&quot;&quot;", [r"a\b", r'c\d"']),
        ("--x:=$(var x) y", ["--x:=X Y", "y"]),
    ],
)
def test_command_lines(cmd, words):
    action = first_action(f'<executable cmd="{cmd}"/>')
    context = LaunchContext()
    context.launch_configurations["x"] = "X Y"
    assert [perform_substitutions(context, word) for word in action.cmd] == words


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('<executable cmd="ls" on_exit="dance"/>', "expected 'shutdown'"),
        ('<executable cmd="ls \'a"/>', "No closing quotation"),
        ('<executable cmd="ls" shell="perhaps"/>', "`shell` of `executable` is expected to be of type bool"),
        ('<executable cmd="ls" colour="red"/>', "colour"),
        ('<executable cmd="ls"><dev name="a" value="b"/></executable>', "dev"),
        ('<executable cmd="ls"><env name="a"/></executable>', "`value` is missing in `env`"),
        ('<executable cmd="ls"><env name="a" value="b" extra="c"/></executable>', "extra"),
    ],
)
def test_mistakes_in_executables(text, error):
    with pytest.raises((ValueError, TypeError, AttributeError), match=error):
        first_action(text)


def test_includes(run_text, capsys, tmp_path):
    (tmp_path / "inner.launch.xml").write_text(
        "<launch><arg name='a'/><arg name='b' default='d'/><log message='$(var a) $(var b) $(dirname)'/></launch>"
    )
    run_text(
        f"""
        <launch>
            <let name="x" value="1"/>
            <include file="{tmp_path}/inner.launch.xml"><arg name="a" value="$(var x)2"/></include>
            <group><include file="{tmp_path}/inner.launch.xml">
                <let name="a" value="3"/><let name="b" value="4"/>
            </include></group>
            <include file="{tmp_path}/nowhere.launch.xml" if="false"/>
        </launch>
        """
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == [f"12 d {tmp_path}", f"3 4 {tmp_path}"]


def test_timers():
    action = first_action('<timer period="5"><log message="x"/><log message="y"/></timer>')
    assert isinstance(action, TimerAction)
    assert action.period == 5.0
    assert len(action.actions) == 2
    action = first_action('<timer period="$(var p)" cancel_on_shutdown="false"><log message="x"/></timer>')
    context = LaunchContext()
    context.launch_configurations["p"] = "2.5"
    assert perform_substitutions(context, action.period) == "2.5"


def test_timers_run(run_text, capsys):
    run_text('<launch><timer period="0.01"><log message="x"/></timer></launch>')
    assert "launch.user]: x" in capsys.readouterr().out


def test_logging(run_text, capsys):
    run_text(
        """
        <launch>
            <log message="a"/><log message="b" level="WARNING"/><log message="c" level="$(var level)"/>
            <log_info message="d"/><log_warning message="e"/><log_error message="f"/><log_debug message="g"/>
        </launch>
        """,
        level="error",
    )
    lines = re.findall(r"\[(\w+)\] \[launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == [
        ("INFO", "a"),
        ("WARNING", "b"),
        ("ERROR", "c"),
        ("INFO", "d"),
        ("WARNING", "e"),
        ("ERROR", "f"),
    ]


def test_shutdown(run_text):
    run_text('<launch><timer period="1000"><log message="x"/></timer><shutdown reason="enough"/></launch>')
    assert first_action('<shutdown reason="a \\$(b)"/>').event.reason == "a $(b)"


def test_loops(run_text, capsys):
    run_text(
        """
        <launch>
            <for_each values="{name: a, id: 1};{name: b}" if="true">
                <group><let name="x" value="$(for-var name)"/><log message="$(var x) $(for-var id 'none')"/></group>
            </for_each>
            <for len="$(var n)" name="i">
                <for len="2" name="j"><log message="$(index i)$(index j)"/></for>
            </for>
            <for_each values=""><log message="never"/></for_each>
        </launch>
        """,
        n="2",
    )
    lines = re.findall(r"launch.user\]: (.*)", capsys.readouterr().out)
    assert lines == ["a 1", "b none", "00", "01", "10", "11"]


def test_processes_in_loops(run_text, capsys):
    cmd = f"{PYTHON} -c 'print(7$(index i))'"
    run_text(f'<launch><for len="3" name="i"><executable cmd="{cmd}" output="screen"/></for></launch>')
    assert sorted(re.findall(r"\] (7\d)\n", capsys.readouterr().out)) == ["70", "71", "72"]


def test_conditions(run_text, capsys):
    run_text(
        """
        <launch>
            <log message="a" if="true"/><log message="b" if="0"/>
            <log message="c" unless="$(not true)"/><log message="d" unless="True"/>
        </launch>
        """
    )
    assert re.findall(r"launch.user\]: (.*)", capsys.readouterr().out) == ["a", "c"]


def test_any_parser_reads_it():
    root, parser = AnyParser.load(io.StringIO("<launch/>"))
    assert isinstance(root, Entity)
    assert isinstance(parser, Parser)


def test_a_file_can_be_deprecated():
    root, parser = Parser.load(io.StringIO("<launch deprecated='use another'/>"))
    assert parser.parse_description(root).deprecated_reason == "use another"
