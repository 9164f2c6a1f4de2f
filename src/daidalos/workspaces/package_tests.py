"""The tests of a package of build type ament_cmake, and the commands that run them."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from daidalos.workspaces.cmake.contents import Test

_FILE = "tests.json"


def write_tests(tests: Sequence[Test], build: Path) -> None:
    """Write down in the build folder which tests there are."""
    rows = [{**asdict(test), "path": str(test.path)} for test in tests]
    (build / _FILE).write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


def read_tests(build: Path) -> list[Test]:
    """Return the tests that were written down when the package was built.

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
        )
        for row in rows
    ]


def command(test: Test, package: str, result: Path, build: Path) -> list[str]:
    """Return the command that runs a test and writes its result as JUnit's XML."""
    if test.kind == "pytest":
        return [
            *(sys.executable, "-m", "pytest", str(test.path), "--tb=short"),
            *("-o", f"cache_dir={build / '.pytest_cache'}"),
            *(f"--junit-xml={result}", f"--junit-prefix={package}"),
            *test.arguments,
        ]
    return [
        *(sys.executable, "-m", "launch_testing.launch_test", str(test.path)),
        *(f"--junit-xml={result}", f"--package-name={package}"),
        *test.arguments,
    ]


def missing_result(package: str, test: Test, why: str) -> str:
    """Return the result of a test that does not end, or ends without writing one."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<testsuite name="{package}" tests="1" failures="0" time="0" errors="1" skipped="0">\n'
        f'  <testcase classname="{package}" name="{test.name}" time="0">\n'
        f'    <failure message="{why}"/>\n'
        "  </testcase>\n"
        "</testsuite>\n"
    )
