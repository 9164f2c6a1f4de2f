"""The command that expands descriptions."""

import subprocess
import sys

import pytest

from daidalos.nodes.xacro import xacro
from daidalos.workspaces.executables import built_in_command

ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="side" default="left"/>
  <xacro:macro name="wheel" params="name"><link name="${name}"/></xacro:macro>
  <xacro:wheel name="$(arg side)"/>
</robot>
"""


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run the command on a file in the current folder."""

    def run_on(text, *arguments):
        monkeypatch.chdir(tmp_path)
        (tmp_path / "r.xacro").write_text(text)
        monkeypatch.setattr("sys.argv", ["anything", *arguments])
        status = xacro.run()
        return status, *capsys.readouterr()

    return run_on


def test_it_expands(run):
    status, printed, said = run(ROBOT, "r.xacro", "side:=right")
    assert (status, said) == (0, "")
    assert '<link name="right"/>' in printed


@pytest.mark.parametrize("option", ["--inorder", "-i"])
def test_the_option_of_ros_1_is_taken_without_a_word(run, option):
    status, printed, said = run(ROBOT, option, "r.xacro")
    assert (status, said) == (0, "")
    assert '<link name="left"/>' in printed


def test_a_mistake_is_named_with_its_line_and_the_way_to_it(run):
    status, printed, said = run(ROBOT.replace("${name}", "${nam}"), "r.xacro")
    assert (status, printed) == (2, "")
    assert said.splitlines()[0].startswith("error: r.xacro:3: <xacro:wheel>: name 'nam' is not defined")
    assert "when instantiating macro: wheel (r.xacro)" in said


@pytest.mark.slow
def test_a_long_way_is_cut(run):
    status, _, said = run(ROBOT.replace("<xacro:wheel", "<xacro:include filename='r.xacro'/><xacro:wheel"), "r.xacro")
    assert status == 2
    assert said.startswith("error: r.xacro:4: the file includes itself\n")
    assert len(said.splitlines()) < 12


def test_a_missing_file_is_one_line(run):
    assert run(ROBOT, "s.xacro") == (2, "", "error: s.xacro: no such file\n")


def test_without_a_file_the_usage_is_said():
    # In a process of its own: xacro keeps the stream that it was imported with.
    done = subprocess.run(built_in_command("xacro", "xacro"), capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("Usage: xacro [options] <input>")
    assert "error: expected exactly one input file" in done.stderr


def test_help(run):
    status, printed, said = run(ROBOT, "--help")
    assert (status, said) == (0, "")
    assert printed.startswith("Usage: xacro [options] <input>")


@pytest.mark.parametrize("expression", ["9**9**9**9", "().__class__.__bases__", "xacro.load_yaml('/etc/passwd')"])
def test_a_hostile_expression_is_one_line(run, expression):
    status, printed, said = run(ROBOT.replace('default="left"', f'default="${{{expression}}}"'), "r.xacro")
    assert (status, printed) == (2, "")
    assert said.startswith("error: r.xacro:2: ")


@pytest.mark.slow
def test_time_and_memory_are_bounded_in_a_process_of_its_own(tmp_path, monkeypatch, capsys):
    if sys.platform == "win32":
        pytest.skip("this system has no such limits")
    script = (
        "import sys, resource; from daidalos.nodes.xacro import xacro; xacro._MAX_CPU_S = 1;"
        "xacro._expand = lambda: [0 for _ in iter(int, 1)]; sys.exit(xacro.main())"
    )
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60)
    assert (ended.returncode, ended.stderr) == (2, "error: the description takes too much time or memory to expand\n")


def test_ctrl_c_is_one_line(monkeypatch, capsys):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(xacro, "_expand", interrupted)
    assert xacro.run() == 130
    assert capsys.readouterr().err == "xacro: interrupted\n"
