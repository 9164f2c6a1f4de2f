"""Events and their handlers."""

import signal
from unittest.mock import Mock, NonCallableMock

import pytest
from launch import Event, EventHandler, LaunchContext, LaunchDescription, LaunchService
from launch.action import Action
from launch.actions import ExecuteProcess, LogInfo, RegisterEventHandler
from launch.event_handler import BaseEventHandler
from launch.event_handlers import (
    OnActionEventBase,
    OnExecutionComplete,
    OnIncludeLaunchDescription,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
    event_named,
)
from launch.events import (
    ExecutionComplete,
    IncludeLaunchDescription,
    Shutdown,
    TimerEvent,
    matches_action,
)
from launch.events.process import (
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    ProcessStderr,
    ProcessStdin,
    ProcessStdout,
    RunningProcessEvent,
    SignalProcess,
    matches_executable,
    matches_name,
    matches_pid,
)

DETAILS = {"action": "action", "name": "n-1", "cmd": ["n"], "cwd": "/", "env": {"A": "1"}, "pid": 5}


def test_names():
    names = {
        Event: "launch.Event",
        Shutdown: "launch.events.Shutdown",
        ExecutionComplete: "launch.events.ExecutionComplete",
        IncludeLaunchDescription: "launch.events.IncludeLaunchDescription",
        TimerEvent: "launch.events.TimerEvent",
        ProcessStarted: "launch.events.process.ProcessStarted",
        ProcessExited: "launch.events.process.ProcessExited",
        ProcessStdout: "launch.events.process.ProcessStdout",
        SignalProcess: "launch.events.process.SignalProcess",
    }
    for event, name in names.items():
        assert event.name == name
    assert event_named("launch.events.Shutdown")(Shutdown())
    assert not event_named("launch.events.Shutdown")(Event())


def test_process_events_know_their_process():
    for event in (
        RunningProcessEvent(**DETAILS),
        ProcessStarted(**DETAILS),
        ProcessExited(returncode=3, **DETAILS),
        ProcessStdout(text=b"x", **DETAILS),
    ):
        assert event.action == event.execute_process_action == "action"
        assert (event.process_name, event.cmd, event.cwd, event.env, event.pid) == ("n-1", ["n"], "/", {"A": "1"}, 5)
    assert ProcessExited(returncode=3, **DETAILS).returncode == 3


def test_streams():
    for event, streams in (
        (ProcessStdin(text=b"x", **DETAILS), (True, False, False)),
        (ProcessStdout(text=b"x", **DETAILS), (False, True, False)),
        (ProcessStderr(text=b"x", **DETAILS), (False, False, True)),
        (ProcessIO(text=b"x", fd=2, **DETAILS), (False, False, True)),
    ):
        assert (event.from_stdin, event.from_stdout, event.from_stderr) == streams
        assert event.text == b"x"


@pytest.mark.parametrize("given", ["SIGINT", "INT", signal.SIGINT, int(signal.SIGINT)])
def test_signals(given):
    event = SignalProcess(signal_number=given, process_matcher=lambda action: True)
    assert event.signal is signal.SIGINT
    assert event.signal_name == "SIGINT"


def test_no_signal():
    with pytest.raises(ValueError, match="SIGNOTHING"):
        SignalProcess(signal_number="SIGNOTHING", process_matcher=lambda action: True)


def test_matchers():
    action = Mock(spec=ExecuteProcess)
    action.process_details = {"pid": 5, "name": "n-1", "cmd": ["n", "-x"]}
    unstarted = Mock(spec=ExecuteProcess)
    unstarted.process_details = None
    for matcher, other in (
        (matches_pid(5), matches_pid(6)),
        (matches_name("n-1"), matches_name("n")),
        (matches_executable("n"), matches_executable("-x")),
        (matches_action(action), matches_action(unstarted)),
    ):
        assert matcher(action)
        assert not other(action)
    assert not any(matcher(unstarted) for matcher in (matches_pid(5), matches_name("n-1"), matches_executable("n")))


def test_event_handler():
    class Mine(Event):
        pass

    entity = LogInfo(msg="x")
    context = LaunchContext()
    handler = EventHandler(matcher=lambda event: isinstance(event, Mine), entities=entity, handle_once=True)
    context.register_event_handler(handler)
    assert handler.matches(Mine())
    assert not handler.matches(Event())
    assert handler.entities == [entity]
    event = Mine()
    assert handler.handle(event, context) == [entity]
    assert context.locals.event is event
    assert list(context._event_handlers) == []
    text, entities = handler.describe()
    assert "EventHandler" in text
    assert entities == [entity]
    assert BaseEventHandler(matcher=lambda event: True).handle(event, context) is None


HANDLERS = [
    (OnProcessExit, "on_exit", ProcessExited, ExecuteProcess),
    (OnProcessStart, "on_start", ProcessStarted, ExecuteProcess),
    (OnExecutionComplete, "on_completion", ExecutionComplete, Action),
]


@pytest.mark.parametrize(("handler_class", "argument", "event_class", "action_class"), HANDLERS)
def test_handlers_for_actions(handler_class, argument, event_class, action_class):
    target, other = NonCallableMock(spec=action_class), NonCallableMock(spec=action_class)
    event = Mock(spec=event_class, action=target)
    foreign = Mock(spec=event_class, action=other)
    context = Mock(spec=LaunchContext)
    entity = LogInfo(msg="x")

    for matcher in (target, lambda action: action is target):
        handler = handler_class(target_action=matcher, **{argument: entity})
        assert handler.matches(event)
        assert not handler.matches(foreign)
        assert not handler.matches(Event())
    everyone = handler_class(**{argument: [entity]})
    assert everyone.matches(event)
    assert everyone.matches(foreign)
    assert everyone.handle(event, context) == [entity]
    assert everyone.describe()[1] == [entity]

    callback = Mock(return_value=entity)
    handler = handler_class(target_action=target, **{argument: callback})
    assert handler.handle(event, context) is entity
    callback.assert_called_once_with(event, context)
    assert handler.describe()[1] == []
    assert event_class.__name__ in handler.matcher_description


@pytest.mark.parametrize(("handler_class", "argument"), [entry[:2] for entry in HANDLERS])
def test_wrong_targets_and_reactions(handler_class, argument):
    with pytest.raises(TypeError, match="an instance of"):
        handler_class(target_action="not an action", **{argument: LogInfo(msg="x")})
    with pytest.raises(TypeError, match="function or entities"):
        handler_class(**{argument: "not an entity"})


def test_processes_are_the_targets_of_process_events():
    with pytest.raises(TypeError, match="ExecuteLocal"):
        OnProcessExit(target_action=LogInfo(msg="x"), on_exit=[])


def test_handled_once():
    context = LaunchContext()
    handler = OnActionEventBase(
        action_matcher=None,
        on_event=[],
        target_event_cls=Event,
        target_action_cls=Action,
        handle_once=True,
    )
    context.register_event_handler(handler)
    handler.handle(Event(), context)
    assert list(context._event_handlers) == []


def test_io_goes_to_the_function_for_its_stream():
    seen = []
    handler = OnProcessIO(
        on_stdin=lambda event: seen.append(("in", event.text)),
        on_stdout=lambda event: seen.append(("out", event.text)),
        on_stderr=lambda event: seen.append(("err", event.text)),
    )
    context = LaunchContext()
    for event in (
        ProcessStdin(text=b"1", **DETAILS),
        ProcessStdout(text=b"2", **DETAILS),
        ProcessStderr(text=b"3", **DETAILS),
    ):
        assert handler.matches(event)
        handler.handle(event, context)
    assert seen == [("in", b"1"), ("out", b"2"), ("err", b"3")]
    assert OnProcessIO().handle(ProcessStdout(text=b"2", **DETAILS), context) is None


def test_on_shutdown():
    context = LaunchContext()
    entity = LogInfo(msg="x")
    event = Shutdown(reason="r", due_to_sigint=True)
    assert (event.reason, event.due_to_sigint) == ("r", True)
    handler = OnShutdown(on_shutdown=[entity])
    assert handler.matches(event)
    assert not handler.matches(Event())
    assert handler.handle(event, context) == [entity]
    callback = Mock(return_value=None)
    OnShutdown(on_shutdown=callback).handle(event, context)
    callback.assert_called_once_with(event, context)


def test_on_include():
    description = LaunchDescription()
    handler = OnIncludeLaunchDescription()
    assert isinstance(handler, EventHandler)
    event = IncludeLaunchDescription(description)
    assert handler.matches(event)
    assert handler.handle(event, LaunchContext()) is description


def test_handlers_react_to_events_of_the_users_own(run_launch, capsys):
    class Mine(Event):
        name = "mine"

    from launch.actions import EmitEvent
    from launch.substitutions import LocalSubstitution

    run_launch(
        RegisterEventHandler(
            EventHandler(matcher=event_named("mine"), entities=[LogInfo(msg=["got ", LocalSubstitution("event.name")])])
        ),
        EmitEvent(event=Mine()),
    )
    assert "got mine" in capsys.readouterr().out


def test_what_is_no_entity_is_an_error(capsys):
    service = LaunchService()
    service.include_launch_description(
        LaunchDescription([RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: ["text"]))])
    )
    assert service.run() == 1
    assert "expected a LaunchDescriptionEntity" in capsys.readouterr().out
