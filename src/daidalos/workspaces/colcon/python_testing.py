"""Testing packages whose setup.py asks for pytest in a way that today's setuptools no longer passes on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from colcon_core.task.python.test.pytest import PytestPythonTestingStep


class DeclaredPytestStep(PytestPythonTestingStep):  # type: ignore[misc]
    """Runs pytest for packages that name it in ``tests_require`` or in their package.xml."""

    # After colcon's own step for pytest, before the one that runs unittest.
    PRIORITY = PytestPythonTestingStep.PRIORITY - 50

    def add_arguments(self, *, parser: Any) -> None:
        """Add no arguments: colcon's own step has them all."""

    def match(self, context: Any, env: dict[str, str], setup_py_data: dict[str, Any]) -> bool:
        """Return whether a file of the package asks for pytest."""
        files = (Path(context.args.path) / name for name in ("setup.py", "setup.cfg", "package.xml"))
        return any("pytest" in path.read_text(encoding="utf-8", errors="replace") for path in files if path.is_file())
