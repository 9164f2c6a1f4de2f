"""One marked test of pytest, carried out in the process of its scenario."""

from __future__ import annotations

import pickle
from importlib.machinery import SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from daidalos.testing.present import set_present

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

PICTURE = "failure.png"


def run_test(scenario: Scenario, node_id: str, options: dict[str, Any], inifile: str | None, reports: str) -> int:
    """Run one test, and write its reports to a file, pickled one after the other.

    Parameters
    ----------
    scenario : Scenario
    node_id : str
        Of the test, with an absolute path.
    options : dict
        Those of the pytest that found it.
    inifile : str, optional
        Its configuration file.
    reports : str
        Path of the file.
    """
    from _pytest.config import Config

    _support_modules_as_programs()
    set_present(scenario)
    config_file = [] if inifile is None else ["-c", inifile]
    config = Config.fromdictargs(options, [*config_file, node_id])
    config.pluginmanager.register(_Reporter(scenario, config, Path(reports)), "daidalos-scenario-reporter")
    try:
        return int(config.hook.pytest_cmdline_main(config=config) or 0)
    finally:
        config._ensure_unconfigure()


def _support_modules_as_programs() -> None:
    """Give pytest's loader of modules the method by which `runpy` runs one as a program, as it is written."""
    from _pytest.assertion.rewrite import AssertionRewritingHook

    def get_code(self: AssertionRewritingHook, name: str) -> Any:
        spec = find_spec(name)
        assert spec is not None
        assert spec.origin is not None
        return SourceFileLoader(name, spec.origin).get_code(name)

    hook: Any = AssertionRewritingHook
    hook.get_code = get_code


class _Reporter:
    """Plugin that writes reports, and draws the picture of a failure before anything is torn down."""

    def __init__(self, scenario: Scenario, config: pytest.Config, reports: Path) -> None:
        self._scenario = scenario
        self._config = config
        self._file = reports.open("ab")

    @pytest.hookimpl(tryfirst=True, optionalhook=True)
    def pytest_timeout_set_timer(self) -> bool:
        """Start no timer of pytest-timeout: the pytest that waits for this process has one."""
        return True

    @pytest.hookimpl(tryfirst=True, optionalhook=True)
    def pytest_timeout_cancel_timer(self) -> bool:
        """Cancel none."""
        return True

    @pytest.hookimpl(wrapper=True)
    def pytest_pyfunc_call(self) -> Any:
        """Fail a test that has passed, but broke a requirement."""
        result = yield
        self._scenario.check()
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
        """Draw a picture of a failure."""
        report = yield
        if report.failed and call.when != "teardown":
            from daidalos.testing.pictures import draw_failure

            draw_failure(self._scenario, self._scenario.folder / PICTURE, item.name)
        if call.when == "call":
            # JUnit's writer takes those of the last report, pytest's own hooks those of this one.
            properties = [("simulated_s", round(self._scenario.now, 6)), *sorted(self._scenario.metrics.items())]
            report.user_properties.extend(properties)
            item.user_properties.extend(properties)
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Write a report."""
        self._write(self._config.hook.pytest_report_to_serializable(config=self._config, report=report))

    def pytest_sessionfinish(self) -> None:
        """Close the bag while there is still something that takes the output of programs."""
        self._scenario.end()

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Write why the test could not be collected."""
        if report.failed:
            self._write({"error": str(report.longrepr)})

    def pytest_internalerror(self, excrepr: Any) -> None:
        """Write an error of pytest itself."""
        self._write({"error": str(excrepr)})

    def _write(self, data: Any) -> None:
        pickle.dump(data, self._file)
        self._file.flush()
