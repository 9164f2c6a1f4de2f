"""Processes looked up, their output and exit codes asserted, text compared."""

import re
import threading
from types import SimpleNamespace

import pytest
from launch.actions import ExecuteLocal, ExecuteProcess
from launch.descriptions import Executable
from launch.events.process import ProcessExited, ProcessStarted, ProcessStderr, ProcessStdout
from launch.substitutions import LaunchConfiguration
from launch_testing import ActiveIoHandler, ActiveProcInfoHandler, IoHandler, ProcInfoHandler, ReadyAggregator
from launch_testing.asserts import (
    EXIT_OK,
    EXIT_SIGINT,
    SequentialTextChecker,
    assertDefaultStream,
    assertExitCodes,
    assertInStderr,
    assertInStdout,
    assertInStream,
    assertSequentialStdout,
)
from launch_testing.event_handlers import StdoutReadyListener
from launch_testing.legacy import (
    create_output_lines_filter,
    create_output_lines_test,
    create_output_regex_test,
    create_output_test_from_file,
)
from launch_testing.parse_arguments import parse_launch_arguments
from launch_testing.tools import basic_output_filter, expect_output, expected_output_from_file
from launch_testing.tools.text import build_line_match, build_text_match, normalize_lineseps
from launch_testing.util import NO_CMD_ARGS, NoMatchingProcessException, resolveProcesses


def make_action(name, *arguments):
    action = ExecuteProcess(cmd=[name, *arguments])
    details = {"name": f"{name}-1", "cmd": [name, *arguments], "cwd": None, "env": None, "pid": 5, "action": action}
    action.__class__ = type("Started", (ExecuteProcess,), {"process_details": details})
    return action


TALKER, LISTENER, LISTENER_2 = make_action("talker"), make_action("listener", "--loud"), make_action("listener_2", "-x")


def started(action):
    return ProcessStarted(**action.process_details)


def exited(action, code):
    return ProcessExited(returncode=code, **action.process_details)


def out(action, text):
    return ProcessStdout(text=text.encode(), **action.process_details)


def err(action, text):
    return ProcessStderr(text=text.encode(), **action.process_details)


@pytest.fixture(params=[IoHandler, ActiveIoHandler])
def output(request):
    handler = request.param()
    for piece in (
        out(TALKER, "hello "),
        out(TALKER, "world\n"),
        out(LISTENER, "heard \033[31mhello\033[0m\nlast line\n"),
        err(LISTENER, "complaint\n"),
        out(LISTENER_2, "nothing\n"),
    ):
        handler.append(piece)
    handler.track("silent-1")
    return handler


@pytest.fixture(params=[ProcInfoHandler, ActiveProcInfoHandler])
def info(request):
    handler = request.param()
    for event in (started(TALKER), started(LISTENER), exited(TALKER, 0), exited(LISTENER, -2)):
        handler.append(event)
    return handler


# Looking up -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kwargs", "found"),
    [
        ({}, [TALKER, LISTENER, LISTENER_2]),
        ({"process": "talker"}, [TALKER]),
        ({"process": TALKER}, [TALKER]),
        ({"process": "listener", "strict_proc_matching": False}, [LISTENER, LISTENER_2]),
        ({"process": "listener", "cmd_args": "--loud"}, [LISTENER]),
        ({"process": "listener", "cmd_args": ["-x"]}, [LISTENER_2]),
        ({"process": "e", "cmd_args": NO_CMD_ARGS}, [TALKER]),
    ],
)
def test_lookup(output, kwargs, found):
    assert resolveProcesses(output, **kwargs) == found


def test_failed_lookup(output):
    with pytest.raises(NoMatchingProcessException, match="nobody"):
        resolveProcesses(output, process="nobody")
    with pytest.raises(NoMatchingProcessException):
        resolveProcesses(output, process="talker", cmd_args="--loud")
    with pytest.raises(LookupError, match="multiple processes"):
        resolveProcesses(output, process="listener")
    with pytest.raises(TypeError):
        resolveProcesses(output, process=5)
    with pytest.raises(NoMatchingProcessException, match="No data recorded for any process"):
        resolveProcesses(IoHandler())


@pytest.mark.parametrize("cmd_args", ["--lou", ["--loud", "-x"]])
def test_arguments_are_looked_up_whole(output, cmd_args):
    with pytest.raises(NoMatchingProcessException, match=r"Procs: listener-1 --loud, listener_2-1 -x, talker-1"):
        resolveProcesses(output, process="listener", cmd_args=cmd_args)


@pytest.mark.parametrize(
    ("cmd", "described"),
    [(["ls", "-l"], "process ls -l"), ([LaunchConfiguration("program"), "-l"], "Unknown - Process not launched yet")],
)
def test_looking_up_what_was_not_started(output, cmd, described):
    for action in (ExecuteProcess(cmd=cmd), ExecuteLocal(process_description=Executable(cmd=cmd))):
        with pytest.raises(NoMatchingProcessException, match=described):
            resolveProcesses(output, process=action)


def test_exit_codes_of_all_processes_need_no_details():
    class Recorded:
        def processes(self):
            return ["somebody"]

        def __getitem__(self, key):
            return exited(TALKER, 1)

    with pytest.raises(AssertionError, match="talker-1 exited with code 1"):
        assertExitCodes(Recorded())


def test_output_handlers(output):
    assert len(list(output)) == 5
    assert list(output.processes()) == [TALKER, LISTENER, LISTENER_2]
    assert list(output.process_names()) == ["talker-1", "listener-1", "listener_2-1", "silent-1"]
    assert [piece.text for piece in output["talker-1"]] == [b"hello ", b"world\n"]
    assert output[TALKER] == output["talker-1"]
    assert output["silent-1"] == []
    with pytest.raises(KeyError):
        output["nobody"]


def test_process_handlers(info):
    assert len(list(info)) == 2
    assert list(info.processes()) == [TALKER, LISTENER]
    assert list(info.process_names()) == ["talker-1", "listener-1"]
    assert info[TALKER].returncode == info["talker"].returncode == 0
    for unknown in ("nobody", LISTENER_2):
        with pytest.raises(KeyError):
            info[unknown]


# Asserting --------------------------------------------------------------------------------------------


def test_output_is_found(output):
    assertInStdout(output, "hello world", "talker")
    assertInStdout(output, "heard hello", LISTENER)
    assertInStdout(output, "last", process="listener", cmd_args="--loud")
    assertInStdout(output, "nothing", None)
    assertInStderr(output, "complaint", LISTENER)
    assertInStream(output, re.compile("compl.*t"), LISTENER)
    assertInStdout(output, ["hello", re.compile("last l")], LISTENER)
    assertInStdout(output, lambda text: len(text) > 20, LISTENER)
    assertInStdout(output, "HELLO", TALKER, output_filter=str.upper)
    assertInStdout(output, "\033[31m", LISTENER, strip_ansi_escape_sequences=False)
    assertInStdout(output, "nothing", "listener", strict_proc_matching=False)
    assert assertDefaultStream() == "stderr"


def test_output_is_not_found(output):
    for arguments in (("goodbye", "talker"), ("complaint", LISTENER), (["last", "hello"], LISTENER)):
        with pytest.raises(AssertionError, match="Did not find"):
            assertInStdout(output, *arguments)
    with pytest.raises(NoMatchingProcessException):
        assertInStdout(output, "hello", "nobody")


def test_order_of_output(output):
    with assertSequentialStdout(output, LISTENER) as checker:
        checker.assertInStdout("hello")
        checker.assertInText("last")
        with pytest.raises(AssertionError, match="came earlier"):
            checker.assertInStdout("hello")
        assert "last line" in checker.get_nearby_lines()
    with pytest.raises(LookupError), assertSequentialStdout(output, "listener"):
        pass
    with pytest.raises(LookupError), assertSequentialStdout(output, None):
        pass
    checker = SequentialTextChecker(["a b", " c"])
    checker.assertInText("b c")
    with pytest.raises(AssertionError, match="not found"):
        checker.assertInText("d")


def test_exit_codes(info):
    assertExitCodes(info, process=TALKER)
    assertExitCodes(info, [EXIT_OK, EXIT_SIGINT])
    assertExitCodes(info, [EXIT_OK, -2])
    with pytest.raises(AssertionError, match="listener-1 exited with code -2"):
        assertExitCodes(info)
    info.append(started(LISTENER_2))
    with pytest.raises(AssertionError, match="has not exited"):
        assertExitCodes(info, process=LISTENER_2)


# Waiting ----------------------------------------------------------------------------------------------


def later(function, *arguments):
    thread = threading.Timer(0.05, function, arguments)
    thread.start()
    return thread


def test_waiting_for_output():
    output = ActiveIoHandler()
    thread = later(output.append, err(TALKER, "now"))
    output.assertWaitFor("now", process="talker", timeout=10)
    thread.join()
    assert output.waitFor("now", process=TALKER, timeout=0)
    assert not output.waitFor("never", timeout=0.05)
    assert not output.waitFor("now", process="nobody", timeout=0.05)
    with pytest.raises(AssertionError, match="timed out"):
        output.assertWaitFor("now", stream="stdout", timeout=0.05)


def test_waiting_for_processes():
    info = ActiveProcInfoHandler()
    thread = later(info.append, started(TALKER))
    info.assertWaitForStartup("talker", timeout=10)
    thread.join()
    with pytest.raises(AssertionError, match="to finish"):
        info.assertWaitForShutdown("talker", timeout=0.05)
    thread = later(info.append, exited(TALKER, 0))
    info.assertWaitForShutdown(TALKER, timeout=10)
    thread.join()
    info.assertWaitForStartup(TALKER, timeout=0)
    with pytest.raises(AssertionError, match="to start"):
        info.assertWaitForStartup("nobody", timeout=0.05)


def test_several_signals_as_one():
    calls = []
    aggregator = ReadyAggregator(lambda: calls.append(1), 3)
    for expected in (0, 0, 1, 1):
        aggregator.ready_fn()
        assert len(calls) == expected


def test_ready_listener():
    listener = StdoutReadyListener(target_action=TALKER, ready_txt="ready", actions=["action"])
    context = SimpleNamespace(extend_locals=lambda extensions: None)
    pieces = [out(TALKER, "rea"), out(TALKER, "dy\n"), out(TALKER, "ready again")]
    assert [listener.handle(piece, context) for piece in pieces] == [None, ["action"], None]
    assert listener.describe()[1] == ["action"]
    assert not listener.matches(out(LISTENER, "ready"))


# Texts ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expected", "text", "strict", "place"),
    [
        ("foo", "a foo b", False, (2, 5)),
        ("foo", "foo", True, (0, 3)),
        ("foo", "a foo", True, None),
        ("bar", "foo", False, None),
        (re.compile("f.o"), "a foo", False, (2, 5)),
        (re.compile("f.o"), "a foo", True, None),
        (["a", "b"], "xaxb", False, (1, 4)),
        (["a", "b"], "ba", False, None),
        (["a", re.compile("b+")], "abb", True, (0, 3)),
        (["a", "b"], "axb", True, None),
        ("a\nb", "a\r\nb", True, (0, 3)),
    ],
)
def test_texts(expected, text, strict, place):
    assert build_text_match(expected, strict=strict)(text) == place


@pytest.mark.parametrize(
    ("expected", "lines", "strict", "place"),
    [
        ("foo", ["a", "foo", "b"], False, (1, 2)),
        ("foo", ["a foo"], False, (0, 1)),
        ("foo", ["a foo"], True, None),
        (["foo", "bar"], ["foo", "x", "bar"], False, (0, 3)),
        (["foo", "bar"], ["foo", "x", "bar"], True, None),
        (["foo", re.compile("b.r")], ["foo", "bar"], True, (0, 2)),
        (["bar", "foo"], ["foo", "bar"], False, None),
        ([], ["a"], False, (0, 0)),
    ],
)
def test_lines(expected, lines, strict, place):
    assert build_line_match(expected, strict=strict)(lines) == place


def test_expectations(tmp_path):
    assert expect_output(text="a \033[1mb\033[0m", expected_text="a b")
    assert not expect_output(text="a \033[1mb\033[0m", expected_text="a b", strip_ansi_escape_sequences=False)
    assert expect_output(lines=["a", "b"], expected_lines=["b"])
    assert expect_output(text="a\nb\n", expected_lines=["a", "b"], strict=True)
    assert expect_output(lines=["a", "b"], expected_text="a\nb", strict=True)
    for wrong in ({}, {"text": "a"}, {"text": "a", "lines": [], "expected_text": "a"}, {"expected_text": "a"}):
        with pytest.raises(ValueError, match="must be given"):
            expect_output(**wrong)
    (tmp_path / "a.txt").write_text("one\ntwo\n")
    (tmp_path / "b.regex").write_text("o.e\n")
    assert expected_output_from_file(str(tmp_path / "a")) == ["one", "two"]
    assert expected_output_from_file(str(tmp_path / "b"))[0].match("ore")
    with pytest.raises(RuntimeError, match="could not find"):
        expected_output_from_file(str(tmp_path / "c"))


def test_filters():
    text = "pid 5\nhello\nnoise 7\n"
    assert basic_output_filter()(text) == "hello\nnoise 7\n"
    assert basic_output_filter()("no newline") == "no newline"
    assert basic_output_filter(filtered_prefixes=[], filtered_patterns=[r"noise \d"])(text) == "pid 5\nhello\n"
    assert basic_output_filter(filtered_prefixes=["h", "n", "p"])(text) == ""
    assert normalize_lineseps(["a\r\n"]) == ["a\n"]


def test_legacy_outputs(tmp_path):
    keep = create_output_lines_filter(filtered_prefixes=["pid"], filtered_patterns=["noise"])
    assert keep(b"pid 5\nhello\nnoise\n") == b"hello\n"
    test, name = create_output_lines_test(["a", "b"])
    assert name == "output_lines"
    assert test(b"xb\nxa\n")
    assert not test(b"a\n")
    test, name = create_output_regex_test(["a+b", b"c"])
    assert name == "output_regex"
    assert test(b"aab\nc")
    assert not test(b"aab")
    (tmp_path / "x.txt").write_text("line\n")
    (tmp_path / "y.regex").write_text("l.ne\n")
    assert create_output_test_from_file(str(tmp_path / "x"))[0](b"line")
    assert create_output_test_from_file(str(tmp_path / "y"))[0](b"lane")
    with pytest.raises(RuntimeError, match="could not find"):
        create_output_test_from_file(str(tmp_path / "z"))


def test_launch_arguments():
    assert parse_launch_arguments(["a:=1", "b:=", "c:=x:=y", "a:=2"]) == [("a", "2"), ("b", ""), ("c", "x:=y")]
    for wrong in ("a", "a=1", ":=1"):
        with pytest.raises(RuntimeError, match="malformed launch argument"):
            parse_launch_arguments([wrong])


def test_lines_of_several_expectations_have_texts_in_them_and_begin_with_expressions():
    lines = ["Subscribed to [/chatter]", "  History (Depth): KEEP_LAST (10)", "more"]
    expected = ["Subscribed", re.compile(r"  History \(Depth\): KEEP_\w+")]
    assert expect_output(lines=lines, expected_lines=expected, strict=True)
    assert not expect_output(lines=["before", *lines], expected_lines=expected, strict=True)
    assert expect_output(lines=["before", lines[0], "between", lines[1]], expected_lines=expected)
    assert not expect_output(lines=[lines[0], "between", lines[1]], expected_lines=expected, strict=True)


def test_one_strict_expectation_is_for_every_line():
    assert expect_output(lines=["a 1", "a 2"], expected_lines=re.compile("a"), strict=True)
    assert not expect_output(lines=["a 1", "b"], expected_lines=re.compile("a"), strict=True)
    assert expect_output(lines=["a", "a"], expected_lines="a", strict=True)
    assert not expect_output(lines=["a", "ab"], expected_lines="a", strict=True)


def test_strict_expressions_match_from_the_beginning_of_a_text():
    assert expect_output(text="a 1\nb", expected_text=re.compile("a"), strict=True)
    assert not expect_output(text="b a", expected_text=re.compile("a"), strict=True)
