"""Processes: started, watched, respawned, stopped."""

import asyncio
import os
import re
import signal
import sys
import threading
from pathlib import Path

import psutil
import pytest
from launch import LaunchContext, LaunchDescription, LaunchService
from launch.actions import (
    EmitEvent,
    ExecuteLocal,
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.conditions import IfCondition
from launch.descriptions import Executable
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.events import matches_action
from launch.events.process import ProcessStdin, ShutdownProcess, SignalProcess
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, LocalSubstitution

from daidalos.nodes.executables import find_executable

posix = pytest.mark.skipif(os.name != "posix", reason="process groups and signals are POSIX's")

# Runs until it is told to stop, and says when it is ready for that.
PATIENT = """
import signal, threading
stop = threading.Event()
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda signum, frame: (print('got', signal.Signals(signum).name), stop.set()))
print('ready')
stop.wait()
"""
# Takes notice of nothing but SIGKILL.
STUBBORN = """
import signal, threading
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda signum, frame: print('ignored', signal.Signals(signum).name))
print('ready')
while True:
    signal.pause()
"""


def when_ready(action, *entities, text=b"ready\n"):
    """Visit entities once a process has said that it is ready."""
    received = bytearray()

    def on_stdout(event):
        was_ready = text in received
        received.extend(event.text)
        return None if was_ready or text not in received else list(entities)

    return RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=on_stdout))


def is_running(pid):
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


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


# Ends and new beginnings --------------------------------------------------------------------------------


def test_on_exit(run_launch, python, capsys):
    seen = []

    def on_exit(event, context):
        seen.append((event.returncode, isinstance(context, LaunchContext)))
        return LogInfo(msg="callback's entity")

    run_launch(
        python("raise SystemExit(2)", on_exit=on_exit),
        python("", on_exit=LogInfo(msg=["single ", LocalSubstitution("event.returncode")])),
        python("", on_exit=[LogInfo(msg="first"), LogInfo(msg="second")]),
    )
    assert seen == [(2, True)]
    printed = capsys.readouterr().out
    for text in ("callback's entity", "single 0", "first", "second"):
        assert text in printed


def test_required_process(run_launch, python, capsys):
    patient = python(PATIENT, sigterm_timeout="60")
    run_launch(
        patient,
        when_ready(patient, python("", on_exit=Shutdown(), name="required")),
    )
    assert patient.return_code == 0
    assert re.search(r"process\[required-\d+\] was required: shutting down", capsys.readouterr().out)


def test_exit_starts_the_next(run_launch, python):
    order = []
    first, second = python("", name="first"), python("", name="second")

    def note(context, text):
        order.append(text)

    run_launch(
        RegisterEventHandler(
            OnProcessStart(target_action=first, on_start=[OpaqueFunction(function=note, args=["started"])])
        ),
        RegisterEventHandler(
            OnProcessExit(target_action=first, on_exit=[OpaqueFunction(function=note, args=["exited"]), second])
        ),
        RegisterEventHandler(
            OnProcessExit(target_action=second, on_exit=[OpaqueFunction(function=note, args=["second"])])
        ),
        first,
    )
    assert order == ["started", "exited", "second"]


@pytest.mark.parametrize(
    ("kwargs", "runs"),
    [
        ({}, 1),
        ({"respawn": True, "respawn_max_retries": 2}, 3),
        ({"respawn": "true", "respawn_max_retries": "1"}, 2),
        ({"respawn": LaunchConfiguration("again"), "respawn_max_retries": 1, "respawn_delay": 0.01}, 2),
        ({"respawn": False, "respawn_max_retries": 5}, 1),
        ({"respawn": True, "respawn_max_retries": 0}, 1),
    ],
)
def test_respawn(run_launch, python, kwargs, runs):
    exits = []
    action = python("print('x')", on_exit=lambda event, context: exits.append(event.pid), cached_output=True, **kwargs)
    run_launch(SetLaunchConfiguration("again", "True"), action)
    assert len(exits) == len(set(exits)) == runs
    assert action.get_stdout() == "x\n" * runs


def test_stopping_ends_respawning(run_launch, python):
    exits = []

    def on_exit(event, context):
        exits.append(event.pid)
        return Shutdown() if len(exits) == 3 else None

    run_launch(python("", respawn=True, on_exit=on_exit))
    assert 3 <= len(exits) <= 4


def test_stopping_ends_the_wait_for_a_respawn(run_launch, python):
    exits = []
    action = python(
        "", respawn=True, respawn_delay=1000.0, on_exit=lambda event, context: (exits.append(1), Shutdown())[1]
    )
    run_launch(action)
    assert exits == [1]


# Stopping ---------------------------------------------------------------------------------------------


@posix
def test_stop_in_order(run_launch, python, capsys):
    action = python(PATIENT, cached_output=True, name="patient")
    run_launch(action, when_ready(action, Shutdown(reason="enough")))
    assert action.return_code == 0
    assert action.get_stdout() == "ready\ngot SIGINT\n"
    printed = capsys.readouterr().out
    name = action.process_details["name"]
    assert f"[INFO] [{name}]: sending signal 'SIGINT' to process[{name}]" in printed
    assert "failed to terminate" not in printed


@posix
def test_escalation(run_launch, python, capsys):
    action = python(STUBBORN, cached_output=True, sigterm_timeout="0.2", sigkill_timeout=["0.", "3"], name="stubborn")
    run_launch(action, when_ready(action, Shutdown()))
    assert action.return_code == -signal.SIGKILL
    assert action.get_stdout() == "ready\nignored SIGINT\nignored SIGTERM\n"
    printed = capsys.readouterr().out
    name = action.process_details["name"]
    assert (
        f"process[{name}] failed to terminate '0.2' seconds after receiving 'SIGINT', escalating to 'SIGTERM'"
        in printed
    )
    assert (
        f"process[{name}] failed to terminate '0.3' seconds after receiving 'SIGTERM', escalating to 'SIGKILL'"
        in printed
    )


@posix
def test_timeouts_from_launch_configurations(run_launch, python):
    action = python(STUBBORN)
    run_launch(
        SetLaunchConfiguration("sigterm_timeout", "0.05"),
        SetLaunchConfiguration("sigkill_timeout", "0.05"),
        action,
        when_ready(action, Shutdown()),
    )
    assert action.return_code == -signal.SIGKILL


def test_default_timeouts():
    action = ExecuteProcess(cmd=["x"])
    for timeout in (action.sigterm_timeout, action.sigkill_timeout):
        assert timeout[0].perform(LaunchContext()) == "5"


@posix
def test_one_process_is_stopped(run_launch, python):
    one, other = python(PATIENT, cached_output=True, respawn=True), python(PATIENT, cached_output=True)
    stop_one = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(one)))
    run_launch(
        one,
        other,
        when_ready(one, when_ready(other, stop_one), stop_one),
        RegisterEventHandler(OnProcessExit(target_action=one, on_exit=[Shutdown()])),
    )
    assert one.get_stdout() == "ready\ngot SIGINT\n"


@posix
def test_signals_are_sent(run_launch, python):
    program = """
import signal
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGUSR1])
print('ready')
signal.sigwait([signal.SIGUSR1])
print('usr1')
"""
    action = python(program, cached_output=True)
    send = EmitEvent(event=SignalProcess(signal_number="SIGUSR1", process_matcher=matches_action(action)))
    run_launch(action, when_ready(action, send))
    assert action.get_stdout() == "ready\nusr1\n"


def test_input_is_passed_on(run_launch, python):
    action = python("print('ready'); print('got ' + input())", cached_output=True)

    def feed(event):
        if b"ready" not in event.text:
            return None
        return EmitEvent(event=ProcessStdin(text=b"hello\n", **action.process_details))

    run_launch(action, RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=feed)))
    assert action.get_stdout() == "ready\ngot hello\n"


@posix
def test_what_a_process_started_is_stopped_with_it(run_launch):
    # A shell lets programs in the background ignore SIGINT.
    action = ExecuteProcess(
        cmd=["sleep 1000 & echo $!; sleep 1000 & echo $!; echo ready; wait"], shell=True, cached_output=True
    )
    run_launch(action, when_ready(action, Shutdown()))
    pids = [int(line) for line in action.get_stdout().splitlines() if line.isdigit()]
    assert len(pids) == 2
    assert not any(map(is_running, pids))


@posix
def test_stubborn_grandchildren_are_killed(run_launch, python):
    program = f"""
import signal, subprocess, sys
signal.signal(signal.SIGINT, lambda signum, frame: sys.exit(0))
print(subprocess.Popen([sys.executable, '-u', '-c', {STUBBORN!r}]).pid)
signal.pause()
"""
    action = python(program, cached_output=True, sigterm_timeout="0.2", sigkill_timeout="0.2")
    run_launch(action, when_ready(action, Shutdown()))
    assert action.return_code == 0
    assert not is_running(int(action.get_stdout().split()[0]))


@posix
def test_what_a_process_left_behind_is_stopped_with_the_launch(run_launch, python):
    left = ExecuteProcess(cmd=["sleep 1000 & echo $!"], shell=True, cached_output=True)
    alive = []

    def look(event, context):
        alive.append(is_running(int(left.get_stdout())))
        return Shutdown()

    run_launch(left, RegisterEventHandler(OnProcessExit(target_action=left, on_exit=look)))
    assert alive == [True]
    assert not is_running(int(left.get_stdout()))


@posix
def test_nothing_is_started_after_the_end(run_launch, python):
    late = python("")
    started = python(PATIENT)
    run_launch(
        started, when_ready(started, Shutdown(), TimerAction(period=0.0, actions=[late], cancel_on_shutdown=False))
    )
    assert late.process_details is None


# The service and the terminal ---------------------------------------------------------------------------

LAUNCHER = f"""
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess
kwargs = dict(output='screen', sigterm_timeout='60', sigkill_timeout='60')
service = LaunchService()
service.include_launch_description(LaunchDescription([
    ExecuteProcess(cmd=[sys.executable, '-u', '-c', program], **kwargs)
    for program in {{'patient': [{PATIENT!r}], 'stubborn': [{PATIENT!r}, {STUBBORN!r}]}}[sys.argv[1]]
]))
sys.exit(service.run())
"""


class Terminal:
    """A launch in a process of its own, and what it prints."""

    def __init__(self, kind):
        import subprocess

        self.process = subprocess.Popen(
            [sys.executable, "-u", "-c", LAUNCHER, kind], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.lines = []

    def wait_for(self, text, count=1):
        while sum(text in line for line in self.lines) < count:
            line = self.process.stdout.readline()
            assert line, f"it ended without '{text}':\n{''.join(self.lines)}"
            self.lines.append(line)

    def finish(self):
        rest, _ = self.process.communicate(timeout=30)
        self.lines += rest.splitlines()
        pids = [int(pid) for pid in re.findall(r"started with pid \[(\d+)\]", "\n".join(self.lines))]
        assert not any(map(is_running, pids))
        assert "Traceback" not in "\n".join(self.lines)
        return self.process.returncode, "\n".join(self.lines)


@posix
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_one_signal_stops_in_order(number):
    terminal = Terminal("patient")
    terminal.wait_for("ready")
    terminal.process.send_signal(number)
    code, printed = terminal.finish()
    assert code == 0
    assert "user interrupted with" in printed
    assert printed.count("got SIGINT") == 1
    assert "process has finished cleanly" in printed


@posix
def test_further_interrupts_go_harder():
    terminal = Terminal("stubborn")
    terminal.wait_for("ready", count=2)
    terminal.process.send_signal(signal.SIGINT)
    terminal.wait_for("ignored SIGINT")
    terminal.process.send_signal(signal.SIGINT)
    terminal.wait_for("ignored SIGTERM")
    terminal.process.send_signal(signal.SIGINT)
    _, printed = terminal.finish()
    assert "sending 'SIGTERM' to all processes that are left" in printed
    assert "sending 'SIGKILL' to all processes that are left" in printed


@posix
def test_quit_kills_at_once():
    terminal = Terminal("stubborn")
    terminal.wait_for("ready", count=2)
    terminal.process.send_signal(signal.SIGQUIT)
    _, printed = terminal.finish()
    assert "sending 'SIGKILL'" in printed


@posix
def test_cancelling_the_service_kills_its_processes(python):
    action = python(STUBBORN)
    service = LaunchService()
    service.include_launch_description(LaunchDescription([action]))

    async def cancel_when_ready():
        ready = asyncio.get_running_loop().create_future()
        service.context.register_event_handler(
            OnProcessIO(target_action=action, on_stdout=lambda event: ready.done() or ready.set_result(None))
        )
        task = asyncio.ensure_future(service.run_async())
        await ready
        task.cancel()
        return await task

    assert asyncio.run(cancel_when_ready()) == 1
    psutil.wait_procs([psutil.Process(pid) for pid in [action.process_details["pid"]] if psutil.pid_exists(pid)], 10)
    assert not is_running(action.process_details["pid"])


def test_run_in_another_thread(python):
    action = python("print('x')", cached_output=True)
    codes = []

    def run():
        service = LaunchService()
        service.include_launch_description(LaunchDescription([action]))
        codes.append(service.run())

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(timeout=30)
    assert codes == [0]
    assert action.get_stdout() == "x\n"
