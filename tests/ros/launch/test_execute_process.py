"""Processes: started, with their output and their prefixes."""

import os
import re
import sys
from pathlib import Path

import pytest
from launch.actions import (
    ExecuteLocal,
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
)
from launch.conditions import IfCondition
from launch.descriptions import Executable
from launch.event_handlers import OnProcessIO
from launch.substitutions import EnvironmentVariable, LaunchConfiguration

from daidalos.workspaces.executables import find_executable
from ros.launched_processes import posix

# Running ----------------------------------------------------------------------------------------------


def test_process_that_ends_well(run_launch, python, capsys):
    action = python("print('hello'); import sys; print('complaint', file=sys.stderr)", output="screen", name="greeter")
    assert action.return_code is None
    assert action.process_details is None
    run_launch(action)
    assert action.return_code == 0
    name = action.process_details["name"]
    assert re.fullmatch(r"greeter-\d+", name)
    printed = capsys.readouterr().out.splitlines()
    pid = action.process_details["pid"]
    for line in (
        f"[INFO] [{name}]: process started with pid [{pid}]",
        f"[{name}] hello",
        f"[{name}] complaint",
        f"[INFO] [{name}]: process has finished cleanly [pid {pid}]",
    ):
        assert line in printed


def test_details_are_known_once_the_action_is_executed(run_launch, python):
    seen = []
    action = python("", name="early")
    run_launch(action, OpaqueFunction(function=lambda context: seen.append(dict(action.process_details))))
    assert seen[0]["cmd"][-1] == ""
    assert "pid" not in seen[0]
    assert set(action.process_details) == {*seen[0], "pid"}


def test_process_that_ends_badly(run_launch, python, capsys):
    action = python("raise SystemExit(3)")
    run_launch(action)
    assert action.return_code == 3
    printed = capsys.readouterr().out
    assert f"process has died [pid {action.process_details['pid']}, exit code 3, cmd '{sys.executable} -u -c" in printed


@posix
def test_only_built_in_executables_begin_deaf_to_ctrl_c(run_launch, python):
    """Their start blocks the signal; what is started at the same time must not inherit that."""
    program = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))"
    built_in = ExecuteProcess(cmd=[*find_executable("xacro", "xacro"), "--help"])
    others = [python(program, cached_output=True) for _ in range(3)]
    run_launch(built_in, *others)
    assert built_in.return_code == 0
    assert [other.get_stdout() for other in others] == ["False\n"] * 3


@pytest.mark.parametrize("command", [["no-such-program"], ["./no/such/program"], [str(Path(__file__))]])
def test_program_that_can_not_be_started(run_launch, capsys, command):
    action = ExecuteProcess(cmd=command)
    run_launch(action, LogInfo(msg="others go on"))
    printed = capsys.readouterr().out
    assert "process could not be started" in printed
    assert "others go on" in printed
    assert "Traceback" not in printed
    assert action.return_code is None


def test_missing_folder(run_launch, python, capsys):
    run_launch(python("", cwd="/no/such/folder"))
    assert "working directory '/no/such/folder' does not exist" in capsys.readouterr().out


def test_processes_run_at_the_same_time(run_launch, python):
    # Each waits for the other's sign of life.
    wait = """
import pathlib, sys, time
pathlib.Path(sys.argv[1]).touch()
while not pathlib.Path(sys.argv[2]).exists():
    time.sleep(0.01)
"""
    one, other = python(wait, "one", "other", cwd="."), python(wait, "other", "one")
    os.chdir(os.environ["ROS_LOG_DIR"].removesuffix("/log"))
    run_launch(one, other)
    assert (one.return_code, other.return_code) == (0, 0)


def test_folder_environment_and_shell(run_launch, python, tmp_path):
    os.environ["LT_OUTSIDE"] = "outside"
    show = "import os; print(os.getcwd()); print(sorted((k, v) for k, v in os.environ.items() if k.startswith('LT_')))"
    inherited = python(
        show, cwd=str(tmp_path), additional_env={"LT_B": ["b", EnvironmentVariable("LT_C")]}, cached_output=True
    )
    replaced = python(show, env={"LT_ONLY": "x"}, cached_output=True)
    shell = ExecuteProcess(cmd=["echo", "$LT_OUTSIDE", "|", "tr", "o", "0"], shell=True, cached_output=True)
    run_launch(SetEnvironmentVariable("LT_C", "c"), inherited, replaced, shell)
    assert inherited.get_stdout().splitlines() == [
        str(tmp_path),
        "[('LT_B', 'bc'), ('LT_C', 'c'), ('LT_OUTSIDE', 'outside')]",
    ]
    assert replaced.get_stdout().splitlines()[1] == "[('LT_ONLY', 'x')]"
    assert shell.get_stdout() == "0utside\n"
    assert shell.shell is True
    assert shell.process_details["name"].startswith("echo-")


def test_commands_of_the_virtual_environment_need_no_activation(run_launch):
    os.environ["PATH"] = os.defpath
    action = ExecuteProcess(cmd=["pytest", "--version"], cached_output=True)
    run_launch(action)
    assert action.return_code == 0


def test_command_lines_are_made_of_substitutions(run_launch):
    action = ExecuteProcess(
        cmd=[sys.executable, "-c", ["print(", LaunchConfiguration("x"), ")"]],
        name=["proc_", LaunchConfiguration("x")],
        cached_output=True,
    )
    assert [len(part) for part in action.cmd] == [1, 1, 3]
    run_launch(SetLaunchConfiguration("x", "5"), action)
    assert action.get_stdout() == "5\n"
    assert action.cmd == [sys.executable, "-c", "print(5)"]
    assert action.name.startswith("proc_5-")


def test_what_began_before_a_mistake_is_ended(run_launch, python):
    def fail(context):
        raise ValueError("a mistake")

    stubborn = python(
        "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); print('ready'); signal.pause()",
        sigterm_timeout="0.2",
    )
    quick = ExecuteProcess(cmd=["sleep", "1000"])
    nested = ExecuteProcess(cmd=["sleep", "1000"])
    mistaken = [quick, GroupAction([OpaqueFunction(function=fail)])]
    ready = RegisterEventHandler(OnProcessIO(target_action=stubborn, on_stdout=lambda event: mistaken))
    service = run_launch(ready, stubborn, GroupAction([nested]), expected=1)
    assert service.error.reason == "a mistake"
    assert (stubborn.return_code, nested.return_code) == (-15, -2)
    for action in (quick, nested, stubborn):
        if action.process_details is not None:
            assert action.return_code is not None
            with pytest.raises(ProcessLookupError):
                os.kill(action.process_details["pid"], 0)


def test_a_mistake_beside_a_process(run_launch):
    def fail(context):
        raise ValueError("a mistake")

    action = ExecuteProcess(cmd=["sleep", "1000"])
    run_launch(GroupAction([action, OpaqueFunction(function=fail)]), expected=1)
    assert action.get_asyncio_future().done()
    if action.process_details is not None:
        assert action.return_code == -2


def test_an_action_runs_once(run_launch, python, capsys):
    action = python("")
    run_launch(action, action, expected=1)
    assert "executed more than once" in capsys.readouterr().out


def test_conditions(run_launch, python):
    action = python("", condition=IfCondition("false"))
    run_launch(action)
    assert action.process_details is None
    assert action.get_asyncio_future() is None


def test_execute_local(run_launch):
    action = ExecuteLocal(
        process_description=Executable(cmd=[sys.executable], arguments=["-c", "print('x')"]), cached_output=True
    )
    assert [part[0].text for part in action.process_description.arguments] == ["-c", "print('x')"]
    run_launch(action)
    assert action.get_stdout() == "x\n"
    assert action.process_description.final_cmd == [sys.executable, "-c", "print('x')"]


def test_output_is_only_there_if_it_was_kept(run_launch, python):
    action = python("print('x')")
    run_launch(action)
    for get in (action.get_stdout, action.get_stderr):
        with pytest.raises(RuntimeError, match="cached_output"):
            get()


# Output -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("output", "on_screen"),
    [
        ("screen", ["out", "err"]),
        ("log", ["err"]),
        ([LaunchConfiguration("where")], ["out", "err"]),
        ({"stdout": "log", "stderr": "screen"}, ["err"]),
        ({"both": "log"}, []),
    ],
)
def test_where_output_goes(run_launch, python, capsys, output, on_screen):
    action = python("import sys; print('out'); print('err', file=sys.stderr)", output=output, name="p")
    run_launch(SetLaunchConfiguration("where", "both"), action)
    name = action.process_details["name"]
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith(f"[{name}]")]
    assert sorted(lines) == sorted(f"[{name}] {text}" for text in on_screen)


def test_output_of_all_processes_from_the_environment(run_launch, python, capsys, monkeypatch):
    monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "screen")
    run_launch(python("print('now shown')", output="log"))
    assert "now shown" in capsys.readouterr().out


def test_invalid_output(run_launch, python, capsys):
    run_launch(python("", output="nowhere"), expected=1)
    assert "'nowhere' is not a valid output configuration" in capsys.readouterr().out


def test_output_format(run_launch, python, capsys):
    run_launch(python("print('x')", output="screen", output_format="<{line}|{this.process_description.final_name[0]}>"))
    assert "<x|p>" in capsys.readouterr().out


def test_output_comes_in_lines_whatever_the_pieces(run_launch, python, capsys):
    program = """
import sys
for piece in ['one ', 'line\\nan', 'other\\r\\n', '\\n', 'last without end']:
    sys.stdout.write(piece); sys.stdout.flush()
sys.stdout.buffer.write('grün'.encode()[:3]); sys.stdout.flush()
sys.stdout.buffer.write('grün'.encode()[3:]); sys.stdout.buffer.write(bytes([255])); sys.stdout.flush()
"""
    action = python(program, output="screen", name="p", cached_output=True)
    run_launch(action)
    prefix = f"[{action.process_details['name']}] "
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith(prefix)]
    assert lines == [
        prefix + text for text in ("one line", "another", "", "last without endgrün\N{REPLACEMENT CHARACTER}")
    ]


@pytest.mark.slow
def test_much_output_is_complete(run_launch, python):
    action = python("for i in range(20000): print(f'line {i}')", cached_output=True)
    run_launch(action)
    assert action.get_stdout().splitlines() == [f"line {i}" for i in range(20000)]


@posix
@pytest.mark.parametrize("emulate", [True, False, "true"])
def test_pseudo_terminals(run_launch, python, emulate):
    program = "import sys; print(sys.stdout.isatty(), sys.stderr.isatty()); print('two')"
    action = python(program, emulate_tty=emulate, cached_output=True)
    run_launch(action)
    assert action.get_stdout() == f"{bool(emulate)} {bool(emulate)}\ntwo\n"


@posix
def test_pseudo_terminals_for_all(run_launch, python):
    action = python("import sys; print(sys.stdout.isatty())", cached_output=True)
    run_launch(SetLaunchConfiguration("emulate_tty", "true"), action)
    assert action.get_stdout() == "True\n"


def test_command_line_is_logged_if_asked(run_launch, python, capsys):
    run_launch(python("print('x')", log_cmd=True))
    assert "process details: cmd=[" in capsys.readouterr().out


# Prefixes ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("configurations", "kwargs", "prefixed"),
    [
        ({"launch-prefix": "{py} -u -c 'print(77)'"}, {}, True),
        ({"launch-prefix": "{py} -u -c 'print(77)'", "launch-prefix-filter": "pyth"}, {}, True),
        ({"launch-prefix": "{py} -u -c 'print(77)'", "launch-prefix-filter": "other"}, {}, False),
        ({}, {"prefix": "{py} -u -c 'print(77)'"}, True),
        ({"launch-prefix-filter": "other"}, {"prefix": "{py} -u -c 'print(77)'"}, True),
        ({}, {}, False),
    ],
)
def test_prefixes(run_launch, configurations, kwargs, prefixed):
    kwargs = {name: value.format(py=sys.executable) for name, value in kwargs.items()}
    action = ExecuteProcess(cmd=[sys.executable, "-c", "print(55)"], cached_output=True, **kwargs)
    settings = [SetLaunchConfiguration(name, value.format(py=sys.executable)) for name, value in configurations.items()]
    run_launch(*settings, action)
    assert action.get_stdout() == ("77\n" if prefixed else "55\n")
