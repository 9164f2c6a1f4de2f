"""Launch tests that run: under the command, under pytest, and in the older way."""

import argparse
import re
import sys
import textwrap
import threading
import xml.etree.ElementTree as ET

import launch_testing
import pytest
from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, OpaqueCoroutine, OpaqueFunction, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch_testing import ActiveIoHandler, ActiveProcInfoHandler, LaunchTestService, launch_test
from launch_testing.actions import GTest, PyTest, ReadyToTest
from launch_testing.tools import launch_process

pytest_plugins = ["pytester"]

HEAD = """
import sys
import unittest
import launch
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.markers
import pytest
from launch.actions import DeclareLaunchArgument, ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch.substitutions import LaunchConfiguration

PATIENT = '''
import signal, threading
stop = threading.Event()
signal.signal(signal.SIGINT, lambda signum, frame: stop.set())
print('ready', *__import__('sys').argv[1:])
stop.wait()
print('stopped')
'''

def patient(*arguments):
    return ExecuteProcess(cmd=[sys.executable, '-u', '-c', PATIENT, *arguments])
"""

GOOD = """
def generate_test_description():
    dut = patient()
    return launch.LaunchDescription([dut, launch_testing.actions.ReadyToTest()]), {'dut': dut}

class TestActive(unittest.TestCase):
    @classmethod
    def setUpClass(cls, proc_output, dut):
        proc_output.assertWaitFor('ready', process=dut, stream='stdout')
        cls.was_set_up = True

    def test_arguments(self, proc_info, proc_output, test_args, launch_service, dut):
        assert self.was_set_up
        proc_info.assertWaitForStartup(dut)
        assert launch_service.context is not None

    def test_attributes(self):
        self.proc_output.assertWaitFor('ready', stream='stdout')
        assert self.test_args == {}

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit(self, proc_info, proc_output, dut):
        launch_testing.asserts.assertExitCodes(proc_info)
        with launch_testing.asserts.assertSequentialStdout(proc_output, dut) as checker:
            checker.assertInStdout('ready')
            checker.assertInStdout('stopped')
"""


def write(path, body):
    path.write_text(HEAD + textwrap.dedent(body))
    return str(path)


def run(path, *arguments, expected=0):
    parser = argparse.ArgumentParser()
    launch_test.add_arguments(parser)
    code = launch_test.run(parser, parser.parse_args([path, *arguments]))
    assert code == expected


def test_good(tmp_path, capsys):
    report = tmp_path / "report.xml"
    run(write(tmp_path / "a.test.py", GOOD), "--junit-xml", str(report), "--package-name", "pkg")
    assert "Starting test run 1 of 1: pkg.a.test.launch_tests" in capsys.readouterr().out
    suites = ET.parse(report).getroot()
    assert (suites.get("name"), suites.get("tests"), suites.get("failures")) == ("pkg", "3", "0")
    names = [case.get("name") for case in suites.iter("testcase")]
    assert names == ["test_arguments", "test_attributes", "test_exit"]


def test_failures_before_and_after_shutdown(tmp_path):
    report = tmp_path / "report.xml"
    body = GOOD.replace("assert self.test_args == {}", "assert self.test_args == 5").replace("'stopped'", "'never'")
    run(write(tmp_path / "a.test.py", body), "--junit-xml", str(report), expected=1)
    failed = {
        case.get("name") for case in ET.parse(report).getroot().iter("testcase") if case.find("failure") is not None
    }
    assert failed == {"test_attributes", "test_exit"}


def test_parameters(tmp_path, capsys):
    report = tmp_path / "report.xml"
    body = """
    @launch_testing.parametrize('word, number', [('a', 1), ('b', 2)])
    def generate_test_description(word, number):
        return launch.LaunchDescription([patient(word, str(number)), launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        def test_word(self, proc_output, word, number):
            proc_output.assertWaitFor(f'ready {word} {number}', stream='stdout')
    """
    run(write(tmp_path / "a.test.py", body), "--junit-xml", str(report))
    names = [case.get("name") for case in ET.parse(report).getroot().iter("testcase")]
    assert names == ["test_word[word=a, number=1]", "test_word[word=b, number=2]"]
    assert "run 2 of 2: a.test.a.test.launch_tests[word=b, number=2]" in capsys.readouterr().out


def test_launch_arguments(tmp_path, capsys):
    body = """
    def generate_test_description():
        return launch.LaunchDescription([
            DeclareLaunchArgument('word', default_value='none', description='which word'),
            patient(LaunchConfiguration('word')),
            launch_testing.actions.ReadyToTest(),
        ])

    class TestIt(unittest.TestCase):
        def test_word(self, proc_output, test_args):
            proc_output.assertWaitFor('ready ' + test_args.get('word', 'none'), stream='stdout')
    """
    path = write(tmp_path / "a.test.py", body)
    run(path)
    run(path, "word:=given")
    capsys.readouterr()
    run(path, "--show-args")
    assert re.search(r"'word':\s+which word\s+\(default: 'none'\)", capsys.readouterr().out)


def test_older_ready_function(tmp_path):
    body = """
    def generate_test_description(ready_fn):
        p = patient()
        ready = launch.actions.OpaqueFunction(function=lambda context: ready_fn())
        return launch.LaunchDescription([p, RegisterEventHandler(OnProcessStart(target_action=p, on_start=[ready]))])

    class TestIt(unittest.TestCase):
        def test_it(self, proc_info):
            assert len(list(proc_info)) == 1
    """
    run(write(tmp_path / "a.test.py", body))


def test_ready_in_an_event_handler(tmp_path):
    body = """
    def generate_test_description():
        p = patient()
        handler = OnProcessStart(target_action=p, on_start=[launch_testing.actions.ReadyToTest()])
        return launch.LaunchDescription([p, RegisterEventHandler(handler)])

    class TestIt(unittest.TestCase):
        def test_it(self, proc_info):
            assert len(list(proc_info)) == 1
    """
    run(write(tmp_path / "a.test.py", body))


@pytest.mark.slow
def test_keeping_alive(tmp_path):
    body = """
    {marker}
    def generate_test_description():
        p = ExecuteProcess(cmd=[sys.executable, '-c', ''])
        return launch.LaunchDescription([p, launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        def test_it(self, proc_info):
            import threading
            proc_info.assertWaitForShutdown('python')
            threading.Event().wait({wait})

    @launch_testing.post_shutdown_test()
    class TestAfterwards(unittest.TestCase):
        def test_only_what_is_under_test_has_ended(self, proc_info):
            launch_testing.asserts.assertExitCodes(proc_info)
            assert len(list(proc_info)) == 1
    """
    run(write(tmp_path / "a.test.py", body.format(marker="@launch_testing.markers.keep_alive", wait=0.3)))
    run(write(tmp_path / "b.test.py", body.format(marker="", wait=0.3)), expected=1)


def test_retries(tmp_path):
    body = """
    def generate_test_description():
        return launch.LaunchDescription([patient(), launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        calls = []

        @launch_testing.markers.retry_on_failure(times=3, delay=0.01)
        def test_it(self, proc_info):
            self.calls.append(1)
            assert len(self.calls) == {count}
    """
    run(write(tmp_path / "a.test.py", body.format(count=3)))
    run(write(tmp_path / "b.test.py", body.format(count=4)), expected=1)


def test_never_ready(tmp_path, capsys):
    body = """
    from launch_testing.ready_to_test_action_timeout import ready_to_test_action_timeout

    @ready_to_test_action_timeout(0.2)
    def generate_test_description():
        timer = launch.actions.TimerAction(period=1000.0, actions=[launch_testing.actions.ReadyToTest()])
        return launch.LaunchDescription([patient(), timer])

    class TestIt(unittest.TestCase):
        def test_it(self):
            pass
    """
    run(write(tmp_path / "a.test.py", body), expected=1)
    assert "Timed out after 0.2 s waiting" in capsys.readouterr().out


def test_skipped(tmp_path):
    body = """
    def generate_test_description():
        raise unittest.SkipTest('not today')

    class TestIt(unittest.TestCase):
        def test_it(self):
            pass
    """
    report = tmp_path / "report.xml"
    run(write(tmp_path / "a.test.py", body), "--junit-xml", str(report))
    assert ET.parse(report).getroot().find("testsuite").get("skipped") == "1"


@pytest.mark.parametrize(
    ("description", "reason"),
    [
        (
            "def generate_test_description():\n    return launch.LaunchDescription([])",
            "containing a ReadyToTest action",
        ),
        ("def generate_test_description(unknown):\n    pass", "unexpected extra argument 'unknown'"),
        ("def generate_test_description(ready_fn):\n    return 5", "must return a LaunchDescription"),
    ],
)
def test_mistakes(tmp_path, capsys, description, reason):
    with pytest.raises(SystemExit):
        run(write(tmp_path / "a.test.py", description))
    assert reason in capsys.readouterr().err


def test_missing_file(capsys):
    with pytest.raises(SystemExit):
        run("nowhere.test.py")
    assert "does not exist" in capsys.readouterr().err


# Under pytest -------------------------------------------------------------------------------------------

PLUGIN = ("-p", "launch_testing.pytest.hooks", "-p", "no:cacheprovider")


def test_pytest_collects_marked_descriptions(pytester):
    marked = "@pytest.mark.launch_test" + GOOD
    write(pytester.path / "test_good.py", marked)
    write(pytester.path / "test_unmarked.py", GOOD + "\ndef test_x(): pass\n")
    write(pytester.path / "test_bad.py", "@pytest.mark.slow\n" + marked.replace("'stopped'", "'never'"))
    pytester.makeini("[pytest]\nmarkers = slow: x")
    result = pytester.runpytest_inprocess(*PLUGIN, "test_good.py", "test_bad.py", "-v")
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*test_bad.TestAfter.test_exit*", "*'never' not found*"])
    result = pytester.runpytest_inprocess(*PLUGIN, "test_good.py", "test_bad.py", "-m", "slow")
    result.assert_outcomes(failed=1, deselected=1)
    result = pytester.runpytest_inprocess(*PLUGIN, "test_unmarked.py", "-k", "test_x")
    result.assert_outcomes(passed=1, deselected=3)


def test_the_plugin_of_launch_pytest_may_be_there_too(pytester):
    write(pytester.path / "test_old.py", "@pytest.mark.launch_test" + GOOD)
    fixture = """
    import launch, launch_pytest, pytest
    from launch.actions import ExecuteProcess

    @launch_pytest.fixture
    def description():
        return launch.LaunchDescription(
            [ExecuteProcess(cmd=['sleep', '1000']), launch_pytest.actions.ReadyToTest()]
        )

    @pytest.mark.launch(fixture=description)
    def test_new(launch_context):
        assert not launch_context.is_shutdown

    def test_plain():
        pass
    """
    (pytester.path / "test_new.py").write_text(textwrap.dedent(fixture))
    result = pytester.runpytest_inprocess("-p", "launch_pytest.plugin", *PLUGIN, "test_old.py", "test_new.py")
    result.assert_outcomes(passed=3)


def test_pytest_passes_launch_arguments(pytester):
    body = """
    @pytest.mark.launch_test
    def generate_test_description():
        return launch.LaunchDescription([
            DeclareLaunchArgument('word'), patient(LaunchConfiguration('word')), launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        def test_it(self, proc_output):
            proc_output.assertWaitFor('ready given', stream='stdout')
    """
    write(pytester.path / "test_it.py", body)
    pytester.runpytest_inprocess(*PLUGIN, "test_it.py", "--launch-args", "word:=given").assert_outcomes(passed=1)


# Pieces -------------------------------------------------------------------------------------------------


def test_test_programs(tmp_path):
    (tmp_path / "test_inner.py").write_text("def test_it(): pass\n")
    program = PyTest(path=str(tmp_path / "test_inner.py"), timeout=60.0)
    slow = GTest(path="sleep", timeout=0.1, shell=True, name="slow")
    slow.process_description.cmd.append(slow.process_description.cmd[0].__class__(ExecuteProcess(cmd=["1000"]).cmd[0]))
    service = LaunchService()
    service.include_launch_description(LaunchDescription([program, slow]))
    assert service.run() == 0
    assert program.return_code == 0
    assert slow.return_code < 0
    assert (program.timeout, slow.timeout) == (60.0, 0.1)
    assert program.path[0].text.endswith("test_inner.py")


def test_processes_in_the_hands_of_a_test():
    program = "print('hello'); import sys; print('complaint', file=sys.stderr); print('got', input())"
    action = ExecuteProcess(cmd=[sys.executable, "-u", "-c", program])
    other = ExecuteProcess(cmd=["sleep", "1000"])
    service = LaunchService()
    info, output = ActiveProcInfoHandler(), ActiveIoHandler()
    thread = threading.Thread(target=service.run, kwargs={"shutdown_when_idle": False})
    started = threading.Event()
    record_info, record_output = (lambda event, context: info.append(event)), output.append
    handlers = [
        OnProcessStart(on_start=record_info),
        OnProcessExit(on_exit=record_info),
        OnProcessIO(on_stdout=record_output, on_stderr=record_output),
    ]
    service.include_launch_description(
        LaunchDescription(
            [*map(RegisterEventHandler, handlers), OpaqueFunction(function=lambda context: started.set())]
        )
    )
    thread.start()
    assert started.wait(10)
    try:
        with launch_process(service, other, info, output) as sleeper:
            info.assertWaitForStartup(process=other)
            assert sleeper.running
            with launch_process(service, action, info, output, output_filter=str.upper) as process:
                assert process.target_process_action is action
                assert process.wait_for_output(lambda text: "HELLO\n" in text and "COMPLAINT\n" in text, timeout=10)
                assert process.stdout == "HELLO\n"
                assert process.stderr == "COMPLAINT\n"
                assert process.exit_code is None
            assert process.terminated
            assert process.wait_for_shutdown(timeout=0)
            assert not sleeper.wait_for_output(timeout=0.01)
        assert sleeper.exit_code != 0
    finally:
        service.shutdown()
        thread.join()


def test_ready_calls_back():
    calls = []
    ready = ReadyToTest()
    ready._add_callback(lambda: calls.append(1))
    ready.visit(LaunchService().context)
    assert calls == [1]


# The older way ------------------------------------------------------------------------------------------


def process(program, **kwargs):
    return ExecuteProcess(cmd=[sys.executable, "-u", "-c", program], **kwargs)


@pytest.mark.parametrize(
    ("fixture", "test", "allowed", "code"),
    [
        ("import time; time.sleep(1000)", "", [0], 0),
        ("import time; time.sleep(1000)", "raise SystemExit(3)", [0], 1),
        ("raise SystemExit(2)", "import time; time.sleep(1000)", [0], 1),
        ("raise SystemExit(2)", "import time; time.sleep(0.3)", [2], 1),
    ],
)
def test_legacy_processes(fixture, test, allowed, code):
    description = LaunchDescription()
    service = LaunchTestService()
    service.add_fixture_action(description, process(fixture), exit_allowed=allowed)
    service.add_test_action(description, process(test))
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == code


@pytest.mark.parametrize("fails", [True, False])
def test_legacy_coroutines(fails):
    async def test(context):
        assert not fails

    description = LaunchDescription()
    service = LaunchTestService()
    service.add_test_action(description, OpaqueCoroutine(coroutine=test))
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == int(fails)
    with pytest.raises(TypeError, match="can be tests"):
        service.add_test_action(description, Shutdown())


@pytest.mark.parametrize(("expected", "code"), [(b"hello", 0), (b"never", 1)])
def test_legacy_output(expected, code):
    description = LaunchDescription()
    service = LaunchTestService()
    action = service.add_fixture_action(description, process("print('hello')\nprint('world')"), exit_allowed=True)
    service.add_output_test(description, action, (lambda output: expected in output, "suffix"))
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == code


def test_legacy_output_ends_the_launch():
    description = LaunchDescription()
    service = LaunchTestService()
    action = service.add_fixture_action(description, process("print('hello'); import time; time.sleep(1000)"))
    service.add_output_test(
        description, action, lambda output: b"HELLO" in output, output_filter=bytes.upper, side_effect="shutdown"
    )
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == 0


# Decorators and collection ----------------------------------------------------------------------------


def test_decorators_of_descriptions_combine():
    def describe(value):
        return value

    inside = launch_testing.parametrize("value", [(1,), (2,)])(launch_testing.ready_to_test_action_timeout(3)(describe))
    outside = launch_testing.ready_to_test_action_timeout(3)(launch_testing.parametrize("value", [1, 2])(describe))
    for decorated in (inside, outside):
        assert decorated.__ready_to_test_action_timeout__ == 3
        assert [function() for function, _ in decorated()] == [1, 2]


@pytest.mark.slow
def test_a_broken_file_does_not_keep_those_beside_it_from_being_tested(pytester):
    head = "import pytest, nowhere_to_be_found\n\n@pytest.mark.launch_test\ndef generate_test_description(): pass\n"
    pytester.makepyfile(test_broken=head, test_whole="def test_it(): pass\n")
    pytester.runpytest_inprocess("test_whole.py").assert_outcomes(passed=1)
    pytester.runpytest_inprocess().assert_outcomes(errors=1)
