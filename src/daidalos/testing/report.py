"""Report of a fleet as a page: success, times and distances, worst cases, comparison with another version."""

from __future__ import annotations

import base64
import html
import statistics
from collections.abc import Callable, Sequence
from pathlib import Path

from daidalos.testing.journal import Record
from daidalos.testing.statistics import compare_shares, compare_values, wilson_interval

_WORST = 6
_SIGNIFICANT = 0.05
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 62rem; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { border: 1px solid #ccc; padding: .3rem .7rem; text-align: right; }
th:first-child, td:first-child { text-align: left; }
pre { background: #f4f4f4; padding: .7rem; overflow-x: auto; }
img { max-width: 24rem; display: block; }
.share { font-size: 2rem; }
svg { background: #fafafa; border: 1px solid #ddd; }
"""


def write_report(path: Path, title: str, records: Sequence[Record], folder: Path, other: Sequence[Record] = ()) -> None:
    """Write the page.

    Parameters
    ----------
    path : Path
        The file.
    title : str
        Of the scenario.
    records : sequence of Record
    folder : Path
        Below which the pictures of the records are.
    other : sequence of Record
        Results of another version, to compare with.
    """
    parts = [
        "<!doctype html><html lang='en'><meta charset='utf-8'>",
        f"<title>{html.escape(title)}</title><style>{_STYLE}</style><h1>{html.escape(title)}</h1>",
        _success(records),
        _measures(records),
        _parameters(records),
        _comparison(records, other) if other else "",
        _worst(records, folder, title),
    ]
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")


def summary(records: Sequence[Record]) -> str:
    """Return success with its confidence interval in one line."""
    passed = sum(record.passed for record in records)
    low, high = wilson_interval(passed, len(records))
    share = passed / len(records) if records else 0.0
    return f"{passed} of {len(records)} runs passed: {share:.1%}, with 95 % confidence {low:.1%} to {high:.1%}"


def measures(records: Sequence[Record]) -> dict[str, Callable[[Record], float | None]]:
    """Return what was measured in the runs that passed, by name."""
    names = list(dict.fromkeys(name for record in records for name in record.metrics))
    functions: dict[str, Callable[[Record], float | None]] = {
        name: lambda record, name=name: record.metrics.get(name)  # type: ignore[misc]
        for name in names
    }
    return functions | {"computing time [s]": lambda record: record.real_s}


def _success(records: Sequence[Record]) -> str:
    return f"<p class='share'>{html.escape(summary(records))}</p>"


def _values(records: Sequence[Record], of: Callable[[Record], float | None]) -> list[float]:
    return [value for record in records if record.passed and (value := of(record)) is not None]


def _measures(records: Sequence[Record]) -> str:
    rows = []
    for name, of in measures(records).items():
        values = _values(records, of)
        if len(values) > 1:
            cuts = statistics.quantiles(values, n=20, method="inclusive")
            cells = [min(values), statistics.median(values), statistics.fmean(values), cuts[18], max(values)]
            rows.append((name, *(f"{cell:.4g}" for cell in cells)))
    head = ("runs that passed", "least", "median", "mean", "95 %", "greatest")
    return _table(head, rows) if rows else ""


def _parameters(records: Sequence[Record]) -> str:
    """Return for each varied number how success depends on it, in five parts of its range."""
    parts = []
    for name in dict.fromkeys(name for record in records for name in record.parameters):
        values = [(record.parameters.get(name), record.passed) for record in records]
        numbers = [(float(value), passed) for value, passed in values if isinstance(value, int | float)]
        if len(numbers) < len(values) or len({value for value, _ in numbers}) < 3:
            rows = _share_rows([(str(value), passed) for value, passed in values])
        else:
            low, high = min(value for value, _ in numbers), max(value for value, _ in numbers)
            width = (high - low) / 5
            bins = [(min(4, int((value - low) / width)), passed) for value, passed in numbers]
            labels = [f"{low + k * width:.3g} to {low + (k + 1) * width:.3g}" for k in range(5)]
            rows = _share_rows([(labels[k], passed) for k, passed in sorted(bins)])
        parts.append(_table((name, "runs", "passed", "95 % confidence"), rows))
    return "\n".join(parts)


def _share_rows(values: Sequence[tuple[str, bool]]) -> list[tuple[str, ...]]:
    groups: dict[str, list[bool]] = {}
    for label, passed in values:
        groups.setdefault(label, []).append(passed)
    rows: list[tuple[str, ...]] = []
    for label, outcomes in groups.items():
        low, high = wilson_interval(sum(outcomes), len(outcomes))
        share = sum(outcomes) / len(outcomes)
        rows.append((label, str(len(outcomes)), f"{share:.1%}", f"{low:.1%} to {high:.1%}"))
    return rows


def comparison(records: Sequence[Record], other: Sequence[Record]) -> list[tuple[str, str, str, float]]:
    """Return rows of name, both values and p-value that compare these results with those of another version."""
    mine, theirs = (sum(record.passed for record in one) for one in (records, other))
    p = compare_shares((mine, len(records)), (theirs, len(other)))
    rows = [("success", f"{mine / max(1, len(records)):.1%}", f"{theirs / max(1, len(other)):.1%}", p)]
    for name, of in measures(records).items():
        first, second = _values(records, of), _values(other, of)
        if first and second:
            medians = f"{statistics.median(first):.4g}", f"{statistics.median(second):.4g}"
            rows.append((f"{name}, median", *medians, compare_values(first, second)))
    return rows


def _comparison(records: Sequence[Record], other: Sequence[Record]) -> str:
    rows = [
        (name, first, second, f"{p:.3g}", "yes" if p < _SIGNIFICANT else "no")
        for name, first, second, p in comparison(records, other)
    ]
    head = ("compared", "this version", "the other one", "p", "differs (p &lt; 0.05)")
    tests = "Success by Fisher's exact test, the rest by the test of Mann and Whitney."
    return f"<h2>Comparison</h2>{_table(head, rows)}<p>{tests}</p>"


def _worst(records: Sequence[Record], folder: Path, title: str) -> str:
    """Return the runs that failed, the earliest first, or those that took longest."""
    failed = sorted((record for record in records if not record.passed), key=lambda record: record.simulated_s)
    slowest = sorted((record for record in records if record.passed), key=lambda record: -record.simulated_s)
    parts = ["<h2>Worst cases</h2>"]
    for record in [*failed, *slowest][:_WORST]:
        setting = " ".join(f"--set {name}={value}" for name, value in record.parameters.items())
        command = f"daidalos scenario run {title} --seed {record.seed} {setting}".rstrip()
        state = "failed" if not record.passed else "passed"
        parts.append(f"<h3>Run {record.number}: {state} at {record.simulated_s:g} s</h3>")
        parts.append(f"<pre>{html.escape(command)}\n\n{html.escape(record.message)}</pre>")
        for picture in sorted((folder / record.folder).glob("*.png")) if record.folder else ():
            data = base64.b64encode(picture.read_bytes()).decode()
            parts.append(f"<img alt='run {record.number}' src='data:image/png;base64,{data}'>")
    return "\n".join(parts)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    cells = "".join(f"<th>{cell}</th>" for cell in head)
    lines = ["<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows]
    return f"<table><tr>{cells}</tr>{''.join(lines)}</table>"
