"""Launch descriptions as trees of text."""

from launch import LaunchDescription, LaunchDescriptionSource, LaunchIntrospector
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    RegisterEventHandler,
    TimerAction,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.launch_introspector import format_substitutions, indent, tree_like_indent
from launch.substitutions import LaunchConfiguration


def test_indentation():
    assert indent(["a", "b"]) == ["    a", "    b"]
    assert tree_like_indent(["a", "    inner", "b"]) == ["├── a", "│       inner", "└── b"]
    assert tree_like_indent([]) == []


def test_texts():
    assert format_substitutions(["a", LaunchConfiguration("b")]) == "'a' + LaunchConfig('b')"


def test_everything_is_shown():
    process = ExecuteProcess(cmd=["ls", LaunchConfiguration("x")], cwd="/tmp", env={"A": "1"})
    description = LaunchDescription(
        [
            process,
            GroupAction([LogInfo(msg="grouped")], condition=IfCondition("true")),
            IncludeLaunchDescription(LaunchDescriptionSource(LaunchDescription([LogInfo(msg="included")]))),
            TimerAction(period=3.0, actions=[EmitEvent(event=Shutdown())]),
            RegisterEventHandler(OnProcessExit(target_action=process, on_exit=[LogInfo(msg="handled")])),
        ]
    )
    text = LaunchIntrospector().format_launch_description(description)
    for part in (
        "LaunchDescription",
        "ExecuteProcess(cmd=['ls', LaunchConfig('x')], cwd='/tmp', env={'A': '1'}, shell=False)",
        "LogInfo('grouped')",
        "Conditionally included by",
        "LogInfo('included')",
        "after 3.0 sec",
        "EmitEvent(event='launch.events.Shutdown')",
        "OnProcessExit(",
        "LogInfo('handled')",
    ):
        assert part in text
