"""The Tab key, as bash and zsh ask for it."""

import os
import pty
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

BIN = Path(sys.executable).parent
NODE = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("talker")
node.create_publisher(String, "chatter", 10)
node.declare_parameter("speed", 1.0)
rclpy.spin(node)
"""


@pytest.fixture
def shell(env):
    """An environment in which a shell finds the command."""
    return {**env, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}", "HOME": "/nonexistent", "TERM": "dumb"}


@pytest.fixture
def bash(shell) -> Callable[[str], list[str]]:
    """What bash is told at the end of a line."""
    if shutil.which("bash") is None:
        pytest.skip("no bash here")
    script = """
        eval "$(register-python-argcomplete ros2)"
        COMP_LINE=$1 COMP_POINT=${#1} COMP_TYPE=9 COMP_WORDS=($1)
        [[ $1 == *' ' ]] && COMP_WORDS+=("")
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _python_argcomplete ros2 && printf '%s\\n' "${COMPREPLY[@]}"
    """

    def complete(line: str) -> list[str]:
        command = ["bash", "--norc", "-c", script, "bash", line]
        done = subprocess.run(command, env=shell, capture_output=True, text=True, timeout=40)
        return [word.strip() for word in done.stdout.splitlines() if word.strip()]

    return complete


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("ros2 to", ["topic"]),
        ("ros2 topic ec", ["echo"]),
        ("ros2 topic echo --onc", ["--once"]),
        ("ros2 run turtlesi", ["turtlesim"]),
        ("ros2 run turtlesim turtle_te", ["turtle_teleop_key"]),
        ("ros2 launch turtlesim multi", ["multisim.launch.py"]),
        ("ros2 interface show geometry_msgs/msg/TwistSt", ["geometry_msgs/msg/TwistStamped"]),
        ("ros2 pkg prefix demo_nodes_p", ["demo_nodes_py"]),
        ("ros2 topic pub /x std_msgs/msg/Strin", ["std_msgs/msg/String"]),
    ],
)
def test_bash_completes_what_needs_no_graph(bash, line, expected):
    assert bash(line) == expected


@pytest.mark.slow
def test_bash_completes_what_is_in_the_graph(bash, beside, wait_for):
    beside(NODE)
    wait_for("/talker/set_parameters")
    assert bash("ros2 topic echo /chat") == ["/chatter"]
    assert bash("ros2 node info /tal") == ["/talker"]
    assert bash("ros2 service type /talker/list") == ["/talker/list_parameters"]
    assert bash("ros2 param get /talker spe") == ["speed"]
    assert bash("ros2 topic pub /chatter ") == ["std_msgs/msg/String"]


@pytest.mark.slow
def test_bash_completes_launch_files_and_their_arguments(bash, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    choices = '<choice value="fast"/><choice value="slow"/>'
    Path("lab.launch.xml").write_text(f'<launch><arg name="robot"/><arg name="mode">{choices}</arg></launch>')
    assert bash("ros2 launch lab.la") == ["lab.launch.xml"]
    assert bash("ros2 launch lab.launch.xml mode:=f") == ["fast"]
    assert bash("ros2 launch lab.launch.xml rob") in (["robot:="], ["robot:"])


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("zsh") is None, reason="no zsh here")
def test_zsh_completes(shell, tmp_path):
    """In a terminal of its own, as zsh completes only for somebody who types."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.execve(shutil.which("zsh"), ["zsh", "-f", "-i"], {**shell, "ZDOTDIR": str(tmp_path), "PS1": "> "})
    try:
        _type(
            terminal,
            'autoload -U compinit; compinit -u -D; eval "$(register-python-argcomplete ros2)"; print rea""dy\n',
        )
        assert "ready" in _read_until(terminal, "ready")
        _type(terminal, 'ros2 interface show geometry_msgs/msg/TwistSt\t > /dev/null; print fin""ished $?\n')
        assert "finished 0" in _read_until(terminal, "finished 0")
    finally:
        os.close(terminal)
        os.waitpid(pid, 0)


def _type(terminal: int, text: str) -> None:
    os.write(terminal, text.encode())


def _read_until(terminal: int, end: str, timeout_s: float = 30.0) -> str:
    text, deadline = "", time.monotonic() + timeout_s
    while end not in text and (left := deadline - time.monotonic()) > 0:
        if select.select([terminal], [], [], left)[0]:
            text += os.read(terminal, 4096).decode(errors="replace")
    return text
