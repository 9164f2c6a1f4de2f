"""The pytest plugin that collects files which describe a launch and its tests."""

from __future__ import annotations

import ast
import inspect
import pathlib
from typing import TYPE_CHECKING, Any, Self

import pytest
from _pytest.outcomes import OutcomeException

if TYPE_CHECKING:
    from launch_testing.loader import TestRun

_ENTRYPOINT = "generate_test_description"


class LaunchTestFailure(Exception):
    """Tests of a launch failed.

    Parameters
    ----------
    message
        Which.
    results
        The results by the runs.
    """

    def __init__(self, message: str, results: dict[TestRun, Any]) -> None:
        super().__init__(message)
        self.results = results


class LaunchTestFailureRepr:
    """Representation of failures.

    Parameters
    ----------
    failures
        Names and messages of the tests that failed.
    """

    def __init__(self, failures: list[tuple[str, str]]) -> None:
        self._failures = failures

    def __str__(self) -> str:
        return "\n".join(message for _, message in self._failures)

    def toterminal(self, out: Any) -> None:
        """Write the failures."""
        for name, message in self._failures:
            out.sep("_", name, bold=True)
            out.line(message)


class LaunchTestItem(pytest.Item):
    """The runs of a launch with their tests as one item of pytest.

    Parameters
    ----------
    parent
        The collector of the file.
    name
        Of the item.
    """

    def __init__(self, parent: Any, *, name: str, **kwargs: Any) -> None:
        super().__init__(name, parent=parent, **kwargs)
        self.test_runs: list[TestRun] = []
        self.runner_cls: type[Any] | None = None

    @classmethod
    def from_parent(  # type: ignore[override]  # as in ROS 2, with the runs
        cls, parent: Any, *, name: str, test_runs: list[TestRun], runner_cls: type[Any] | None = None
    ) -> Self:
        """Return the item for some runs.

        Parameters
        ----------
        parent
            The collector of the file.
        name
            Of the item.
        test_runs
            The runs.
        runner_cls
            Makes them; `LaunchTestRunner` if not said.
        """
        item = super().from_parent(parent, name=name)
        item.test_runs = test_runs
        item.runner_cls = runner_cls
        return item

    def runtest(self) -> None:
        """Execute the runs."""
        from launch_testing.test_runner import LaunchTestRunner

        runner = (self.runner_cls or LaunchTestRunner)(
            test_runs=self.test_runs,
            launch_file_arguments=self.config.getoption("--launch-args"),
            debug=self.config.getoption("verbose") > 1,
        )
        runner.validate()
        results = runner.run()
        if not all(result.wasSuccessful() for result in results.values()):
            raise LaunchTestFailure("some test cases have failed", results)
        skipped = [reason for result in results.values() for _, reason in result.skipped]
        if skipped and sum(result.testsRun for result in results.values()) == len(skipped):
            pytest.skip(skipped[0])

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return what to show of a failure."""
        if not isinstance(excinfo.value, LaunchTestFailure):
            return super().repr_failure(excinfo, style)
        failures = [
            (f"{run}.{type(case).__name__}.{case._testMethodName}", message)
            for run, result in excinfo.value.results.items()
            for case, message in (*result.errors, *result.failures)
        ]
        return LaunchTestFailureRepr(failures)

    def reportinfo(self) -> tuple[Any, int, str]:
        """Return where the item is."""
        return self.path, 0, f"launch tests: {self.name}"


class LaunchTestModule(pytest.File):
    """A file that describes a launch and its tests."""

    def makeitem(self, *args: Any, **kwargs: Any) -> LaunchTestItem:
        """Return an item for some runs; a subclass may return its own kind."""
        return LaunchTestItem.from_parent(*args, **kwargs)

    def collect(self) -> Any:
        """Yield one item for all runs of the file."""
        from launch_testing.loader import LoadTestsFromPythonModule

        module = _import(self.path, self.config)
        test_runs = LoadTestsFromPythonModule(module, name=module.__name__)
        item = self.makeitem(parent=self, name=self.name, test_runs=test_runs)
        # The marks of the description are those of the item.
        entrypoint = getattr(module, _ENTRYPOINT)
        for mark in getattr(entrypoint, "pytestmark", []):
            if mark.name not in ("launch_test", "rostest"):
                item.add_marker(getattr(pytest.mark, mark.name).with_args(*mark.args, **mark.kwargs))
        yield item


def find_launch_test_entrypoint(path: pathlib.Path, config: pytest.Config | None = None) -> Any:
    """Return the function of a file that describes a launch and has a mark of pytest, or None.

    Whether the mark is one of a launch test is for those to say who collect it. Only a file in whose text there is
    such a function is imported.

    Parameters
    ----------
    path
        The file.
    config
        Says how it is imported.
    """
    try:
        source = path.read_text(encoding="utf-8")
        if _ENTRYPOINT not in source or not _defines_entrypoint(source):
            return None
    except (OSError, SyntaxError, UnicodeDecodeError):
        # pytest itself reports what is wrong with the file.
        return None
    try:
        module = _import(path, config)
    # The file may fail to be imported for any reason, or ask to be skipped; pytest reports that of this file alone.
    except (Exception, OutcomeException):
        return None
    function = getattr(module, _ENTRYPOINT, None)
    return function if getattr(function, "pytestmark", []) else None


def pytest_pycollect_makemodule(module_path: pathlib.Path, parent: Any) -> Any:
    """Collect a file that describes a launch; leave others to pytest."""
    entrypoint = find_launch_test_entrypoint(module_path, parent.config)
    if entrypoint is None:
        return None
    hook = parent.session.gethookproxy(module_path).pytest_launch_collect_makemodule
    return hook(path=module_path, parent=parent, entrypoint=entrypoint)


@pytest.hookimpl(trylast=True)
def pytest_launch_collect_makemodule(path: pathlib.Path, parent: Any, entrypoint: Any) -> Any:
    """Return the collector of a file that describes a launch."""
    marks = [mark for mark in getattr(entrypoint, "pytestmark", []) if mark.name == "launch_test"]
    return LaunchTestModule.from_parent(parent=parent, path=path) if marks else None


def pytest_addhooks(pluginmanager: pytest.PytestPluginManager) -> None:
    """Add the hooks that this plugin calls."""
    from . import hookspecs

    pluginmanager.add_hookspecs(hookspecs)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option for the launches' arguments."""
    parser.addoption(
        "--launch-args", nargs="*", default=[], help="arguments of the launches in the form '<name>:=<value>'"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Add the mark of functions that describe a launch."""
    config.addinivalue_line("markers", "launch_test: mark a generate_test_description function as a launch test")


def _defines_entrypoint(source: str) -> bool:
    return any(
        isinstance(node, ast.FunctionDef) and node.name == _ENTRYPOINT and node.decorator_list
        for node in ast.parse(source).body
    )


def _import(path: pathlib.Path, config: pytest.Config | None) -> Any:
    from _pytest.pathlib import import_path

    mode = "prepend" if config is None else config.getoption("importmode")
    root = path.parent if config is None else config.rootpath
    options: dict[str, Any] = {"root": root, "mode": mode}
    if "consider_namespace_packages" in inspect.signature(import_path).parameters:
        options["consider_namespace_packages"] = (
            False if config is None else config.getini("consider_namespace_packages")
        )
    return import_path(path, **options)
