"""Launch descriptions, entities, and the sources they come from."""

import pytest
from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity, LaunchDescriptionSource
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    ResetLaunchConfigurations,
)
from launch.conditions import IfCondition
from launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    InvalidPythonLaunchFileError,
    PythonLaunchDescriptionSource,
)
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir


def test_entity_defaults():
    entity = LaunchDescriptionEntity()
    with pytest.raises(NotImplementedError, match="LaunchDescriptionEntity does not describe itself"):
        entity.describe()
    assert entity.describe_sub_entities() == []
    assert entity.describe_conditional_sub_entities() == []
    assert entity.visit(LaunchContext()) is None
    assert entity.get_asyncio_future() is None


def test_entities_are_yielded_in_order():
    first, second, third = (LogInfo(msg=str(number)) for number in range(3))
    description = LaunchDescription([first])
    description.add_entity(second)
    description.add_action(third)
    assert description.entities == [first, second, third]
    assert description.describe_sub_entities() == [first, second, third]
    assert description.visit(LaunchContext()) == [first, second, third]


def test_deprecation_is_said(capsys):
    assert not LaunchDescription().deprecated
    description = LaunchDescription(deprecated_reason="use another")
    assert description.deprecated
    description.visit(LaunchContext())
    assert "use another" in capsys.readouterr().out


def test_arguments_are_found_once_wherever_they_are_declared():
    inner = LaunchDescription([DeclareLaunchArgument("inner"), DeclareLaunchArgument("outer", description="again")])
    include = IncludeLaunchDescription(LaunchDescriptionSource(inner))
    description = LaunchDescription(
        [
            DeclareLaunchArgument("outer", description="first"),
            GroupAction([DeclareLaunchArgument("grouped")]),
            include,
            GroupAction([DeclareLaunchArgument("conditional")], condition=IfCondition("true")),
            DeclareLaunchArgument("itself", condition=IfCondition("false")),
        ]
    )
    arguments = description.get_launch_arguments()
    assert [argument.name for argument in arguments] == ["outer", "grouped", "inner", "conditional", "itself"]
    assert arguments[0].description == "first"
    conditional = {argument.name: argument._conditionally_included for argument in arguments}
    assert conditional == {
        "outer": False,
        "grouped": False,
        "inner": False,
        "conditional": True,
        "itself": True,
    }
    with_includes = {
        argument.name: includes
        for argument, includes in description.get_launch_arguments_with_include_launch_description_actions()
    }
    assert with_includes["outer"] == []
    assert with_includes["inner"] == [include]


def test_arguments_after_a_reset_can_not_be_set_from_outside():
    description = LaunchDescription(
        [DeclareLaunchArgument("before"), ResetLaunchConfigurations(), DeclareLaunchArgument("after")]
    )
    assert [argument.name for argument in description.get_launch_arguments()] == ["before"]


def test_source_of_a_description_at_hand():
    description = LaunchDescription()
    source = LaunchDescriptionSource(description, "somewhere", "by hand")
    assert source.try_get_launch_description_without_context() is description
    assert source.get_launch_description(LaunchContext()) is description
    assert source.location == "somewhere"
    assert source.method == "by hand"


def test_source_that_depends_on_the_launch_is_not_there_before():
    source = PythonLaunchDescriptionSource([LaunchConfiguration("nowhere"), "/x.launch.py"])
    assert source.try_get_launch_description_without_context() is None
    assert "launch.substitutions.launch_configuration.LaunchConfiguration" in source.location


def write(path, text):
    path.write_text(text)
    return str(path)


PYTHON = """
from launch import LaunchDescription
from launch.actions import LogInfo
def generate_launch_description():
    return LaunchDescription([LogInfo(msg='from python')])
"""


@pytest.mark.parametrize("name", ["a.launch.py", "a_launch.py", "no_extension"])
def test_python_files(tmp_path, name):
    path = write(tmp_path / name, PYTHON)
    description = AnyLaunchDescriptionSource(path).get_launch_description(LaunchContext())
    assert len(description.entities) == 1
    assert sorted(entry.name for entry in tmp_path.iterdir() if entry.name != "log") == [name]


def test_markup_files(tmp_path):
    for name, text in (
        ("a.launch.xml", "<launch><log message='x'/></launch>"),
        ("b.launch", "<launch><log message='x'/></launch>"),
        ("c.xml", "<launch><log message='x'/></launch>"),
        ("d.launch.yaml", "launch:\n- log: {message: x}\n"),
        ("e.yml", "launch:\n- log: {message: x}\n"),
        ("unknown.foo", "launch:\n- log: {message: x}\n"),
    ):
        source = AnyLaunchDescriptionSource(write(tmp_path / name, text))
        assert isinstance(source.get_launch_description(LaunchContext()).entities[0], LogInfo), name


def test_python_file_without_the_function(tmp_path):
    path = write(tmp_path / "a.launch.py", "x = 1\n")
    with pytest.raises(InvalidPythonLaunchFileError, match="generate_launch_description"):
        PythonLaunchDescriptionSource(path).get_launch_description(LaunchContext())


def test_python_file_that_returns_nothing(tmp_path):
    path = write(tmp_path / "a.launch.py", "def generate_launch_description(): pass\n")
    with pytest.raises(InvalidPythonLaunchFileError, match="returned nothing"):
        PythonLaunchDescriptionSource(path).get_launch_description(LaunchContext())


def test_python_errors_keep_their_type(tmp_path):
    path = write(tmp_path / "a.launch.py", "def generate_launch_description(:\n")
    with pytest.raises(SyntaxError):
        AnyLaunchDescriptionSource(path).get_launch_description(LaunchContext())
    path = write(tmp_path / "b.launch.py", "def generate_launch_description(): raise ValueError('oops')\n")
    with pytest.raises(ValueError, match="oops"):
        AnyLaunchDescriptionSource(path).get_launch_description(LaunchContext())


def test_missing_file():
    with pytest.raises(FileNotFoundError, match=r"nowhere\.launch\.py"):
        AnyLaunchDescriptionSource("nowhere.launch.py").get_launch_description(LaunchContext())


def test_relative_include_is_found_beside_the_including_file(tmp_path, run_launch, capsys):
    folder = tmp_path / "package" / "launch"
    folder.mkdir(parents=True)
    write(folder / "inner.launch.py", PYTHON)
    outer = write(folder / "outer.launch.xml", "<launch><include file='inner.launch.py'/></launch>")
    run_launch(IncludeLaunchDescription(outer))
    assert "from python" in capsys.readouterr().out


def test_an_include_leaves_the_location_of_its_own_file_as_it_was(tmp_path, run_launch, capsys):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    inner = write(tmp_path / "two" / "inner.launch.xml", "<launch><log message='in=$(dirname)'/></launch>")
    outer = write(
        tmp_path / "one" / "outer.launch.xml",
        f"<launch><include file='{inner}'/><log message='out=$(dirname)'/></launch>",
    )
    service = run_launch(IncludeLaunchDescription(outer))
    printed = capsys.readouterr().out
    assert f"in={tmp_path / 'two'}" in printed
    assert f"out={tmp_path / 'one'}" in printed
    with pytest.raises(RuntimeError):
        ThisLaunchFileDir().perform(service.context)
