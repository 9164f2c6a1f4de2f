"""A launch service that is interrupted, cancelled, or run in another thread."""

import asyncio
import re
import signal
import sys
import threading

import psutil
import pytest
from launch import LaunchDescription, LaunchService
from launch.event_handlers import OnProcessIO

from ros.launched_processes import PATIENT, STUBBORN, is_running, posix

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
