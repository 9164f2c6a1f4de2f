"""Launch tests that pytest runs by its fixtures and marks, and the tools they use."""

import asyncio
import sys
import threading

import pytest
from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, GroupAction, OpaqueFunction
from launch_pytest.actions import ReadyToTest
from launch_pytest.fixture import finalize_launch_service
from launch_pytest.plugin import get_ready_to_test_action
from launch_pytest.tools import process as process_tools

pytest_plugins = ["pytester"]

HEAD = """
import sys
import launch
import launch_pytest
import pytest
from launch.actions import ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessStart

def described(process):
    # Ready when the process has started.
    handler = OnProcessStart(target_action=process, on_start=[launch_pytest.actions.ReadyToTest()])
    return launch.LaunchDescription([process, RegisterEventHandler(handler)])

@pytest.fixture
def proc():
    return ExecuteProcess(cmd=['sleep', '1000'])

@launch_pytest.fixture
def description(proc):
    return described(proc)

SHARED = ExecuteProcess(cmd=['sleep', '1000'])

@launch_pytest.fixture(scope='module')
def shared():
    return described(SHARED)
"""


def run(pytester, body, *arguments):
    pytester.makepyfile(HEAD + body)
    pytester.makeini("[pytest]\nmarkers = slow: x")
    return pytester.runpytest_inprocess("-p", "launch_pytest.plugin", "-p", "no:cacheprovider", "-vv", *arguments)


def order_of(result):
    """Return the items in the order in which they ran."""
    return [line.split("::", 1)[1].split()[0] for line in result.outlines if "::" in line and "%]" in line]


@pytest.mark.parametrize("prefix", ["", "async "])
def test_kinds_of_tests(pytester, prefix):
    body = f"""
beside_it = pytest.mark.launch(fixture=description)

@beside_it
{prefix}def test_runs_beside(proc): assert proc.process_details is not None and proc.return_code is None

@beside_it
{prefix}def test_fails_beside(proc): assert proc.return_code == -2

@beside_it
{prefix}def test_goes_on_after(proc):
    assert proc.return_code is None
    yield
    assert proc.return_code == -2

@beside_it
{prefix}def test_fails_before_yield(proc):
    assert proc.return_code == -2
    yield

@beside_it
{prefix}def test_fails_after_yield(proc):
    yield
    assert proc.return_code is None
"""
    result = run(pytester, body)
    result.assert_outcomes(passed=2, failed=3)
    passed = [line.split("::")[1].split()[0] for line in result.outlines if "PASSED" in line]
    assert passed == ["test_runs_beside", "test_goes_on_after"]


@pytest.mark.parametrize("prefix", ["", "async "])
def test_after_the_launch(pytester, prefix):
    body = f"""
@pytest.mark.launch(fixture=description, shutdown=True)
{prefix}def test_it(proc):
    assert proc.return_code == -2
"""
    run(pytester, body).assert_outcomes(passed=1)


@pytest.mark.parametrize(("prefix", "kind"), [("", "a generator function"), ("async ", "an async gen function")])
def test_two_yields(pytester, prefix, kind):
    body = f"@pytest.mark.launch(fixture=FIXTURE)\n{prefix}def test_it():\n    yield\n    yield\n"
    result = run(pytester, body.replace("FIXTURE", "description"))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([f"*launch tests using {kind} must stop iteration after yielding once*"])
    result = run(pytester, body.replace("FIXTURE", "shared"))
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines([f"*launch tests using {kind} must stop iteration after yielding once*"])


@pytest.mark.parametrize("prefix", ["", "async "])
def test_a_yield_that_is_never_reached(pytester, prefix):
    body = f"@pytest.mark.launch(fixture=shared)\n{prefix}def test_it():\n    if False:\n        yield\n"
    result = run(pytester, body)
    result.assert_outcomes(failed=1, skipped=1)
    result.stdout.fnmatch_lines(["*must yield once*"])


def test_a_mark_without_fixture(pytester):
    result = run(pytester, "@pytest.mark.launch\ndef test_it(): pass\n")
    result.assert_outcomes(skipped=1, warnings=1)
    result.stdout.fnmatch_lines(['*LaunchTestWarning: "fixture" keyword argument is required*'])


@pytest.mark.parametrize("prefix", ["", "async "])
def test_a_generator_after_the_launch(pytester, prefix):
    result = run(
        pytester, f"@pytest.mark.launch(fixture=description, shutdown=True)\n{prefix}def test_it():\n    yield\n"
    )
    result.assert_outcomes(failed=1, warnings=1)
    result.stdout.fnmatch_lines(["*cannot be marked with shutdown=True*"])


def test_a_shared_launch(pytester):
    body = """
@pytest.mark.launch(fixture=shared, shutdown=True)
def test_after(): assert SHARED.return_code == -2

@pytest.mark.launch(fixture=shared)
async def test_beside(launch_service): assert launch_service.task is not None and SHARED.return_code is None

class TestGroup:
    @pytest.mark.launch(fixture=shared)
    def test_both(self):
        self.kept = 5
        assert SHARED.return_code is None
        yield
        assert SHARED.return_code == -2 and self.kept == 5

    @pytest.mark.launch(fixture=shared)
    async def test_async_both(self):
        assert SHARED.return_code is None
        yield
        assert SHARED.return_code == -2

def test_plain(): pass

@pytest.mark.launch(fixture=shared)
@pytest.mark.parametrize('x', [1, 2])
def test_values(x):
    assert SHARED.return_code is None
    yield
    assert SHARED.return_code == -2 and x < 2
"""
    result = run(pytester, body)
    result.assert_outcomes(passed=10, failed=1)
    items = order_of(result)
    after = [item for item in items if "[shutdown_test]" in item or item == "test_after"]
    assert after == [
        "test_after",
        "TestGroup::test_both[shutdown_test]",
        "TestGroup::test_async_both[shutdown_test]",
        "test_values[shutdown_test][1]",
        "test_values[shutdown_test][2]",
    ]
    launched = [item for item in items if item != "test_plain"]
    assert launched[-len(after) :] == after


def test_the_second_part_of_a_failed_test(pytester):
    body = "@pytest.mark.launch(fixture=shared)\ndef test_it():\n    assert False\n    yield\n"
    run(pytester, body).assert_outcomes(failed=1, skipped=1)


def test_parameters_of_a_launch(pytester):
    body = """
@launch_pytest.fixture(params=['a', 'b'])
def with_parameter(request):
    process = ExecuteProcess(cmd=['echo', request.param], cached_output=True)
    return launch.LaunchDescription([process, launch_pytest.actions.ReadyToTest()]), process

@pytest.mark.launch(fixture=with_parameter)
def test_it(with_parameter, launch_context, request):
    from launch_pytest.tools import process
    word = request.node.callspec.params['with_parameter']
    process.assert_output_sync(launch_context, with_parameter[1], lambda output: output == word + '\\n', timeout=10)
"""
    result = run(pytester, body)
    result.assert_outcomes(passed=2)
    assert order_of(result) == ["test_it[a]", "test_it[b]"]


@pytest.mark.parametrize(
    ("fixture", "reason"),
    [
        (
            "    ready = [launch_pytest.actions.ReadyToTest(), launch_pytest.actions.ReadyToTest()]\n"
            "    return launch.LaunchDescription(ready)",
            "There can be only one ReadyToTest action",
        ),
        ("    return 5", "must be either a launch description"),
        (
            "    def fail(context): raise ValueError('broken')\n"
            "    return launch.LaunchDescription([launch.actions.OpaqueFunction(function=fail),\n"
            "        launch.actions.TimerAction(period=100.0, actions=[launch_pytest.actions.ReadyToTest()])])",
            "ended before it was ready to be tested*broken",
        ),
        (
            "    return launch.LaunchDescription([launch.actions.Shutdown(),\n"
            "        launch.actions.TimerAction(period=100.0, actions=[launch_pytest.actions.ReadyToTest()])])",
            "ended before it was ready to be tested*return code '0'",
        ),
    ],
)
def test_launches_that_fail(pytester, fixture, reason):
    body = f"""
@launch_pytest.fixture
def failing():
{fixture}

@pytest.mark.launch(fixture=failing)
def test_it(): pass
"""
    result = run(pytester, body)
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines([f"*{reason}*"])


def test_a_launch_that_needs_no_ready_action(pytester):
    body = """
@launch_pytest.fixture
def without(proc):
    return launch.LaunchDescription([proc])

@pytest.mark.launch(fixture=without)
def test_it(proc, launch_context):
    from launch_pytest.tools import process
    assert process.wait_for_start_sync(launch_context, proc, timeout=10)
"""
    run(pytester, body).assert_outcomes(passed=1)


def test_a_launch_that_ends_by_itself(pytester):
    body = """
ENDING = ExecuteProcess(cmd=[sys.executable, '-c', 'input()'], cached_output=True)

@launch_pytest.fixture(auto_shutdown=False)
def ending():
    yield described(ENDING)

@pytest.mark.launch(fixture=ending)
def test_it(launch_context):
    assert ENDING.return_code is None
    from launch.events.process import ProcessStdin
    launch_context.emit_event_sync(ProcessStdin(text=b'go\\n', **ENDING.process_details))

def test_after(): assert ENDING.return_code == 0
"""
    run(pytester, body).assert_outcomes(passed=2)


def test_fixtures_of_ones_own(pytester):
    body = """
from launch_pytest.fixture import get_event_loop_fixture, get_launch_service_fixture
launch_service = get_launch_service_fixture(scope='session', overridable=False)
event_loop = get_event_loop_fixture(scope='session', overridable=False)

@launch_pytest.fixture(scope='class')
def of_class():
    return launch.LaunchDescription([launch_pytest.actions.ReadyToTest()])

@pytest.fixture(scope='session')
def remembered(launch_service): return launch_service

class TestIt:
    @pytest.mark.launch(fixture=of_class)
    def test_it(self, launch_service, remembered): assert launch_service is remembered
"""
    run(pytester, body).assert_outcomes(passed=1)


def test_other_tests_are_left_alone(pytester):
    body = """
import unittest

def test_plain(proc): assert proc.process_details is None

class TestIt(unittest.TestCase):
    def test_it(self): pass

@pytest.mark.launch(fixture=description)
@pytest.mark.slow
def test_slow(): pass

@pytest.mark.launch(fixture=description)
def not_a_test(): pass
"""
    run(pytester, body).assert_outcomes(passed=3)
    run(pytester, body, "-m", "not slow").assert_outcomes(passed=2, deselected=1)
    run(pytester, body, "-m", "launch").assert_outcomes(passed=1, deselected=2)


# Pieces -------------------------------------------------------------------------------------------------


def test_the_ready_action_of_a_description():
    description = LaunchDescription([])
    added = get_ready_to_test_action(description)
    assert description.entities == [added]
    assert get_ready_to_test_action(description) is added
    inner = ReadyToTest()
    assert get_ready_to_test_action(LaunchDescription([GroupAction([inner])])) is inner
    with pytest.raises(RuntimeError, match="only one ReadyToTest"):
        get_ready_to_test_action(LaunchDescription([inner, ReadyToTest()]))


def test_a_failure_at_the_end_of_a_launch():
    loop = asyncio.new_event_loop()
    service = LaunchService()

    def fail(context):
        raise ValueError("broken")

    service.include_launch_description(LaunchDescription([OpaqueFunction(function=fail)]))

    async def start():
        task = asyncio.ensure_future(service.run_async())
        while service.task is None:
            await asyncio.sleep(0)
        return task

    loop.run_until_complete(start())
    with pytest.raises(AssertionError, match="Here launch service failed when finishing, return code '1'"):
        finalize_launch_service(service, eprefix="Here", auto_shutdown=False)
    loop.close()
    finalize_launch_service(service)
    finalize_launch_service(LaunchService())


PROGRAM = "import sys; print('hello'); print('complaint', file=sys.stderr); sys.stdin.read()"


@pytest.fixture
def launched():
    """Yield a context and the action of a process that prints and waits, and one that never starts."""
    action = ExecuteProcess(cmd=[sys.executable, "-u", "-c", PROGRAM], cached_output=True)
    never = ExecuteProcess(cmd=["true"], cached_output=True)
    service = LaunchService()
    service.include_launch_description(LaunchDescription([action]))
    thread = threading.Thread(target=service.run, kwargs={"shutdown_when_idle": False})
    thread.start()
    yield service, action, never
    service.shutdown()
    thread.join()


def test_waiting_in_another_thread(launched):
    service, action, never = launched
    context = service.context
    assert process_tools.wait_for_start_sync(context, action, timeout=10)
    assert not process_tools.wait_for_start_sync(context, never, timeout=0.01)
    assert process_tools.wait_for_output_sync(context, action, lambda text: text == "hello\n", timeout=10)
    assert not process_tools.wait_for_output_sync(context, action, lambda text: "never" in text, timeout=0.01)
    process_tools.assert_output_sync(context, action, lambda text: text == "hello\n", timeout=10)
    with pytest.raises(AssertionError, match="hello"):
        process_tools.assert_output_sync(context, action, lambda text: "never" in text, timeout=0.01)
    assert process_tools.wait_for_stderr_sync(context, action, lambda text: text == "complaint\n", timeout=10)
    process_tools.assert_stderr_sync(context, action, lambda text: text == "complaint\n", timeout=10)
    with pytest.raises(AssertionError, match="complaint"):
        process_tools.assert_stderr_sync(context, action, lambda text: "never" in text, timeout=0.01)
    assert not process_tools.wait_for_exit_sync(context, action, timeout=0.01)
    service.shutdown()
    assert process_tools.wait_for_exit_sync(context, action, timeout=10)


def test_a_validation_that_asserts(launched):
    service, action, _ = launched

    def validate(text):
        assert text.splitlines() == ["hello"], "not the greeting"

    def refuse(text):
        assert text.splitlines() == ["bye"], "not the farewell"

    process_tools.assert_output_sync(service.context, action, validate, timeout=10)
    with pytest.raises(AssertionError, match="not the farewell"):
        process_tools.assert_output_sync(service.context, action, refuse, timeout=0.01)


def test_waiting_in_coroutines():
    action = ExecuteProcess(cmd=[sys.executable, "-u", "-c", PROGRAM], cached_output=True)
    never = ExecuteProcess(cmd=["true"], cached_output=True)
    service = LaunchService()
    context = service.context
    service.include_launch_description(LaunchDescription([action]))

    async def test():
        run = asyncio.ensure_future(service.run_async(shutdown_when_idle=False))
        assert await process_tools.wait_for_start(context, action, timeout=10)
        assert not await process_tools.wait_for_start(context, never, timeout=0.01)
        assert await process_tools.wait_for_output(context, action, lambda text: text == "hello\n", timeout=10)
        assert not await process_tools.wait_for_output(context, action, lambda text: "never" in text, timeout=0.01)
        await process_tools.assert_output(context, action, lambda text: text == "hello\n", timeout=10)
        with pytest.raises(AssertionError, match="hello"):
            await process_tools.assert_output(context, action, lambda text: "never" in text, timeout=0.01)
        assert await process_tools.wait_for_stderr(context, action, lambda text: text == "complaint\n", timeout=10)
        await process_tools.assert_stderr(context, action, lambda text: text == "complaint\n", timeout=10)
        with pytest.raises(AssertionError, match="complaint"):
            await process_tools.assert_stderr(context, action, lambda text: "never" in text, timeout=0.01)
        assert not await process_tools.wait_for_exit(context, action, timeout=0.01)
        stopped = service.shutdown()
        assert await process_tools.wait_for_exit(context, action, timeout=10)
        if stopped is not None:
            await stopped
        assert await run == 0

    asyncio.run(test())
