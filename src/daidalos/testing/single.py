"""One run of a scenario with a seed and parameters of its own, in lock-step."""

from __future__ import annotations

import json
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.testing.documents import Document, read_scenario
from daidalos.testing.journal import Record
from daidalos.testing.plan import Run
from daidalos.testing.processes import ScenarioProcess, scenario_environment
from daidalos.testing.server import Request

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

PICTURES = "failures"
RESULT = "result.json"


@dataclass(frozen=True)
class Result:
    """Result of one run.

    Parameters
    ----------
    passed : bool
    message : str
        What has failed; empty where it passed.
    simulated_s : float
        Simulated time at the end [s].
    metrics : mapping of float
        What was measured, by name.
    folder : Path or None
        Where the bag and the picture are; None where they are not kept.
    """

    passed: bool
    message: str = ""
    simulated_s: float = 0.0
    metrics: Mapping[str, float] = field(default_factory=dict)
    folder: Path | None = None


def run_once(
    process: ScenarioProcess,
    document: Document,
    seed: int,
    parameters: Mapping[str, Any],
    results: Path,
    *,
    record: bool = True,
) -> Result:
    """Run a scenario once; the bag and the picture of a failure are kept below a folder.

    Parameters
    ----------
    process : ScenarioProcess
    document : Document
    seed : int
    parameters : mapping
        In place of those of the file.
    results : Path
        The folder.
    record : bool
        Whether to record a bag; where not, the output is written to a file beside the picture.
    """

    def request_of(folder: Path) -> Request:
        return Request(
            "daidalos.testing.single:perform",
            {"path": str(document.path.resolve()), "result": str(folder / RESULT)},
            seed,
            document.timeout,
            str(folder),
            str(Path.cwd()),
            scenario_environment(),
            tuple(sys.path),
            dict(parameters),
            record,
            pictures=document.pictures,
            quiet=not record,
        )

    return carry_out(process, request_of, results / f"{slug(document.name)}-{seed}")


def carry_out(process: ScenarioProcess, request_of: Callable[[Path], Request], kept: Path) -> Result:
    """Carry out a request that writes a report; see `write_report`.

    Parameters
    ----------
    process : ScenarioProcess
    request_of : callable
        Returns the request, given the folder for its files; it writes its report to `RESULT` there.
    kept : Path
        Where the folder is copied to if the scenario fails.
    """
    folder = Path(tempfile.mkdtemp(prefix="daidalos-scenario-"))
    try:
        result = _read_result(folder / RESULT, process.run(request_of(folder)))
        if result.passed:
            return result
        shutil.rmtree(kept, ignore_errors=True)
        kept.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(folder, kept)
        return Result(False, result.message, result.simulated_s, result.metrics, kept)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def run_one(process: ScenarioProcess, scenario: Path, run: Run, folder: Path) -> Record:
    """Carry out one run of a fleet in a process; its picture is kept below a folder where it fails."""
    begun = time.perf_counter()
    document = read_scenario(scenario, run.parameters)
    result = run_once(process, document, run.seed, run.parameters, folder / PICTURES, record=False)
    return Record(
        run.number,
        run.seed,
        dict(run.parameters),
        result.passed,
        result.message,
        result.simulated_s,
        round(time.perf_counter() - begun, 3),
        dict(result.metrics),
        "" if result.folder is None else result.folder.relative_to(folder).as_posix(),
    )


def slug(name: str) -> str:
    """Return a name as that of a folder."""
    return re.sub(r"[^\w.=-]+", "-", name).strip("-")


def _read_result(path: Path, status: int) -> Result:
    if not path.is_file():
        what = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
        return Result(False, f"the process of the scenario {what}; its output says why")
    data = json.loads(path.read_text(encoding="utf-8"))
    path.unlink()
    return Result(data["passed"], data["message"], data["simulated_s"], data["metrics"])


def perform(scenario: Scenario, path: str, result: str) -> int:
    """Run the scenario of a file, and write its result as JSON; called in the process of the scenario."""
    from daidalos.testing.steps import run_document

    write_report(scenario, lambda: run_document(scenario, path), Path(path).name, Path(result))
    return 0


def write_report(scenario: Scenario, body: Callable[[], None], title: str, result: Path) -> None:
    """Run a scenario's body, and write what came of it as JSON; draw a picture of a failure.

    Parameters
    ----------
    scenario : Scenario
    body : callable
    title : str
        Of the picture.
    result : Path
    """
    from daidalos.common.errors import UserError
    from daidalos.testing.pictures import draw_failure
    from daidalos.testing.scenario import ScenarioFailure

    message = ""
    try:
        body()
        scenario.check()
    except (ScenarioFailure, UserError) as failure:
        message = str(failure)
        draw_failure(scenario, scenario.folder / "failure.png", title)
    report = {
        "passed": not message,
        "message": message,
        "simulated_s": round(scenario.now, 6),
        "metrics": scenario.metrics,
    }
    result.write_text(json.dumps(report), encoding="utf-8")
