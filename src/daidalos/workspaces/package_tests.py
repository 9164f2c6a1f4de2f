"""Tests of a package of build type ament_cmake, and their commands."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from daidalos.workspaces.cmake.contents import Test
from daidalos.workspaces.timed import TIMED_OUT

NO_TESTS = 5
"""Exit status of pytest without tests."""
_FILE = "tests.json"


def write_tests(tests: Sequence[Test], build: Path) -> None:
    """Write the list of tests to the build folder."""
    rows = [{**asdict(test), "path": str(test.path)} for test in tests]
    (build / _FILE).write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


def read_tests(build: Path) -> list[Test]:
    """Return the tests that the build wrote to the build folder.

    Raises
    ------
    FileNotFoundError
        When it has not been.
    """
    rows = json.loads((build / _FILE).read_text(encoding="utf-8"))
    return [
        Test(
            name=row["name"],
            kind=row["kind"],
            path=Path(row["path"]),
            arguments=tuple(row["arguments"]),
            timeout=row["timeout"],
            environment=tuple((key, value) for key, value in row["environment"]),
            folder=row["folder"],
        )
        for row in rows
    ]


def command(test: Test, package: str, result: Path, build: Path) -> list[str]:
    """Return the command that runs a test with a timeout and writes its result as JUnit XML."""
    timed = [sys.executable, "-m", "daidalos.workspaces.timed", f"{test.timeout:g}"]
    if test.kind == "pytest":
        return [
            *(*timed, sys.executable, "-m", "pytest", str(test.path), "--tb=short"),
            *("-o", f"cache_dir={build / '.pytest_cache'}"),
            *(f"--junit-xml={result}", f"--junit-prefix={package}"),
            *test.arguments,
        ]
    return [
        *(*timed, sys.executable, "-m", "launch_testing.launch_test", str(test.path)),
        *(f"--junit-xml={result}", f"--package-name={package}"),
        *test.arguments,
    ]


def complete_result(result: Path, package: str, test: Test, status: int) -> None:
    """Write the result of a test that failed or was stopped without writing one."""
    if status in (0, NO_TESTS):
        return
    written = result.read_text(encoding="utf-8") if result.is_file() else ""
    if status == TIMED_OUT:
        why = f"The test did not end within {test.timeout:g} s."
    elif "<failure" in written or "<error" in written:
        return
    else:
        why = f"The test ended with the exit status {status} and without a result."
    result.write_text(_failed(package, test, why), encoding="utf-8")


def _failed(package: str, test: Test, why: str) -> str:
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<testsuite name="{package}" tests="1" failures="0" time="0" errors="1" skipped="0">\n'
        f'  <testcase classname="{package}" name="{test.name}" time="0">\n'
        f'    <failure message="{why}"/>\n'
        "  </testcase>\n"
        "</testsuite>\n"
    )
