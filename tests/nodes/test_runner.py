"""How programs end."""

import signal
import subprocess
import sys

import pytest
import rclpy
from rclpy.exceptions import NotInitializedException

from daidalos.nodes.runner import UserError, run_program


@pytest.fixture(autouse=True)
def handler():
    """Ending a program switches interrupts off; the tests go on."""
    previous = signal.getsignal(signal.SIGINT)
    yield
    signal.signal(signal.SIGINT, previous)


def test_the_end_of_the_work_is_success():
    assert run_program(lambda: None) == 0


def test_a_mistake_of_the_users_is_one_line(capsys):
    def body():
        raise UserError("no such file")

    assert run_program(body) == 2
    assert capsys.readouterr().err == "error: no such file\n"


def test_an_interrupt_is_no_error():
    def body():
        raise KeyboardInterrupt

    assert run_program(body) == 0
    assert run_program(body, interrupted=130) == 130


@pytest.mark.parametrize("error", [UserError("nothing came"), NotInitializedException()])
def test_what_an_interrupt_made_fail_is_no_error(error, capsys):
    def body():
        rclpy.init()
        rclpy.get_default_context().shutdown_by_signal()
        raise error

    assert run_program(body, interrupted=130) == 130
    assert not capsys.readouterr().err


def test_an_interrupt_in_the_import_of_a_compiled_module_is_no_error():
    def body():
        raise ImportError("initialization failed") from KeyboardInterrupt()

    assert run_program(body) == 0


def test_a_reader_who_has_seen_enough_ends_it_without_a_word():
    program = (
        "from daidalos.nodes.runner import run_program\n"
        "def body():\n"
        "    while True: print('x' * 10_000)\n"
        "raise SystemExit(run_program(body))"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.readline()
        process.stdout.close()
        assert process.wait(30) == 1
        assert process.stderr.read() == b""


@pytest.mark.parametrize("error", [ImportError("no module named x"), ValueError("a bug")])
def test_a_bug_is_shown(error):
    def body():
        raise error

    with pytest.raises(type(error)):
        run_program(body)
