"""Scenarios as the pytest that found them sees them: a process carries each out, and its reports come back."""

from __future__ import annotations

import pickle
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest

from daidalos.common.suggestions import hint
from daidalos.testing.plugin import TIMEOUT_S
from daidalos.testing.processes import ScenarioProcess, scenario_environment
from daidalos.testing.server import Request
from daidalos.testing.single import slug

_MARK = {"timeout": TIMEOUT_S, "seed": 0, "world": None, "robot": None, "record": True, "pictures": False}
_OF_THE_SESSION: dict[str, Any] = {
    "collectonly": False, "deselect": None, "dist": "no", "distload": False, "failedfirst": False,
    "keyword": "", "lf": False, "looponfail": False, "markexpr": "", "maxfail": 0, "maxprocesses": None,
    "newfirst": False, "numprocesses": None, "reruns": None, "setuponly": False, "setupplan": False,
    "stepwise": False, "timeout": 0, "tx": [], "usepdb": False, "xmlpath": None, "durations": None,
    "cov_source": None, "pyargs": False, "ignore": None, "ignore_glob": None, "pastebin": None, "report_log": None,
}  # fmt: skip
"""Options that concern all tests rather than one, and their values for one."""

_ALREADY_IMPORTED = "ignore::pytest.PytestAssertRewriteWarning"


class ScenarioRunner:
    """Runner of the scenarios of a session.

    Parameters
    ----------
    config : pytest.Config
    """

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._process = ScenarioProcess("pytest")
        self._folder = Path(tempfile.mkdtemp(prefix="daidalos-scenarios-"))

    def close(self) -> None:
        """End the process."""
        self._process.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def run(self, item: pytest.Item) -> None:
        """Run the protocol of a test."""
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in self._reports(item):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)

    def _reports(self, item: pytest.Item) -> list[pytest.TestReport]:
        folder = Path(tempfile.mkdtemp(dir=self._folder))
        began = time.perf_counter()
        outcome: list[tuple[int, Request]] = []
        call = pytest.CallInfo.from_call(lambda: outcome.append(self._carry_out(item, folder)), "call")
        if call.excinfo is not None:
            return [pytest.TestReport.from_item_and_call(item, call)]
        (status, request), lines = outcome[0], _read_reports(folder / "reports")
        reports: list[pytest.TestReport] = []
        for data in lines:
            if "error" in data:
                return [self._failed(item, data["error"])]
            report = self._config.hook.pytest_report_from_serializable(config=self._config, data=data)
            if report.nodeid.rpartition("/")[2] == item.nodeid.rpartition("/")[2]:
                report.nodeid, report.location = item.nodeid, item.location
            reports.append(report)
        for report in reports:
            if report.when == "call":
                report.duration = time.perf_counter() - began
        if not any(report.when == "teardown" for report in reports):
            reports.append(self._failed(item, _explain_end(status, folder)))
        self._keep(item, request, folder, reports)
        return reports

    def _carry_out(self, item: pytest.Item, folder: Path) -> tuple[int, Request]:
        request = self._request(item, folder)
        return self._process.run(request), request

    def _request(self, item: pytest.Item, folder: Path) -> Request:
        settings = self._settings(item)
        seed = self._config.getoption("--scenario-seed")
        path, separator, rest = item.nodeid.partition("::")
        inifile = self._config.inipath
        return Request(
            target="daidalos.testing.child:run_test",
            arguments={
                "node_id": f"{item.path if item.path.is_file() else path}{separator}{rest}",
                "options": self._options(),
                "inifile": None if inifile is None else str(inifile),
                "reports": str(folder / "reports"),
            },
            seed=settings["seed"] if seed is None else seed,
            timeout=float(settings["timeout"]),
            folder=str(folder),
            cwd=str(Path.cwd()),
            environ=scenario_environment(),
            path=tuple(sys.path),
            record=bool(settings["record"]),
            pictures=bool(settings["pictures"]),
        )

    def _settings(self, item: pytest.Item) -> dict[str, Any]:
        mark = item.get_closest_marker("scenario")
        given = {} if mark is None else dict(mark.kwargs)
        for name in given:
            if name not in _MARK:
                pytest.fail(f"{item.nodeid}: the mark 'scenario' has no '{name}'{hint(name, _MARK)}", pytrace=False)
        return _MARK | given

    def _options(self) -> dict[str, Any]:
        """Return the options of this session as they are for one test, as far as they can be sent."""
        options = {name: value for name, value in vars(self._config.option).items() if _can_be_sent(value)}
        options.update({name: value for name, value in _OF_THE_SESSION.items() if name in options})
        options["plugins"] = [*(options.get("plugins") or []), "no:terminal", "no:cacheprovider", "no:xdist"]
        options["basetemp"] = None
        options.pop("file_or_dir", None)
        # What the scenarios' process has imported already needs no assertions that explain themselves.
        options["pythonwarnings"] = [*(options.get("pythonwarnings") or []), _ALREADY_IMPORTED]
        options["rootdir"] = str(self._config.rootpath)
        return options

    def _failed(self, item: pytest.Item, text: str) -> pytest.TestReport:
        return pytest.TestReport(item.nodeid, item.location, {}, "failed", text, "call")

    def _keep(self, item: pytest.Item, request: Request, folder: Path, reports: list[pytest.TestReport]) -> None:
        """Keep the bag and the picture of a failure, and add to the report how to look at them."""
        failed = [report for report in reports if report.failed]
        if not failed and not self._config.getoption("--scenario-keep"):
            shutil.rmtree(folder, ignore_errors=True)
            return
        results = self._config.rootpath / self._config.getoption("--scenario-results")
        goal = results / slug(item.nodeid)
        shutil.rmtree(goal, ignore_errors=True)
        results.mkdir(parents=True, exist_ok=True)
        (folder / "reports").unlink(missing_ok=True)
        shutil.move(folder, goal)
        shown = goal.relative_to(Path.cwd()) if goal.is_relative_to(Path.cwd()) else goal
        lines = [f"seed {request.seed}; the same seed gives the same run"]
        lines += [f"picture: {shown / picture.name}" for picture in sorted(goal.glob("*.png"))]
        if (goal / "bag").is_dir():
            lines.append(f"look at it in the studio: daidalos scenario show {shown}")
        for report in failed[:1]:
            report.sections.append(("scenario", "\n".join(lines)))


def _can_be_sent(value: Any) -> bool:
    try:
        pickle.loads(pickle.dumps(value))
    except Exception:  # whatever an object of another plugin raises
        return False
    return True


def _read_reports(path: Path) -> list[dict[str, Any]]:
    if not path.is_file():
        return []
    found = []
    with path.open("rb") as file:
        while file.peek(1):
            found.append(pickle.load(file))
    return found


def _explain_end(status: int, folder: Path) -> str:
    what = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
    return f"the process of the scenario {what} before the test had ended; its output says why"
