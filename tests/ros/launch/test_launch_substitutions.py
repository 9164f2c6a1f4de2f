"""Substitutions, one after another."""

import math
import os
import sys
from pathlib import Path

import pytest
from launch import LaunchContext, Substitution
from launch.logging import launch_config
from launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    ForEachVar,
    ForLoopIndex,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PathSubstitution,
    PythonExpression,
    StringJoinSubstitution,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)


@pytest.fixture
def context():
    return LaunchContext()


def test_base():
    with pytest.raises(NotImplementedError):
        Substitution().perform(None)
    assert "Substitution" in Substitution().describe()


def test_text(context):
    assert TextSubstitution(text="foo").perform(context) == "foo"
    assert TextSubstitution(text="foo").describe() == "'foo'"
    with pytest.raises(TypeError):
        TextSubstitution(text=1)


def test_launch_configuration(context):
    context.launch_configurations["a"] = "1"
    assert LaunchConfiguration("a").perform(context) == "1"
    assert LaunchConfiguration([TextSubstitution(text="a")]).perform(context) == "1"
    assert LaunchConfiguration("b", default="2").perform(context) == "2"
    assert LaunchConfiguration("b", default=3).perform(context) == "3"
    assert LaunchConfiguration("b", default=True).perform(context) == "True"
    assert LaunchConfiguration("b", default=["x", 4, LaunchConfiguration("a")]).perform(context) == "x41"
    with pytest.raises(SubstitutionFailure, match="'b' does not exist"):
        LaunchConfiguration("b").perform(context)


def test_environment_variable(context):
    os.environ["LAUNCH_TEST"] = "x"
    assert EnvironmentVariable("LAUNCH_TEST").perform(context) == "x"
    assert EnvironmentVariable("LAUNCH_TEST_NOT", default_value=["a", "b"]).perform(context) == "ab"
    assert EnvironmentVariable("LAUNCH_TEST_NOT", default_value="").perform(context) == ""
    with pytest.raises(SubstitutionFailure, match="LAUNCH_TEST_NOT"):
        EnvironmentVariable("LAUNCH_TEST_NOT").perform(context)


def test_find_executable(context, tmp_path):
    program = tmp_path / "some-program"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    os.environ["PATH"] = str(tmp_path)
    assert FindExecutable(name="some-program").perform(context) == str(program)
    with pytest.raises(SubstitutionFailure, match="no-such-program"):
        FindExecutable(name="no-such-program").perform(context)


def test_programs_beside_the_interpreter_are_found_without_a_path(context):
    os.environ["PATH"] = ""
    found = FindExecutable(name=os.path.basename(sys.executable)).perform(context)
    assert os.path.dirname(found) == os.path.dirname(sys.executable)


def test_path_join(context):
    context.launch_configurations["map"] = "kitchen"
    path = PathJoinSubstitution(["a", Path("b"), ["map_", LaunchConfiguration("map"), ".yaml"]])
    assert path.perform(context) == os.path.join("a", "b", "map_kitchen.yaml")
    longer = path / "x" / ["y", LaunchConfiguration("map")]
    assert longer.perform(context) == os.path.join("a", "b", "map_kitchen.yaml", "x", "ykitchen")
    assert len(path.substitutions) == 3
    assert (PathSubstitution("a") / "b").perform(context) == os.path.join("a", "b")


def test_string_join(context):
    joined = StringJoinSubstitution([["https", "://docs"], "ros", "org"], delimiter=".")
    assert joined.perform(context) == "https://docs.ros.org"
    assert StringJoinSubstitution(["a", "b"]).perform(context) == "ab"


def test_python_expression(context):
    context.launch_configurations["n"] = "3"
    assert PythonExpression(["1 + ", LaunchConfiguration("n")]).perform(context) == "4"
    assert PythonExpression("'a' in 'abc'").perform(context) == "True"
    assert PythonExpression("ceil(1.2)").perform(context) == "2"
    assert PythonExpression("math.ceil(1.2)").perform(context) == "2"
    assert PythonExpression("sum(n for n in range(4) if n > floor(1.5))").perform(context) == "5"
    assert PythonExpression("sys.getrefcount is not None", ["sys"]).perform(context) == "True"
    assert PythonExpression("os.path.join('a', 'b')", ["os.path"]).perform(context) == os.path.join("a", "b")
    with pytest.raises(NameError):
        PythonExpression("ceil(1.2)", []).perform(context)
    with pytest.raises(NameError):
        PythonExpression("math.ceil(1.2)", ["sys"]).perform(context)


def test_command(context):
    assert Command([sys.executable, " -c 'print(1 + 1)'"]).perform(context).strip() == "2"


@pytest.mark.parametrize("on_stderr", ["fail", "ignore", "warn", "capture"])
def test_command_that_complains(context, on_stderr, capsys):
    program = "import sys; print('out', flush=True); print('complaint', file=sys.stderr)"
    command = Command([sys.executable, f' -c "{program}"'], on_stderr=on_stderr)
    if on_stderr == "fail":
        with pytest.raises(SubstitutionFailure, match="complaint"):
            command.perform(context)
        return
    output = command.perform(context).split()
    assert output == (["out", "complaint"] if on_stderr == "capture" else ["out"])
    assert ("complaint" in capsys.readouterr().out) == (on_stderr == "warn")


def test_command_that_fails(context):
    with pytest.raises(SubstitutionFailure, match="Exit code: 3"):
        Command(f"{sys.executable} -c 'raise SystemExit(3)'").perform(context)
    with pytest.raises(SubstitutionFailure, match="no-such-program"):
        Command("no-such-program --now").perform(context)
    with pytest.raises(SubstitutionFailure, match="split"):
        Command("echo 'unclosed").perform(context)
    with pytest.raises(SubstitutionFailure, match="on_stderr"):
        Command("echo", on_stderr="whatever").perform(context)


def test_of_a_traceback_that_a_command_prints_the_last_line_is_told(context):
    with pytest.raises(SubstitutionFailure) as caught:
        Command([sys.executable, " -c \"int('one')\""]).perform(context)
    assert "Traceback" not in str(caught.value)
    assert str(caught.value).endswith("ValueError: invalid literal for int() with base 10: 'one'")


def test_a_missing_xacro_file_is_named_in_one_line(context, tmp_path):
    file = tmp_path / "robot.urdf.xacro"
    with pytest.raises(SubstitutionFailure, match=f"error: {file}: no such file$"):
        Command(["xacro ", str(file)]).perform(context)


def test_command_does_not_wait_for_input(context):
    assert Command(f"{sys.executable} -c 'import sys; print(repr(sys.stdin.read()))'").perform(context) == "''\n"


def test_file_content(context, tmp_path):
    (tmp_path / "file").write_text("line\n", encoding="utf-8")
    assert FileContent(str(tmp_path / "file")).perform(context) == "line\n"
    with pytest.raises(SubstitutionFailure, match="nowhere"):
        FileContent("nowhere").perform(context)


def test_local(context):
    class Thing:
        number = 5

        def double(self):
            return 10

    context.extend_locals({"thing": Thing()})
    assert LocalSubstitution("thing.number").perform(context) == "5"
    assert LocalSubstitution("thing.double()").perform(context) == "10"
    assert LocalSubstitution("thing.number", "the number").describe() == "LocalVar('the number')"
    with pytest.raises(SubstitutionFailure, match="other"):
        LocalSubstitution("other").perform(context)


def test_this_launch_file(context):
    for substitution in (ThisLaunchFile(), ThisLaunchFileDir()):
        with pytest.raises(SubstitutionFailure, match="outside of a launch file"):
            substitution.perform(context)
    context.extend_locals({"current_launch_file_path": "/a/b", "current_launch_file_directory": "/a"})
    assert ThisLaunchFile().perform(context) == "/a/b"
    assert ThisLaunchFileDir().perform(context) == "/a"
    assert (ThisLaunchFileDir() / "c").perform(context) == os.path.join("/a", "c")
    assert ThisLaunchFileDir().describe() == "ThisLaunchFileDir()"


def test_launch_log_dir(context):
    assert LaunchLogDir().perform(context) == launch_config.log_dir
    assert (LaunchLogDir() / "x").perform(context) == os.path.join(launch_config.log_dir, "x")


def test_anon_names_are_unique_in_a_launch(context):
    first = AnonName("node").perform(context)
    assert first.startswith("node_")
    assert first.replace("_", "").isalnum()
    assert AnonName("node").perform(context) == first
    assert AnonName("other").perform(context) != first
    assert AnonName("node").perform(LaunchContext()) != first


TRUTHS = [("true", True), ("True", True), ("1", True), ("false", False), ("False", False), ("0", False)]


@pytest.mark.parametrize(("text", "truth"), TRUTHS)
def test_not(context, text, truth):
    assert NotSubstitution(text).perform(context) == str(not truth).lower()


@pytest.mark.parametrize(("left", "left_truth"), TRUTHS)
@pytest.mark.parametrize(("right", "right_truth"), TRUTHS)
def test_pairs(context, left, left_truth, right, right_truth):
    assert AndSubstitution(left, right).perform(context) == str(left_truth and right_truth).lower()
    assert OrSubstitution(left, right).perform(context) == str(left_truth or right_truth).lower()
    assert AllSubstitution(left, right, "true").perform(context) == str(left_truth and right_truth).lower()
    assert AnySubstitution(left, right, "false").perform(context) == str(left_truth or right_truth).lower()


def test_empty_any_and_all(context):
    assert AnySubstitution().perform(context) == "false"
    assert AllSubstitution().perform(context) == "true"


@pytest.mark.parametrize(
    "substitution",
    [
        NotSubstitution("maybe"),
        AndSubstitution("maybe", "true"),
        OrSubstitution("true", "maybe"),
        AnySubstitution("true", "maybe"),
        AllSubstitution("maybe"),
        IfElseSubstitution("maybe", "a", "b"),
    ],
)
def test_what_is_neither_true_nor_false(context, substitution):
    with pytest.raises(SubstitutionFailure, match="neither true nor false"):
        substitution.perform(context)


def test_if_else(context):
    assert IfElseSubstitution("true", "a", "b").perform(context) == "a"
    assert IfElseSubstitution("false", "a", "b").perform(context) == "b"
    assert IfElseSubstitution("false", "a").perform(context) == ""
    assert IfElseSubstitution("true", else_value="b").perform(context) == ""
    with pytest.raises(RuntimeError):
        IfElseSubstitution("true")


@pytest.mark.parametrize(
    ("left", "right", "equal"),
    [
        (None, None, True),
        (None, "", True),
        (None, "something", False),
        (True, True, True),
        (True, False, False),
        (True, "TRUE", True),
        (True, 1, True),
        ("true", "0", False),
        (False, "0", True),
        (True, "10", False),
        (1, 1, True),
        (1, 1.0, True),
        (1, -1, False),
        ("1", 1, True),
        ("1.0", "1", True),
        (0.1 + 0.2, 0.3, True),
        (math.inf, math.inf, True),
        (math.inf, -math.inf, False),
        (math.nan, math.nan, False),
        ("a", "a", True),
        ("a", "A", False),
        ([], [], True),
        (["a", "b"], "ab", True),
        ([1, 2], ["1", "2"], True),
        (PathJoinSubstitution(["a", "b"]), os.path.join("a", "b"), True),
        (PathJoinSubstitution(["a", "b"]), "a", False),
    ],
)
def test_equality(context, left, right, equal):
    for one, other in ((left, right), (right, left)):
        assert EqualsSubstitution(one, other).perform(context) == str(equal).lower()
        assert NotEqualsSubstitution(one, other).perform(context) == str(not equal).lower()


def test_loop_variables(context):
    context.extend_locals({ForEachVar.get_local_arg_name("name"): "robot", ForLoopIndex.get_local_arg_name("i"): 4})
    assert ForEachVar("name").perform(context) == "robot"
    assert ForLoopIndex("i").perform(context) == "4"
    assert ForEachVar("other", default_value="none").perform(context) == "none"
    with pytest.raises(SubstitutionFailure, match="other"):
        ForEachVar("other").perform(context)


@pytest.mark.parametrize(
    "substitution",
    [
        AnonName("x"),
        Command("x"),
        EnvironmentVariable("x"),
        EqualsSubstitution("x", "y"),
        FileContent("x"),
        FindExecutable(name="x"),
        ForEachVar("x"),
        IfElseSubstitution("x", "y"),
        LaunchConfiguration("x"),
        NotSubstitution("x"),
        AndSubstitution("x", "y"),
        AnySubstitution("x", "y"),
        PathJoinSubstitution(["x", "y"]),
        PythonExpression("x"),
        StringJoinSubstitution(["x", "y"]),
    ],
)
def test_descriptions_say_what_is_in_them(substitution):
    assert "'x'" in substitution.describe()
