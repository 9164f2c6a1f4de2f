"""Processes that are stopped, with all that they started, and signals and input that they are sent."""

import signal

import pytest
from launch import LaunchContext
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    RegisterEventHandler,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.event_handlers import OnProcessExit, OnProcessIO
from launch.events import matches_action
from launch.events.process import ProcessStdin, ShutdownProcess, SignalProcess

from ros.launched_processes import PATIENT, STUBBORN, is_running, posix, when_ready


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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
