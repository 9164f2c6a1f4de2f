"""The actions that start no process."""

import os

import pytest
from launch import Action, LaunchContext, LaunchDescription, LaunchDescriptionSource
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ForEach,
    ForLoop,
    GroupAction,
    IncludeLaunchDescription,
    Log,
    LogDebug,
    LogError,
    LogInfo,
    LogWarning,
    OpaqueFunction,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    RegisterEventHandler,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    UnregisterEventHandler,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from launch.conditions import IfCondition
from launch.event import Event
from launch.event_handler import EventHandler
from launch.event_handlers import OnExecutionComplete, OnProcessExit
from launch.events import ExecutionComplete
from launch.events import Shutdown as ShutdownEvent
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, TextSubstitution, ThisLaunchFileDir
from launch.utilities import perform_substitutions, visit_all_entities_and_collect_futures


@pytest.fixture
def context():
    return LaunchContext()


def visit_all(context, *entities):
    visit_all_entities_and_collect_futures(LaunchDescription(list(entities)), context)


def test_action_describes_what_is_in_it():
    class Nest(Action):
        def get_sub_entities(self):
            return [LogInfo(msg="egg")]

    assert len(Nest().describe_sub_entities()) == 1
    assert Nest().describe_conditional_sub_entities() == []
    conditional = Nest(condition=IfCondition("true"))
    assert conditional.describe_sub_entities() == []
    [(text, entities)] = conditional.describe_conditional_sub_entities()
    assert "Conditionally included by" in text
    assert len(list(entities)) == 1


def test_completion_is_announced_to_those_who_wait(context):
    action = OpaqueFunction(function=lambda context: None)
    action.visit(context)
    assert context._event_queue.qsize() == 0
    context.register_event_handler(OnExecutionComplete(target_action=action, on_completion=LogInfo(msg="done")))
    action.visit(context)
    event = context._event_queue.get_nowait()
    assert isinstance(event, ExecutionComplete)
    assert event.action is action


def test_environment_variables(context):
    visit_all(
        context, SetEnvironmentVariable("LT_A", "1"), SetEnvironmentVariable(["LT", "_B"], EnvironmentVariable("LT_A"))
    )
    assert os.environ["LT_A"] == os.environ["LT_B"] == "1"
    visit_all(context, UnsetEnvironmentVariable("LT_A"), UnsetEnvironmentVariable("LT_NEVER"))
    assert "LT_A" not in os.environ


@pytest.mark.parametrize(
    ("kwargs", "expected"),
    [
        ({}, f"old{os.pathsep}new"),
        ({"prepend": True}, f"new{os.pathsep}old"),
        ({"prepend": TextSubstitution(text="true"), "separator": "|"}, "new|old"),
        ({"prepend": LaunchConfiguration("no"), "separator": ""}, "oldnew"),
    ],
)
def test_appending_to_environment_variables(context, kwargs, expected):
    context.launch_configurations["no"] = "false"
    os.environ["LT_A"] = "old"
    visit_all(context, AppendEnvironmentVariable("LT_A", "new", **kwargs))
    assert os.environ["LT_A"] == expected
    visit_all(context, AppendEnvironmentVariable("LT_FRESH", "new", **kwargs))
    assert os.environ["LT_FRESH"] == "new"


def test_launch_configurations(context):
    visit_all(context, SetLaunchConfiguration("a", "1"), SetLaunchConfiguration("b", [LaunchConfiguration("a"), "2"]))
    assert context.launch_configurations == {"a": "1", "b": "12"}
    visit_all(context, UnsetLaunchConfiguration("a"), UnsetLaunchConfiguration("never"))
    assert context.launch_configurations == {"b": "12"}
    visit_all(context, ResetLaunchConfigurations({"c": LaunchConfiguration("b")}))
    assert context.launch_configurations == {"c": "12"}
    visit_all(context, ResetLaunchConfigurations())
    assert context.launch_configurations == {}


def test_scopes(context):
    visit_all(
        context,
        PushLaunchConfigurations(),
        PushEnvironment(),
        SetLaunchConfiguration("a", "1"),
        SetEnvironmentVariable("LT_A", "1"),
    )
    assert context.launch_configurations == {"a": "1"}
    visit_all(context, PopEnvironment(), PopLaunchConfigurations())
    assert context.launch_configurations == {}
    assert "LT_A" not in os.environ
    visit_all(context, SetEnvironmentVariable("LT_A", "1"), ResetEnvironment())
    assert "LT_A" not in os.environ


def test_arguments(context):
    argument = DeclareLaunchArgument("a", default_value=["x", LaunchConfiguration("b", default="y")])
    assert argument.name == "a"
    assert argument.description == "no description given"
    assert argument.choices is None
    argument.visit(context)
    assert context.launch_configurations == {"a": "xy"}
    assert DeclareLaunchArgument("a").default_value is None
    assert perform_substitutions(context, DeclareLaunchArgument("a", default_value="z").default_value) == "z"


def test_passed_arguments_come_before_defaults(context):
    context.launch_configurations["a"] = "passed"
    DeclareLaunchArgument("a", default_value="default").visit(context)
    assert context.launch_configurations["a"] == "passed"


def test_missing_argument(context):
    with pytest.raises(RuntimeError, match=r"'a' \(description: 'what it is'\) was not provided"):
        DeclareLaunchArgument("a", description="what it is").visit(context)


def test_choices(context):
    argument = DeclareLaunchArgument("a", description="which", choices=["x", "y"], default_value="x")
    assert argument.choices == ["x", "y"]
    assert argument.description == "which. Valid choices are: ['x', 'y']"
    argument.visit(context)
    context.launch_configurations["a"] = "z"
    with pytest.raises(RuntimeError, match=r"'a' provided value 'z' is not valid.*\['x', 'y'\]"):
        argument.visit(context)
    with pytest.raises(RuntimeError, match="not in provided choices"):
        DeclareLaunchArgument("a", choices=["x"], default_value="y")
    with pytest.raises(RuntimeError, match="empty"):
        DeclareLaunchArgument("a", choices=[])


def test_events(context):
    event = Event()
    EmitEvent(event=event).visit(context)
    assert context._event_queue.get_nowait() is event
    with pytest.raises(RuntimeError, match="expected an event"):
        EmitEvent(event=None)
    Shutdown(reason="enough").visit(context)
    emitted = context._event_queue.get_nowait()
    assert isinstance(emitted, ShutdownEvent)
    assert emitted.reason == "enough"


def test_event_handlers_come_and_go(context):
    entity = LogInfo(msg="x")
    handler = EventHandler(matcher=lambda event: True, entities=[entity])
    register = RegisterEventHandler(handler)
    assert register.event_handler is handler
    [(text, entities)] = register.describe_conditional_sub_entities()
    assert "EventHandler" in text
    assert list(entities) == [entity]
    register.visit(context)
    assert list(context._event_handlers) == [handler]
    UnregisterEventHandler(handler).visit(context)
    assert list(context._event_handlers) == []
    with pytest.raises(ValueError):  # noqa: PT011 - deque's own words
        UnregisterEventHandler(handler).visit(context)
    callback = RegisterEventHandler(OnProcessExit(on_exit=lambda event, context: None))
    assert callback.describe_conditional_sub_entities() == []


@pytest.mark.parametrize(
    ("action", "line"),
    [
        (LogInfo(msg=["a ", LaunchConfiguration("x", default="b")]), "[INFO] [launch.user]: a b\n"),
        (LogWarning(msg="a"), "[WARNING] [launch.user]: a\n"),
        (LogError(msg="a"), "[ERROR] [launch.user]: a\n"),
        (LogDebug(msg="a"), ""),
        (Log(msg="a", level="error"), "[ERROR] [launch.user]: a\n"),
        (Log(msg="a", level=["WARN", "ING"]), "[WARNING] [launch.user]: a\n"),
    ],
)
def test_logging(context, capsys, action, line):
    action.visit(context)
    assert capsys.readouterr().out == line


def test_unknown_level(context):
    with pytest.raises(KeyError, match="LOUD"):
        Log(msg="a", level="loud").visit(context)


def test_opaque_functions(context):
    seen = []

    def function(given, *args, **kwargs):
        seen.append((given, args, kwargs))
        return [LogInfo(msg="x")]

    entities = OpaqueFunction(function=function, args=[1, 2], kwargs={"a": 3}).visit(context)
    assert seen == [(context, (1, 2), {"a": 3})]
    assert isinstance(entities[0], LogInfo)
    for wrong in ({"function": None}, {"function": print, "args": 1}, {"function": print, "kwargs": [1]}):
        with pytest.raises(TypeError):
            OpaqueFunction(**wrong)


# Groups -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scoped", "forwarding", "types"),
    [
        (
            True,
            True,
            [
                PushLaunchConfigurations,
                PushEnvironment,
                SetLaunchConfiguration,
                LogInfo,
                PopEnvironment,
                PopLaunchConfigurations,
            ],
        ),
        (
            True,
            False,
            [
                PushLaunchConfigurations,
                PushEnvironment,
                ResetEnvironment,
                ResetLaunchConfigurations,
                LogInfo,
                PopEnvironment,
                PopLaunchConfigurations,
            ],
        ),
        (False, True, [SetLaunchConfiguration, LogInfo]),
    ],
)
def test_what_groups_are_made_of(context, scoped, forwarding, types):
    group = GroupAction([LogInfo(msg="x")], scoped=scoped, forwarding=forwarding, launch_configurations={"a": "1"})
    assert [type(entity) for entity in group.visit(context)] == types
    assert group.get_sub_entities() == group.describe_sub_entities()


@pytest.mark.parametrize("scoped", [True, False])
@pytest.mark.parametrize("forwarding", [True, False])
def test_what_groups_see_and_leave(context, scoped, forwarding):
    os.environ["LT_BEFORE"] = "1"
    context = LaunchContext()
    context.launch_configurations["outside"] = "o"
    os.environ["LT_OUTSIDE"] = "o"
    seen = {}

    def look(context):
        seen["configurations"] = dict(context.launch_configurations)
        seen["environment"] = {name for name in os.environ if name.startswith("LT_")}

    visit_all(
        context,
        GroupAction(
            [
                SetLaunchConfiguration("inside", "i"),
                SetEnvironmentVariable("LT_INSIDE", "i"),
                OpaqueFunction(function=look),
            ],
            scoped=scoped,
            forwarding=forwarding,
            launch_configurations={"kept": LaunchConfiguration("outside")},
        ),
    )
    sees_outside = forwarding or not scoped
    assert seen["configurations"] == {
        **({"outside": "o"} if sees_outside else {}),
        "kept": "o",
        "inside": "i",
    }
    assert seen["environment"] == {"LT_BEFORE", "LT_INSIDE"} | ({"LT_OUTSIDE"} if sees_outside else set())
    left = {"outside": "o"} if scoped else seen["configurations"]
    assert context.launch_configurations == left
    assert os.environ["LT_OUTSIDE"] == "o"
    assert ("LT_INSIDE" in os.environ) == (not scoped)


# Includes ---------------------------------------------------------------------------------------------


def test_include(context):
    description = LaunchDescription()
    include = IncludeLaunchDescription(LaunchDescriptionSource(description, "/a/b.launch.py"))
    assert include.describe_sub_entities() == [description]
    assert list(include.launch_arguments) == []
    assert include.visit(context) == [description]
    assert include.describe() == "IncludeLaunchDescription(/a/b.launch.py)"
    assert ThisLaunchFileDir().perform(context) == "/a"
    include._leave(context)
    assert "current_launch_file_path" not in context.get_locals_as_dict()


def test_include_passes_arguments(context):
    context.launch_configurations["x"] = "1"
    description = LaunchDescription([DeclareLaunchArgument("a"), DeclareLaunchArgument("b", default_value="d")])
    include = IncludeLaunchDescription(
        LaunchDescriptionSource(description), launch_arguments={"a": LaunchConfiguration("x")}.items()
    )
    visit_all(context, include)
    assert context.launch_configurations == {"x": "1", "a": "1", "b": "d"}


def test_include_misses_arguments(context):
    description = LaunchDescription([DeclareLaunchArgument("a", description="what it is")])
    include = IncludeLaunchDescription(LaunchDescriptionSource(description), launch_arguments=[("b", "1")])
    with pytest.raises(RuntimeError, match=r"missing required argument 'a' \(description: 'what it is'\).*\[b\]"):
        include.visit(context)
    # What the file around it has set is not passed on, as in ROS 2.
    with pytest.raises(RuntimeError, match="missing required argument 'a'"):
        visit_all(
            context,
            SetLaunchConfiguration("a", "known"),
            IncludeLaunchDescription(LaunchDescriptionSource(description)),
        )


def test_include_knows_the_arguments_that_inner_includes_pass(context):
    inner = LaunchDescription([DeclareLaunchArgument("a")])
    outer = LaunchDescription([IncludeLaunchDescription(LaunchDescriptionSource(inner), launch_arguments=[("a", "1")])])
    visit_all(context, IncludeLaunchDescription(LaunchDescriptionSource(outer)))
    assert context.launch_configurations["a"] == "1"


# Loops ------------------------------------------------------------------------------------------------


def test_for_each(context):
    seen = []

    def each(name, id=7):
        seen.append((name, id))
        return [SetLaunchConfiguration(name, str(id))]

    loop = ForEach(LaunchConfiguration("sets"), function=each)
    context.launch_configurations["sets"] = "{name: 'a', id: 1};{name: b}; {id: 3, name: c}"
    visit_all(context, loop)
    assert seen == [("a", 1), ("b", 7), ("c", 3)]
    assert context.launch_configurations["c"] == "3"
    assert ForEach("", function=each).visit(context) == []
    assert ForEach("{};{}", function=lambda: None).visit(context) == []


@pytest.mark.parametrize("values", ["{other: 1}", "{name: a, other: 1}", "[1, 2]", "text", "{name: ["])
def test_for_each_with_wrong_values(context, values):
    with pytest.raises(ValueError, match=r"does not take|not a mapping|not YAML"):
        ForEach(values, function=lambda name: None).visit(context)


def test_for_loop(context):
    context.launch_configurations["n"] = "3"
    loop = ForLoop(LaunchConfiguration("n"), function=lambda i: [SetLaunchConfiguration(f"v{i}", str(i))])
    visit_all(context, loop)
    assert {f"v{i}": str(i) for i in range(3)}.items() <= context.launch_configurations.items()
    named = []
    ForLoop("2", function=lambda number: named.append(number), name="number").visit(context)
    assert named == [0, 1]
    with pytest.raises(ValueError, match="convert"):
        ForLoop("many", function=lambda i: None).visit(context)
