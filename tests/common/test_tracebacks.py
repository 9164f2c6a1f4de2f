"""Short reports of uncaught exceptions."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.common import tracebacks


def _raised(folder: Path, text: str) -> BaseException:
    """Run a user's program; return the exception that ends it."""
    program = folder / "program.py"
    program.write_text(text)
    try:
        exec(compile(text, str(program), "exec"), {})
    except Exception as error:
        trace = error.__traceback__
        return error.with_traceback(trace.tb_next if trace else None)
    raise AssertionError("the program raises nothing")


def test_the_users_lines_come_before_the_error_and_those_of_libraries_are_left_out(tmp_path: Path) -> None:
    error = _raised(tmp_path, "import json\ndef read():\n    json.loads('{')\nread()\n")
    assert isinstance(error, json.JSONDecodeError)
    file = tmp_path / "program.py"
    assert tracebacks.report(error).splitlines() == [
        f"{file}:4: in <module>: read()",
        f"{file}:3: in read: json.loads('{{')",
        f"json.decoder.JSONDecodeError: {error}",
        "(set DAIDALOS_TRACEBACK=full to see the whole traceback)",
    ]


def test_what_led_to_an_error_is_told_first(tmp_path: Path) -> None:
    text = "try:\n    {}['speed']\nexcept KeyError as error:\n    raise ValueError('no speed') from error\n"
    lines = tracebacks.report(_raised(tmp_path, text)).splitlines()
    assert lines[1] == "KeyError: 'speed'"
    assert lines[3] == "ValueError: no speed"


def test_a_suppressed_cause_is_left_out(tmp_path: Path) -> None:
    text = "try:\n    {}['speed']\nexcept KeyError:\n    raise ValueError('no speed') from None\n"
    assert "KeyError" not in tracebacks.report(_raised(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("import json\njson.laods\n", "'loads'"),
        ("from json import laods\n", "'loads'"),
    ],
)
def test_near_names_are_suggested(tmp_path: Path, text: str, hint: str) -> None:
    assert "Did you mean" in (report := tracebacks.report(_raised(tmp_path, text)))
    assert hint in report


def test_a_module_of_ros_1_is_named_with_todays(tmp_path: Path) -> None:
    report = tracebacks.report(_raised(tmp_path, "import rospy\n"))
    assert "No module named 'rospy'. 'rospy' belongs to ROS 1: use rclpy" in report


def test_a_syntax_error_is_reported_with_its_own_position(tmp_path: Path) -> None:
    (tmp_path / "faulty.py").write_text("def f(:\n")
    error = _raised(tmp_path, f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\nimport faulty\n")
    assert f'File "{tmp_path / "faulty.py"}", line 1' in tracebacks.report(error)


def test_of_the_tracebacks_in_a_text_the_last_line_is_kept() -> None:
    text = (
        "before\n"
        "Traceback (most recent call last):\n  File 'a', line 1\n    x\nKeyError: 1\n\n"
        "During handling of the above exception, another exception occurred:\n\n"
        "Traceback (most recent call last):\n  File 'a', line 2\n    y\nValueError: 2\n"
    )
    assert tracebacks.without_frames(text) == "ValueError: 2"
    assert tracebacks.without_frames("error: one\n  two\n") == "error: one\n  two"


def test_an_error_without_the_users_code_has_no_short_report() -> None:
    with pytest.raises(json.JSONDecodeError) as caught:
        json.loads("{")
    error = caught.value.with_traceback(caught.value.__traceback__.tb_next)
    assert tracebacks.report(error) == ""


@pytest.mark.parametrize(("value", "whole"), [("", False), ("full", True)])
def test_the_whole_traceback_is_shown_on_request(tmp_path: Path, value: str, whole: bool) -> None:
    program = tmp_path / "program.py"
    program.write_text(
        "import json, sys\nfrom daidalos.common import tracebacks\nsys.excepthook = tracebacks.show\njson.loads('{')\n"
    )
    done = subprocess.run(
        [sys.executable, program], capture_output=True, text=True, env={tracebacks.VARIABLE: value}, check=False
    )
    assert ("Traceback (most recent call last)" in done.stderr) is whole
    assert "JSONDecodeError" in done.stderr
    assert done.returncode == 1
