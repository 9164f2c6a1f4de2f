"""A plugin of pytest: it knows the markers that packages put on the tests of linters."""

from __future__ import annotations

from typing import Any

_MARKERS = ("copyright", "cppcheck", "flake8", "lint_cmake", "linter", "mypy", "pep257", "uncrustify", "xmllint")


def pytest_configure(config: Any) -> None:
    """Declare the markers."""
    for name in _MARKERS:
        config.addinivalue_line("markers", f"{name}: marks tests of style")
