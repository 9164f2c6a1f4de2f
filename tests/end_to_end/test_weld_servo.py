"""`daidalos weld servo` with a simulated robot in another process, as with a real one."""

import json
import socket
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.timeout(120)]
COMMAND = [sys.executable, "-m", "daidalos.cli.daidalos", "weld", "servo"]


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


def test_the_program_follows_a_seam_with_a_robot_elsewhere(tmp_path: Path) -> None:
    port = free_port()
    servo = subprocess.Popen(
        [*COMMAND, "run", "--robot", f"127.0.0.1:{port}", "--speed", "3000", "-o", str(tmp_path / "run")],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert servo.stdout is not None
        assert servo.stdout.readline() == f"waiting for 127.0.0.1 on 127.0.0.1:{port}\n"
        robot = subprocess.run(
            [*COMMAND, "robot", "--to", f"127.0.0.1:{port}", "--speed", "3000", "--max-lost", "100", "--json"],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        out, _ = servo.communicate(timeout=60)
    finally:
        servo.kill()
    assert servo.returncode == 0, out
    assert "the seam's end was reached" in out
    figures = json.loads(robot.stdout)
    assert figures["correction_mm"][1] == pytest.approx(1.5, abs=0.1)
    assert (tmp_path / "run/run.npz").is_file()


def test_a_robot_that_never_sends_is_named() -> None:
    done = subprocess.run(
        [*COMMAND, "run", "--robot", f"127.0.0.1:{free_port()}", "--wait", "0.2"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (2, "daidalos weld: no telegram of a robot came within 0.2 s\n")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "--seam", "curv"], "there is no seam 'curv'; did you mean 'curve'?"),
        (["run", "--controller", "lqr"], "there is no seam controller 'lqr'"),
        (["run", "--robot", "127.0.0.1:0"], "--robot is '127.0.0.1:0', but ADDRESS or ADDRESS:PORT"),
        (["run", "--lost", "2"], "--lost is 2, but must be 0 to 1"),
        (["run", "--speed", "0"], "--speed is 0, but must be greater than 0"),
        (["compare", "none.npz"], "none.npz: there is no such file"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], message: str) -> None:
    done = subprocess.run([*COMMAND, *arguments], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode != 0
    assert done.stderr.count("\n") == 1
    assert message in done.stderr
