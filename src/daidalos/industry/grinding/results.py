"""Files of results of grinding: figures, records, workpieces and reports, and the comparison of two of them."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.documents import parse_json, read_text
from daidalos.common.errors import UserError
from daidalos.industry.grinding.height_field import as_arrays
from daidalos.industry.grinding.records import ForceFigures, Record, record_bytes
from daidalos.industry.grinding.report import force_report, job_report
from daidalos.industry.grinding.tasks import Job, job_figures
from daidalos.industry.welding.results import write_new

FIGURES = "figures.json"


def write_force_test(
    records: Mapping[str, Record], figures: Mapping[str, ForceFigures], problems: Mapping[str, str], folder: Path
) -> list[Path]:
    """Write figures, records and report of force tests by controller to a folder, and return the files.

    Raises
    ------
    UserError
        Where one of the files is there already.
    """
    content: dict[str, str | bytes] = {
        FIGURES: _text({"task": "force", **force_json(figures, problems)}),
        "report.html": force_report(records, figures),
    }
    content |= {f"{name}.npz": record_bytes(record.thinned()) for name, record in records.items()}
    return write_new(folder, content)


def force_json(figures: Mapping[str, ForceFigures], problems: Mapping[str, str]) -> dict[str, Any]:
    """Return the figures of force tests by controller."""
    return {
        "controllers": {
            name: one.as_json() | {"within_goals": one.is_within_goals, "problem": problems[name]}
            for name, one in figures.items()
        }
    }


def write_job(job: Job, folder: Path) -> list[Path]:
    """Write figures, records, the workpiece as scanned at the end, and a report to a folder; return the files.

    Raises
    ------
    UserError
        Where one of the files is there already.
    """
    stream = io.BytesIO()
    np.savez_compressed(stream, **as_arrays(job.end))  # type: ignore[arg-type]
    content: dict[str, str | bytes] = {FIGURES: _text(job_figures(job)), "report.html": job_report(job)}
    content["workpiece.npz"] = stream.getvalue()
    content |= {f"pass_{number}.npz": record_bytes(one.record) for number, one in enumerate(job.passes, 1)}
    return write_new(folder, content)


def compared(first: Path, second: Path) -> list[tuple[str, Any, Any]]:
    """Return name and values of each figure that two results have: folders, or their `figures.json`.

    Raises
    ------
    UserError
        Where one of them is none, or they are of different tasks.
    """
    one, two = _read(first), _read(second)
    if one["task"] != two["task"]:
        raise UserError(f"{second}: is of the task '{two['task']}', but {first} of '{one['task']}'")
    left, right = (dict(_flat(content, "")) for content in (one, two))
    return [(name, left.get(name), right.get(name)) for name in dict.fromkeys([*left, *right]) if name != "task"]


def _read(path: Path) -> dict[str, Any]:
    file = path / FIGURES if path.is_dir() else path
    if not file.is_file():
        raise UserError(f"{file}: there is no such file")
    content = parse_json(read_text(file), str(file))
    if not isinstance(content, dict) or not isinstance(content.get("task"), str):
        raise UserError(f"{file}: has no figures of grinding")
    return content


def _flat(content: Any, before: str) -> list[tuple[str, Any]]:
    if isinstance(content, dict):
        return [pair for name, value in content.items() for pair in _flat(value, f"{before}{name}.")]
    if isinstance(content, list):
        return [pair for number, value in enumerate(content, 1) for pair in _flat(value, f"{before}{number}.")]
    return [(before.removesuffix("."), content)]


def _text(content: Any) -> str:
    return json.dumps(content, indent=1) + "\n"
