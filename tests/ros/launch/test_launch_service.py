"""The launch service: its run, its end, timers and coroutines."""

import asyncio
import threading

import pytest
from launch import LaunchDescription, LaunchService
from launch.actions import (
    EmitEvent,
    GroupAction,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.event import Event
from launch.event_handler import EventHandler
from launch.event_handlers import OnExecutionComplete, OnShutdown
from launch.events import Shutdown as ShutdownEvent
from launch.substitutions import EnvironmentVariable, LaunchConfiguration


def note(seen, text):
    return OpaqueFunction(function=lambda context: seen.append(text))


def test_nothing_to_do():
    service = LaunchService()
    assert service.event_loop is None
    assert service.task is None
    assert service.run() == 0
    assert service.error is None


def test_arguments():
    service = LaunchService(argv=["a"], noninteractive=True)
    assert service.context.argv == ["a"]
    assert service.context.noninteractive


def test_debug_says_everything(capsys):
    service = LaunchService(debug=True)
    service.include_launch_description(LaunchDescription([]))
    service.run()
    printed = capsys.readouterr().out
    assert "Default logging verbosity is set to DEBUG" in printed
    assert "processing event" in printed


def test_where_the_logs_are_is_said(capsys, tmp_path):
    LaunchService()
    printed = capsys.readouterr().out
    assert f"[INFO] [launch]: All log files can be found below {tmp_path / 'log'}" in printed
    assert "[INFO] [launch]: Default logging verbosity is set to INFO" in printed


def test_descriptions_are_visited_in_order():
    seen = []
    service = LaunchService()
    service.include_launch_description(LaunchDescription([note(seen, 1), note(seen, 2)]))
    service.include_launch_description(LaunchDescription([note(seen, 3)]))
    assert service.run() == 0
    assert seen == [1, 2, 3]


def test_a_service_runs_again():
    seen = []
    service = LaunchService()
    for text in ("first", "second"):
        service.include_launch_description(LaunchDescription([note(seen, text), TimerAction(period=0.0, actions=[])]))
        assert service.run() == 0
    assert seen == ["first", "second"]


def test_one_run_at_a_time():
    service = LaunchService()
    errors = []

    async def again(context):
        try:
            await service.run_async()
        except RuntimeError as error:
            errors.append(str(error))

    service.include_launch_description(LaunchDescription([OpaqueCoroutine(coroutine=again)]))
    assert service.run() == 0
    assert errors == ["LaunchService is already running"]


def test_an_exception_ends_the_launch(run_launch, capsys):
    seen = []

    def fail(context):
        raise RuntimeError("on purpose")

    service = run_launch(
        RegisterEventHandler(OnShutdown(on_shutdown=[note(seen, "shutdown")])),
        OpaqueFunction(function=fail),
        note(seen, "after"),
        expected=1,
    )
    assert seen == ["shutdown"]
    printed = capsys.readouterr().out
    assert "[ERROR] [launch]: Caught exception in launch (see debug for traceback): on purpose" in printed
    assert "Traceback" not in printed
    assert service.error.reason == "on purpose"
    assert service.error.file is None


def test_scopes_end_with_exceptions(run_launch):
    class Failing(Event):
        pass

    def fail(event, context):
        raise RuntimeError("on purpose")

    service = run_launch(
        RegisterEventHandler(OnShutdown(on_shutdown=fail)),
        expected=1,
    )
    assert "event" not in service.context.get_locals_as_dict()


# Stopping ---------------------------------------------------------------------------------------------


def test_shutdown_is_once(run_launch):
    reasons = []

    def on_shutdown(event, context):
        reasons.append((event.reason, event.due_to_sigint, context.is_shutdown))
        return Shutdown(reason="again")

    run_launch(Shutdown(reason="enough"), RegisterEventHandler(OnShutdown(on_shutdown=on_shutdown, handle_once=True)))
    assert reasons[0][:2] == ("enough", False)


def test_idleness_is_the_reason_when_all_is_done(run_launch):
    reasons = []
    run_launch(RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: reasons.append(event.reason))))
    assert reasons == ["idle"]


def test_shutdown_of_a_service_that_does_not_run():
    assert LaunchService().shutdown() is None


def test_shutdown_from_another_thread():
    service = LaunchService()
    running = threading.Event()
    service.include_launch_description(LaunchDescription([OpaqueFunction(function=lambda context: running.set())]))
    results = []

    def stop():
        running.wait(10)
        results.append(service.shutdown())

    thread = threading.Thread(target=stop)
    thread.start()
    assert service.run(shutdown_when_idle=False) == 0
    thread.join()
    assert results == [None]


def test_shutdown_from_another_thread_reaches_its_handlers():
    """The launch is idle when it is told to end; it must not end before the event is handled."""
    for _ in range(20):
        service, handled = LaunchService(), []
        handler = OnShutdown(on_shutdown=lambda event, context, handled=handled: handled.append(event))
        started = threading.Event()
        service.include_launch_description(
            LaunchDescription(
                [RegisterEventHandler(handler), OpaqueFunction(function=lambda context, s=started: s.set())]
            )
        )
        thread = threading.Thread(
            target=lambda started=started, service=service: (started.wait(10), service.shutdown())
        )
        thread.start()
        assert service.run(shutdown_when_idle=False) == 0
        thread.join()
        assert len(handled) == 1


@pytest.mark.parametrize("force_sync", [True, False])
def test_shutdown_inside_the_loop(force_sync):
    service = LaunchService()
    results = []

    async def stop(context):
        result = service.shutdown(force_sync=force_sync)
        results.append(asyncio.iscoroutine(result))
        if result is not None:
            await result

    service.include_launch_description(LaunchDescription([OpaqueCoroutine(coroutine=stop)]))
    assert service.run(shutdown_when_idle=False) == 0
    assert results == [not force_sync]


def test_shutdown_between_two_runs_of_the_loop():
    service, loop = LaunchService(), asyncio.new_event_loop()
    task = loop.create_task(service.run_async(shutdown_when_idle=False))
    loop.run_until_complete(asyncio.sleep(0))
    assert not task.done()
    stopping = loop.create_task(service.shutdown())
    assert loop.run_until_complete(task) == 0
    loop.run_until_complete(stopping)
    loop.close()


def test_run_async():
    seen = []
    service = LaunchService()
    service.include_launch_description(LaunchDescription([note(seen, "x")]))

    async def run():
        task = asyncio.ensure_future(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0)
        assert service.event_loop is asyncio.get_running_loop()
        assert service.task is task
        assert service.context.asyncio_loop is service.event_loop
        await service.shutdown()
        return await task

    assert asyncio.run(run()) == 0
    assert seen == ["x"]
    assert service.event_loop is None
    assert service.context.asyncio_loop is None


def test_events_from_another_thread():
    class Mine(Event):
        name = "mine"

    seen = []
    service = LaunchService()
    ready = threading.Event()
    service.include_launch_description(
        LaunchDescription(
            [
                RegisterEventHandler(
                    EventHandler(
                        matcher=lambda event: isinstance(event, Mine), entities=[note(seen, "mine"), Shutdown()]
                    )
                ),
                OpaqueFunction(function=lambda context: ready.set()),
            ]
        )
    )
    thread = threading.Thread(target=lambda: (ready.wait(10), service.emit_event(Mine())))
    thread.start()
    assert service.run(shutdown_when_idle=False) == 0
    thread.join()
    assert seen == ["mine"]


# Timers -----------------------------------------------------------------------------------------------


def test_timers_fire_in_the_order_of_their_times(run_launch):
    seen = []
    run_launch(
        TimerAction(period=0.2, actions=[note(seen, "late")]),
        TimerAction(period="0.05", actions=[note(seen, "text")]),
        TimerAction(period=[LaunchConfiguration("p", default="0.1")], actions=[note(seen, "substitution")]),
        TimerAction(period=0, actions=[note(seen, "now")]),
        note(seen, "before"),
    )
    assert seen == ["before", "now", "text", "substitution", "late"]


def test_timers_in_timers(run_launch):
    seen = []
    run_launch(TimerAction(period=0.01, actions=[TimerAction(period=0.01, actions=[note(seen, "inner")])]))
    assert seen == ["inner"]


def test_shutdown_ends_timers(run_launch):
    seen = []
    run_launch(TimerAction(period=1000.0, actions=[note(seen, "never")]), Shutdown())
    assert seen == []


def test_some_timers_outlast_shutdown(run_launch):
    seen = []
    run_launch(
        TimerAction(period=0.05, actions=[note(seen, "still")], cancel_on_shutdown=LaunchConfiguration("no")),
        Shutdown(),
        expected=1,
    )
    run_launch(
        SetLaunchConfiguration("no", "false"),
        TimerAction(period=0.05, actions=[note(seen, "still")], cancel_on_shutdown=LaunchConfiguration("no")),
        Shutdown(),
    )
    assert seen == ["still"]


def test_timers_can_be_cancelled(run_launch):
    seen = []
    timer = TimerAction(period=1000.0, actions=[note(seen, "never")])
    run_launch(timer, OpaqueFunction(function=lambda context: timer.cancel()))
    early = TimerAction(period=0.0, actions=[note(seen, "never")])
    early.cancel()
    run_launch(early)
    assert seen == []


def test_timers_see_the_scope_that_they_began_in_and_leave_nothing(run_launch):
    seen = []

    def look(context):
        seen.append((LaunchConfiguration("x").perform(context), EnvironmentVariable("LT_X").perform(context)))

    def look_outside(context):
        seen.append(("y" in context.launch_configurations, "LT_Y" in context.environment))

    run_launch(
        GroupAction(
            [
                SetLaunchConfiguration("x", "inner"),
                SetEnvironmentVariable("LT_X", "inner"),
                TimerAction(
                    period=0.0,
                    actions=[
                        OpaqueFunction(function=look),
                        SetLaunchConfiguration("y", "1"),
                        SetEnvironmentVariable("LT_Y", "1"),
                    ],
                ),
            ]
        ),
        SetLaunchConfiguration("x", "outer"),
        TimerAction(period=0.05, actions=[OpaqueFunction(function=look_outside)]),
    )
    assert seen == [("inner", "inner"), (False, False)]


def test_timers_describe_themselves():
    inner = LogInfo(msg="x")
    timer = TimerAction(period=2.0, actions=[inner])
    assert "2.0" in timer.describe()
    [(text, entities)] = timer.describe_conditional_sub_entities()
    assert "2.0" in text
    assert entities == [inner]
    assert timer.period == 2.0
    with pytest.raises(TypeError):
        TimerAction(period=None, actions=[])


# Coroutines -------------------------------------------------------------------------------------------


def test_coroutines_keep_the_launch_going(run_launch):
    seen = []

    async def work(context, *args, **kwargs):
        await asyncio.sleep(0.01)
        seen.append((context.is_shutdown, args, kwargs))

    async def without_context(x):
        seen.append(x)

    action = OpaqueCoroutine(coroutine=work, args=[1], kwargs={"a": 2})
    run_launch(action, OpaqueCoroutine(coroutine=without_context, args=["x"], ignore_context=True))
    assert seen == ["x", (False, (1,), {"a": 2})]
    assert action.get_asyncio_future().done()


def test_shutdown_cancels_coroutines(run_launch):
    seen = []

    async def wait_for_ever(context):
        try:
            await asyncio.get_running_loop().create_future()
        except asyncio.CancelledError:
            seen.append("cancelled")
            raise

    run_launch(OpaqueCoroutine(coroutine=wait_for_ever), TimerAction(period=0.0, actions=[Shutdown()]))
    assert seen == ["cancelled"]


def test_exceptions_of_coroutines_end_the_launch(run_launch, capsys):
    async def fail(context):
        raise RuntimeError("in a coroutine")

    run_launch(OpaqueCoroutine(coroutine=fail), TimerAction(period=1000.0, actions=[]), expected=1)
    assert "in a coroutine" in capsys.readouterr().out


def test_only_coroutine_functions():
    async def fine():
        pass

    for wrong in (
        {"coroutine": print},
        {"coroutine": fine, "args": 1},
        {"coroutine": fine, "kwargs": []},
        {"coroutine": fine, "ignore_context": 1},
    ):
        with pytest.raises(TypeError):
            OpaqueCoroutine(**wrong)
    coroutine = fine()
    with pytest.raises(TypeError):
        OpaqueCoroutine(coroutine=coroutine)
    coroutine.close()


def test_completion_is_announced_when_what_was_started_is_done(run_launch):
    seen = []

    async def work(context):
        await asyncio.sleep(0.01)
        seen.append("work")

    action = OpaqueCoroutine(coroutine=work)
    timer = TimerAction(period=0.05, actions=[])
    run_launch(
        RegisterEventHandler(OnExecutionComplete(target_action=action, on_completion=[note(seen, "complete")])),
        RegisterEventHandler(OnExecutionComplete(target_action=timer, on_completion=[note(seen, "timer")])),
        action,
        timer,
    )
    assert seen == ["work", "complete", "timer"]


def test_shutdown_event_of_the_users_own(run_launch):
    reasons = []
    run_launch(
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: reasons.append(event.reason))),
        EmitEvent(event=ShutdownEvent(reason="mine")),
    )
    assert reasons == ["mine"]
