"""`ros2 launch`: its options, what it prints, and how it ends."""

import signal
import subprocess

import pytest

from .commands import ROS2, ros2

ECHO = """<launch>
  <arg name="word" default="none" description="What is printed"/>
  <arg name="times"/>
  <executable cmd="printenv EXTRA" output="log"/>
  <executable cmd="echo $(var word)" output="screen"/>
</launch>
"""


@pytest.fixture
def launch(env, tmp_path):
    """Run `ros2 launch` in a folder of its own."""
    (tmp_path / "echo.launch.xml").write_text(ECHO)

    def run(*words):
        return ros2("launch", *words, env={**env, "ROS_LOG_DIR": str(tmp_path / "log")}, cwd=tmp_path)

    return run


def test_arguments_are_shown(launch):
    assert launch("--show-args", "echo.launch.xml").out == (
        "Arguments (pass arguments as '<name>:=<value>'):\n\n"
        "    'word':\n        What is printed\n        (default: 'none')\n\n"
        "    'times':\n        no description given\n"
    )


def test_the_description_is_printed_and_nothing_runs(launch):
    result = launch("--print", "echo.launch.xml")
    assert result.status == 0
    assert "ExecuteProcess(cmd=['echo', LaunchConfig('word')]" in result.out
    assert "process started" not in result.out


def test_arguments_reach_the_file_and_the_last_one_wins(launch, tmp_path):
    result = launch("echo.launch.xml", "word:=first", "times:=1", "word:=last")
    assert result.status == 0
    assert "[echo-2] last\n" in result.out
    log = tmp_path / "log" / "latest" / "launch.log"
    assert "[echo-2]: process has finished cleanly" in log.read_text()


@pytest.mark.slow
@pytest.mark.parametrize(("given", "seen"), [({}, "jazzy 2 3"), ({"ROS_DISTRO": "humble"}, "humble 2 3")])
def test_files_and_programs_see_which_ros_this_is(env, tmp_path, given, seen):
    variables = ("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION")
    read = " ".join(f"$(env {name})" for name in variables)
    (tmp_path / "which.launch.xml").write_text(f'<launch><executable cmd="echo {read}" output="screen"/></launch>')
    bare = {name: value for name, value in env.items() if name not in variables}
    result = ros2(
        "launch", "which.launch.xml", env={**bare, **given, "ROS_LOG_DIR": str(tmp_path / "log")}, cwd=tmp_path
    )
    assert f"[echo-1] {seen}\n" in result.out


@pytest.mark.slow
def test_an_argument_is_missing(launch):
    result = launch("echo.launch.xml", "tims:=1", "other:=2")
    assert result.status == 1
    assert "does not declare the argument 'tims'\nDid you mean 'times'?\n" in result.err
    assert "'other'" not in result.err
    assert "echo.launch.xml:3: " in result.err + result.out
    assert "missing required argument 'times'" in result.err + result.out


@pytest.mark.slow
def test_prefixes_and_the_output_of_all(launch):
    words = ("-a", "--launch-prefix", "env EXTRA=1", "echo.launch.xml", "times:=1")
    assert "[printenv-1] 1\n" in launch(*words).out
    told = launch("--launch-prefix-filter", "echo", *words).out
    assert "[printenv-1] 1\n" not in told
    assert "[echo-2] none\n" in told


def test_debugging_tells_more(launch):
    result = launch("--debug", "echo.launch.xml", "times:=1")
    assert "[DEBUG] [launch]: processing event: " in result.out + result.err
    assert result.status == 0


@pytest.mark.slow
def test_names_of_launch_files_are_suggested(launch):
    assert "needs the name of one of its launch files: multisim.launch.py" in launch("turtlesim").err
    assert "Did you mean 'multisim.launch.py'?" in launch("turtlesim", "multisim.lanch.py").err
    assert "There are: multisim.launch.py" in launch("turtlesim", "x").err


@pytest.mark.slow
def test_ctrl_c_ends_what_was_launched_in_order(env, tmp_path):
    (tmp_path / "two.launch.yaml").write_text(
        "launch:\n- executable: {cmd: sleep 1000}\n- executable: {cmd: sleep 1000}\n"
    )
    process = subprocess.Popen(
        [*ROS2, "launch", "two.launch.yaml"],
        env={**env, "ROS_LOG_DIR": str(tmp_path)},
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    told = ""
    while told.count("process started") < 2:
        told += process.stdout.readline()
    process.send_signal(signal.SIGINT)
    told += process.communicate(timeout=30)[0]
    assert "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)" in told
    for number in (1, 2):
        assert told.index(f"sending signal 'SIGINT' to process[sleep-{number}]") < told.index(
            f"[sleep-{number}]: process has died"
        )
    assert process.returncode == 0


@pytest.mark.slow
def test_a_launch_goes_on_when_nobody_reads(env, tmp_path):
    program = "for i in 1 2 3 4; do echo $i; sleep 0.05; done; touch done"
    (tmp_path / "a.launch.xml").write_text(
        f'<launch><executable shell="true" output="screen" cmd="{program}"/></launch>'
    )
    process = subprocess.Popen(
        [*ROS2, "launch", "a.launch.xml"],
        env={**env, "ROS_LOG_DIR": str(tmp_path)},
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    process.stdout.readline()
    process.stdout.close()
    assert process.stderr.read() == ""
    process.wait(30)
    assert (tmp_path / "done").is_file()
