"""pytest for packages whose setup.py requests it in a way that current setuptools ignores."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from colcon_core.task.python.test.pytest import PytestPythonTestingStep


class DeclaredPytestStep(PytestPythonTestingStep):  # type: ignore[misc]
    """Test step with pytest for packages that name it in ``tests_require`` or in their package.xml."""

    # After colcon's own step for pytest, before the one that runs unittest.
    PRIORITY = PytestPythonTestingStep.PRIORITY - 50

    def add_arguments(self, *, parser: Any) -> None:
        """Add no arguments; colcon's own step has them."""

    def match(self, context: Any, env: dict[str, str], setup_py_data: dict[str, Any]) -> bool:
        """Return whether a file of the package requests pytest."""
        files = (Path(context.args.path) / name for name in ("setup.py", "setup.cfg", "package.xml"))
        return any("pytest" in path.read_text(encoding="utf-8", errors="replace") for path in files if path.is_file())
