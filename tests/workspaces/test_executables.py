"""Which command starts an executable, built-in or of a workspace."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.workspaces.executables import (
    LEFT_OUT,
    ExecutableNotFound,
    executable_path,
    executables,
    find_executable,
    interrupts_blocked,
    left_out,
)


def test_a_built_in_executable_is_started_as_a_module() -> None:
    command = find_executable("gazebo_ros", "spawn_entity.py")
    assert command[0] == sys.executable
    assert command[-2:] == ["gazebo_ros", "spawn_entity"]
    assert executable_path("gazebo_ros", "spawn_entity.py").name == "spawn_entity.py"
    assert "spawn_entity.py" in executables("gazebo_ros")


def test_spawners_have_the_names_of_older_distributions_too() -> None:
    assert find_executable("controller_manager", "spawner.py") == find_executable("controller_manager", "spawner")
    assert executable_path("controller_manager", "unspawner.py").name == "unspawner.py"


def test_modules_that_are_parts_are_no_executables() -> None:
    assert not [name for name in executables("gazebo_ros") if name.startswith("_")]


def test_a_workspace_comes_before_what_is_built_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "lib" / "gazebo_ros"
    folder.mkdir(parents=True)
    program = folder / "gzserver"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    (folder / "README").write_text("not a program")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert find_executable("gazebo_ros", "gzserver") == [str(program)]
    assert "README" not in executables("gazebo_ros")


@pytest.mark.parametrize(
    ("package", "executable", "message"),
    [
        ("gazebo_ros", "gzsever", "No executable 'gzsever' in package 'gazebo_ros'; did you mean 'gzserver'?"),
        ("no_such_package", "x", "Package 'no_such_package' not found"),
    ],
)
def test_what_is_not_there_is_told_with_what_is_near(package: str, executable: str, message: str) -> None:
    with pytest.raises(ExecutableNotFound, match=f"^{re.escape(message)}$"):
        find_executable(package, executable)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signal masks")
def test_a_target_that_the_build_left_out_is_told_with_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    index = tmp_path / "share" / "ament_index" / "resource_index"
    for kind, text in (("packages", ""), (LEFT_OUT, "talker: 'talker' is C++\nlistener: 'listener' is C++\n")):
        (index / kind).mkdir(parents=True)
        (index / kind / "cpp_pubsub").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    with pytest.raises(ExecutableNotFound, match=r"^No executable 'talker' in .*: 'talker' is C\+\+$"):
        find_executable("cpp_pubsub", "talker")
    assert left_out("cpp_pubsub", "listener") == "'listener' is C++"
    assert left_out("cpp_pubsub", "talke") == left_out("turtlesim", "talker") == ""


def test_only_our_own_programs_are_started_with_interrupts_blocked() -> None:
    def blocked(command: list[str]) -> bool:
        with interrupts_blocked(command):
            show = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))"
            done = subprocess.run([sys.executable, "-c", show], capture_output=True, text=True)
        return done.stdout.strip() == "True"

    assert blocked(find_executable("gazebo_ros", "gzserver"))
    assert not blocked(["sleep", "1"])
    assert not blocked(["gdb", "--args", *find_executable("gazebo_ros", "gzserver")])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signal masks")
def test_a_program_of_ours_lets_interrupts_in() -> None:
    command = find_executable("gazebo_ros", "gzserver")
    with interrupts_blocked(command):
        process = subprocess.Popen([*command, "--no-such-flag"], stderr=subprocess.PIPE, env=os.environ | {"X": "1"})
    status = Path(f"/proc/{process.pid}/status")
    if status.exists():
        while "SigBlk:\t0000000000000002" in status.read_text():
            assert process.poll() is None, "it ended with the signal blocked"
    assert process.communicate()[1]
