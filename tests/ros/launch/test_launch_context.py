"""The launch context: scopes, variables, events."""

import asyncio
import os
import threading

import pytest
from launch import LaunchContext
from launch.event import Event
from launch.event_handler import EventHandler
from launch.substitutions import TextSubstitution


def test_argv_and_interactivity():
    assert LaunchContext().argv == []
    assert LaunchContext(argv=["--foo"]).argv == ["--foo"]
    assert LaunchContext().noninteractive is False
    assert LaunchContext(noninteractive=True).noninteractive is True


def test_locals_hide_globals_and_end_with_their_scope():
    context = LaunchContext()
    context.extend_globals({"a": "global", "b": "global"})
    context._push_locals()
    context.extend_locals({"a": "local"})
    assert context.locals.a == "local"
    assert context.locals.b == "global"
    assert context.get_locals_as_dict() == {"a": "local", "b": "global"}
    context._pop_locals()
    assert context.locals.a == "global"


def test_unknown_local_is_an_attribute_error():
    with pytest.raises(AttributeError, match="foo"):
        _ = LaunchContext().locals.foo
    with pytest.raises(AttributeError, match="extend_locals"):
        LaunchContext().locals.foo = 1


@pytest.mark.parametrize("pop", ["_pop_locals", "_pop_environment", "_pop_launch_configurations"])
def test_nothing_to_pop(pop):
    with pytest.raises(RuntimeError):
        getattr(LaunchContext(), pop)()


def test_launch_configurations_have_scopes():
    context = LaunchContext()
    context.launch_configurations["a"] = "1"
    context._push_launch_configurations()
    context.launch_configurations["a"] = "2"
    context.launch_configurations["b"] = "3"
    context._pop_launch_configurations()
    assert context.launch_configurations == {"a": "1"}


def test_environment_has_scopes_and_is_that_of_the_program():
    context = LaunchContext()
    os.environ["LAUNCH_TEST_A"] = "1"
    assert context.environment["LAUNCH_TEST_A"] == "1"
    context._push_environment()
    context.environment["LAUNCH_TEST_A"] = "2"
    os.environ["LAUNCH_TEST_B"] = "3"
    assert os.environ["LAUNCH_TEST_A"] == "2"
    context._pop_environment()
    assert os.environ["LAUNCH_TEST_A"] == "1"
    assert "LAUNCH_TEST_B" not in os.environ


def test_environment_can_go_back_to_the_beginning():
    os.environ["LAUNCH_TEST_A"] = "before"
    context = LaunchContext()
    context.environment["LAUNCH_TEST_A"] = "after"
    context.environment["LAUNCH_TEST_B"] = "after"
    context._reset_environment()
    assert os.environ["LAUNCH_TEST_A"] == "before"
    assert "LAUNCH_TEST_B" not in os.environ


def test_event_handlers_are_asked_in_their_order():
    class Happened(Event):
        name = "happened"

    context = LaunchContext()
    assert not context.would_handle_event(Happened())
    first, last = (EventHandler(matcher=lambda event: isinstance(event, Happened)) for _ in range(2))
    context.register_event_handler(last)
    context.register_event_handler(first)
    assert list(context._event_handlers) == [first, last]
    context.unregister_event_handler(first)
    context.register_event_handler(first, append=True)
    assert list(context._event_handlers) == [last, first]
    assert context.would_handle_event(Happened())
    with pytest.raises(ValueError):  # noqa: PT011 - deque's own words
        context.unregister_event_handler(EventHandler(matcher=lambda event: True))


def test_events_are_queued():
    context = LaunchContext()
    event = Event()
    context.emit_event_sync(event)
    assert context._event_queue.qsize() == 1
    asyncio.run(context.emit_event(event))
    assert context._event_queue.get_nowait() is event


def test_an_event_from_another_thread_wakes_the_loop():
    context = LaunchContext()
    event = Event()

    async def wait_for_event():
        context._set_asyncio_loop(asyncio.get_running_loop())
        thread = threading.Thread(target=context.emit_event_sync, args=(event,))
        waiting = asyncio.ensure_future(context._event_queue.get())
        await asyncio.sleep(0)
        thread.start()
        received = await asyncio.wait_for(waiting, 10)
        thread.join()
        return received

    assert asyncio.run(wait_for_event()) is event


def test_perform_substitution():
    assert LaunchContext().perform_substitution(TextSubstitution(text="foo")) == "foo"


def test_shutdown_state():
    context = LaunchContext()
    assert context.is_shutdown is False
    context._set_is_shutdown(True)
    assert context.is_shutdown is True
