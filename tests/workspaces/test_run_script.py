"""Python scripts of packages and the reports of their mistakes."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.workspaces.executables import reporting_command

_SCRIPT = """#!{python}
# EASY-INSTALL-ENTRY-SCRIPT: 'my-nodes==0.0.0','console_scripts','{name}'
import sys
from importlib.metadata import distribution

if __name__ == '__main__':
    sys.path.insert(0, {folder!r})
    entries = distribution('my-nodes').entry_points
    sys.exit(next(one for one in entries if one.name == '{name}').load()())
"""

_ENTRIES = {
    "good": "my_nodes.good:main",
    "raises": "my_nodes.raises:main",
    "mian": "my_nodes.good:mian",
    "module": "my_nodes.good",
    "missing": "my_nodes.goood:main",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of the executables of an installed package."""
    package, info = tmp_path / "python" / "my_nodes", tmp_path / "python" / "my_nodes-0.0.0.dist-info"
    for one in (package, info):
        one.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "good.py").write_text("import sys\ndef main():\n    print(__name__, sys.argv[1:])\n    return 3\n")
    (package / "raises.py").write_text("def main():\n    int('one')\n")
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-nodes\nVersion: 0.0.0\n")
    (info / "entry_points.txt").write_text(
        "[console_scripts]\n" + "".join(f"{name} = {value}\n" for name, value in _ENTRIES.items())
    )
    scripts = tmp_path / "lib" / "my_nodes"
    scripts.mkdir(parents=True)
    for name in _ENTRIES:
        script = scripts / name
        script.write_text(_SCRIPT.format(python=sys.executable, name=name, folder=str(package.parent)))
        script.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return scripts


def _run(script: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = reporting_command([str(script), *arguments])
    assert len(command) == 3 + len(arguments)
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_a_script_runs_as_by_itself(folder: Path) -> None:
    done = _run(folder / "good", "a", "b")
    assert (done.returncode, done.stdout, done.stderr) == (3, "my_nodes.good ['a', 'b']\n", "")


def test_an_exception_is_reported_by_the_users_lines(folder: Path) -> None:
    done = _run(folder / "raises")
    file = folder.parents[1] / "python" / "my_nodes" / "raises.py"
    assert done.stderr.splitlines()[:2] == [
        f"{file}:2: in main: int('one')",
        "ValueError: invalid literal for int() with base 10: 'one'",
    ]
    assert done.returncode == 1


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("mian", "module 'my_nodes.good' has no attribute 'mian'; did you mean 'main'?"),
        ("module", "names no function; write 'module = my_nodes.good:main'"),
        ("missing", "No module named 'my_nodes.goood'; did you mean 'my_nodes.good'?"),
    ],
)
def test_a_wrong_entry_point_is_named_in_one_line(folder: Path, name: str, problem: str) -> None:
    lines = _run(folder / name).stderr.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith(f"setup.py: the entry point '{name} = {_ENTRIES[name]}'")
    assert lines[0].endswith(problem)


@pytest.mark.skipif(sys.platform == "win32", reason="the system has no signals")
def test_an_interrupt_is_no_mistake(folder: Path) -> None:
    script = folder / "good"
    script.write_text(f"#!{sys.executable}\nimport signal\nsignal.raise_signal(signal.SIGINT)\n")
    done = _run(script)
    assert (done.returncode, done.stderr) == (-signal.SIGINT, "")


@pytest.mark.skipif(not Path("/proc/self/comm").exists(), reason="the system does not show processes' names in /proc")
def test_the_process_has_the_scripts_name(folder: Path) -> None:
    script = folder / "good"
    script.write_text(f"#!{sys.executable}\nprint(open('/proc/self/comm').read())\n")
    assert _run(script).stdout.strip() == "good"


def test_a_module_beside_the_script_can_be_imported(folder: Path) -> None:
    (folder / "helper.py").write_text("VALUE = 5\n")
    script = folder / "good"
    script.write_text("#!/usr/bin/env python3\nimport helper\nprint(helper.VALUE, __name__, __file__)\n")
    assert _with_own_python_first(script).stdout.split() == ["5", "__main__", str(script)]


def _with_own_python_first(script: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", path)
        return _run(script)


def test_scripts_of_other_interpreters_and_files_elsewhere_are_started_as_they_are(folder: Path) -> None:
    other = folder / "other"
    other.write_text("#!/bin/sh\n")
    outside = folder.parents[1] / "outside"
    outside.write_text(f"#!{sys.executable}\n")
    for command in ([str(other)], [str(outside)], ["gdb", "--args", str(folder / "good")], ["echo", "x"]):
        assert reporting_command(command) == command
