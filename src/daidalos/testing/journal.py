"""Results of a fleet on the disk: a line for each run at once, and a table of Parquet in the end."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from importlib.util import find_spec
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

from daidalos.common.errors import UserError

_PLAN = "plan.json"
_LINES = "runs.jsonl"
PARQUET = "runs.parquet"
EXTRA = "pip install 'daidalos[fleet]'"


@dataclass(frozen=True)
class Record:
    """Result of a run of a fleet.

    Parameters
    ----------
    number, seed : int
    parameters : mapping
    passed : bool
    message : str
        What has failed; empty where it passed.
    simulated_s, real_s : float
        Simulated and real time that it took [s].
    metrics : mapping of float
    folder : str
        Where its picture is, below the results; empty where there is none.
    """

    number: int
    seed: int
    parameters: Mapping[str, Any]
    passed: bool
    message: str = ""
    simulated_s: float = 0.0
    real_s: float = 0.0
    metrics: Mapping[str, float] = field(default_factory=dict)
    folder: str = ""


class Identified(Protocol):
    """What results belong to, such as a `Plan`."""

    def identity(self) -> dict[str, Any]:
        """Return what makes results belong to it, as plain data."""


class Journal:
    """Results of a plan, which survive the end of the process at any time.

    Parameters
    ----------
    folder : Path
    plan : Identified

    Raises
    ------
    UserError
        When the folder has the results of another plan.
    """

    def __init__(self, folder: Path, plan: Identified) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        path, identity = folder / _PLAN, plan.identity()
        if path.is_file():
            former = json.loads(path.read_text(encoding="utf-8"))
            differing = [key for key in identity if former.get(key) != identity[key]]
            if differing:
                raise UserError(
                    f"'{folder}' has the results of another plan ({', '.join(differing)} differ); "
                    "choose another folder with --results"
                )
        else:
            path.write_text(json.dumps(identity, indent=2) + "\n", encoding="utf-8")
        self.records = {record.number: record for record in read_records(folder)}
        self._file = _open_lines(folder / _LINES)

    def add(self, record: Record) -> None:
        """Add a result; it is on the disk when this returns."""
        self.records[record.number] = record
        self._file.write(json.dumps(asdict(record)).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def write_parquet(self) -> Path | None:
        """Write all results as a table; return None where the library for it is not installed."""
        if find_spec("pyarrow") is None:
            return None
        import pyarrow
        import pyarrow.parquet

        rows = [_row(record) for record in sorted(self.records.values(), key=lambda record: record.number)]
        names = list(dict.fromkeys(name for row in rows for name in row))
        table = pyarrow.table({name: [row.get(name) for row in rows] for name in names})
        path = self.folder / PARQUET
        pyarrow.parquet.write_table(table, path)
        return path

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()


def read_records(folder: Path) -> list[Record]:
    """Return the results in a folder; a line that was not written whole does not count.

    Raises
    ------
    UserError
        When the folder has none.
    """
    path = folder / _LINES
    if not path.is_file():
        if not (folder / _PLAN).is_file():
            raise UserError(f"there are no results of a fleet in '{folder}'")
        return []
    records: dict[int, Record] = {}
    for line in path.read_bytes().split(b"\n"):
        with contextlib.suppress(ValueError, TypeError):
            record = Record(**json.loads(line))
            records[record.number] = record
    return [records[number] for number in sorted(records)]


def _open_lines(path: Path) -> Any:
    """Open the lines to add some; what is left of a broken last one gets a line of its own."""
    file = path.open("ab")
    if file.tell() and not path.read_bytes().endswith(b"\n"):
        file.write(b"\n")
    return file


def _row(record: Record) -> dict[str, Any]:
    return {
        "run": record.number,
        "seed": record.seed,
        "passed": record.passed,
        "message": record.message,
        "simulated_s": record.simulated_s,
        "real_s": record.real_s,
        **{f"parameter.{name}": value for name, value in record.parameters.items()},
        **{f"metric.{name}": value for name, value in record.metrics.items()},
    }
