"""Mistakes in launch files: one line that names file and line."""

import pytest
from launch import LaunchDescription, LaunchFileError, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.invalid_launch_file_error import InvalidLaunchFileError

HEAD = """from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
def generate_launch_description():
"""


def run(path):
    service = LaunchService()
    service.include_launch_description(LaunchDescription([IncludeLaunchDescription(str(path))]))
    assert service.run() == 1
    return service.error


@pytest.mark.parametrize(
    ("body", "line", "reason"),
    [
        ("    return LaunchDescription([\n        1 / 0])", 6, "ZeroDivisionError: division by zero"),
        ("    return undefined", 5, "NameError: name 'undefined' is not defined"),
        ("    return LaunchDescription(\n", 5, "SyntaxError: '(' was never closed"),
        ("    import no_such_module", 5, "ModuleNotFoundError: No module named 'no_such_module'"),
        ("    pass", None, "returned nothing"),
        (
            "    return LaunchDescription([\n        LogInfo(msg='x'),\n"
            "        LogInfo(msg=LaunchConfiguration('nope'))])",
            7,
            "launch configuration 'nope' does not exist",
        ),
        (
            "    return LaunchDescription([GroupAction([\n        LogInfo(msg=PythonExpression('1 +'))])])",
            6,
            "(in the Python expression: 1 +)",
        ),
        ("    return LaunchDescription([\n\n    DeclareLaunchArgument('needed')])", 7, "'needed'"),
        ("    return LaunchDescription([DeclareLaunchArgument('a', choices=['b'], default_value='c')])", 5, "choices"),
        (
            "    def f(context):\n        return {}['key']\n    return LaunchDescription([OpaqueFunction(function=f)])",
            6,
            "KeyError: key",
        ),
        (
            "    return LaunchDescription([IncludeLaunchDescription('not/there.launch.py')])",
            5,
            "the launch file 'not/there.launch.py' does not exist",
        ),
        ("    return LaunchDescription([LogInfo(text='x')])", 5, "TypeError"),
    ],
)
def test_python(tmp_path, capsys, body, line, reason):
    path = tmp_path / "a.launch.py"
    path.write_text(HEAD + body)
    error = run(path)
    assert (error.file, error.line) == (str(path), line)
    assert reason in error.reason
    place = f"{path}:{line}: " if line else f"{path}: "
    errors = [text for text in capsys.readouterr().out.splitlines() if text.startswith("[ERROR]")]
    assert len(errors) == 1
    assert f"{place}{error.reason}" in errors[0]


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("<launch>\n<log message='x'>\n</launch>", 3, "malformed XML: mismatched tag at column"),
        (
            "<launch>\n\n  <nod pkg='a' exec='b'/>\n</launch>",
            3,
            "Unrecognized entity of the type: nod; did you mean 'node'?",
        ),
        ("<launch>\n  <log massage='x'/>\n</launch>", 2, "`message` is missing in `log`"),
        ("<launch>\n  <log message='x' extra='y'/>\n</launch>", 2, "Unexpected attribute(s) found in `log`: extra"),
        ("<launch>\n  <let name='a' value='1'>\n <foo/></let>\n</launch>", 2, "nested entity(ies) found in `let`: foo"),
        ("<launch>\n <group>\n  <log message='$(vra x)'/>\n </group></launch>", 3, "Unknown substitution: vra"),
        ("<launch>\n <log message='$(var x'/></launch>", 2, "the ')' that ends '$(var' is missing"),
        ("<launch>\n <log message='$(var x y z)'/></launch>", 2, "takes 1 to 2 arguments, but it was given 3"),
        ("<launch>\n <log message='$(var x)'/></launch>", 2, "launch configuration 'x' does not exist"),
        ("<launch>\n <log message='x' if='maybe'/></launch>", 2, "invalid condition expression 'maybe'"),
        ("<launch>\n <log message='x' if='1' unless='0'/></launch>", 2, "if and unless"),
        ("<launch>\n <timer period='soon'><log message='x'/></timer></launch>", 2, "'soon' to float"),
        ("<launch>\n <arg name='needed'/></launch>", 2, "'needed'"),
        ("<launch>\n <include file='nowhere.xml'/></launch>", 2, "'nowhere.xml' does not exist"),
        ("<lunch/>", 1, "Expected 'launch' as root element, got 'lunch'"),
        ("", 1, "no element found"),
    ],
)
def test_xml(tmp_path, text, line, reason):
    path = tmp_path / "a.launch.xml"
    path.write_text(text)
    error = run(path)
    assert (error.file, error.line) == (str(path), line)
    assert reason in error.reason
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("launch:\n- log: {message: x\n", 3, "malformed YAML"),
        ("launch:\n- log:\n    massage: x\n", 3, "`message` is missing in `log`"),
        ("launch:\n\n- lag: {message: x}\n", 3, "Unrecognized entity of the type: lag"),
        ("launch:\n- log: {message: x, extra: y}\n", 2, "Unexpected key(s) found in `log`: extra"),
        ("launch:\n- log: 5\n", 2, "`message` is missing"),
        ("launch:\n- log: {message: x}\n  let: {name: a}\n", None, "dictionary with only one key"),
        ("launch:\n- log: {message: {a: b}}\n", 2, "expected to be of type str"),
        ("foo:\n- log: {message: x}\n", 2, "Expected 'launch' as root element"),
        ("- 1\n", None, "Expected one root element"),
        ("launch: [\t]", 1, "malformed YAML"),
    ],
)
def test_yaml(tmp_path, text, line, reason):
    path = tmp_path / "a.launch.yaml"
    path.write_text(text)
    error = run(path)
    assert error.file == str(path)
    if line is not None:
        assert error.line == line
    assert reason in error.reason


def test_the_innermost_file_is_named(tmp_path):
    inner = tmp_path / "inner.launch.py"
    inner.write_text(HEAD + "    raise ValueError('inside')\n")
    middle = tmp_path / "middle.launch.yaml"
    middle.write_text("launch:\n- include: {file: inner.launch.py}\n")
    outer = tmp_path / "outer.launch.xml"
    outer.write_text("<launch>\n<include file='middle.launch.yaml'/></launch>")
    error = run(outer)
    assert (error.file, error.line, error.reason) == (str(inner), 5, "ValueError: inside")


def test_the_error_itself():
    error = LaunchFileError("/a/b.launch.py", 3, "what is wrong")
    assert str(error) == "/a/b.launch.py:3: what is wrong"
    assert isinstance(error, InvalidLaunchFileError)
    assert str(LaunchFileError("/a", None, "x")) == "/a: x"
    assert str(LaunchFileError(None, 3, "x")) == "line 3: x"
    assert str(LaunchFileError(None, None, "x")) == "x"
    assert LaunchFileError.from_exception(error) is error
    assert str(LaunchFileError.from_exception(RuntimeError("many\n  lines"), "/a")) == "/a: many lines"
    assert LaunchFileError.from_exception(RuntimeError()).reason == "RuntimeError"


def test_several_likely_errors():
    error = InvalidLaunchFileError("foo", likely_errors=[ValueError("one"), SyntaxError("two")])
    assert "[foo]" in str(error)
    assert "ValueError: one" in str(error)
    assert "SyntaxError: two" in str(error)
    assert "one" in str(InvalidLaunchFileError("foo", likely_errors=[ValueError("one")]))
    assert "unknown" in str(InvalidLaunchFileError("foo"))
