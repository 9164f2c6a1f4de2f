"""Line charts as SVG and pages as HTML, without anything that is loaded from elsewhere."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b")
_WIDTH, _HEIGHT = 720, 260
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 130, 30, 40
_MAX_POINTS = 1000
_STYLE = (
    "body{font:15px sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.25em .6em;text-align:right}"
    "td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto}"
)


def line_chart(
    title: str,
    x: NDArray[np.float64],
    series: Mapping[str, NDArray[np.float64]],
    x_label: str,
    y_label: str,
    logarithmic: bool = False,
) -> str:
    """Return a chart of lines over `x` (n,) as SVG."""
    lines = {name: np.log10(np.maximum(y, 1e-12)) if logarithmic else y for name, y in series.items()}
    return curve_chart(title, {name: (x, y) for name, y in lines.items()}, x_label, y_label, logarithmic)


def curve_chart(
    title: str,
    curves: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]],
    x_label: str,
    y_label: str,
    logarithmic: bool = False,
) -> str:
    """Return a chart of curves, each of x (n,) and y (n,), as SVG; `logarithmic` where y is a decadic logarithm."""
    curves = {name: _thinned(*curve) for name, curve in curves.items()}
    left, right = _span([x for x, _ in curves.values()], 0.0)
    low, high = _span([y for _, y in curves.values()], 0.05)

    def at(value_x: NDArray[np.float64], value_y: NDArray[np.float64]) -> str:
        columns = _LEFT + (value_x - left) / (right - left) * (_WIDTH - _LEFT - _RIGHT)
        rows = _HEIGHT - _BOTTOM - (value_y - low) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)
        return " ".join(f"{column:.1f},{row:.1f}" for column, row in zip(columns, rows, strict=True))

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img">',
        f"<title>{html.escape(title)}</title>",
        f'<text x="{_LEFT}" y="18" font-size="14" font-weight="bold">{html.escape(title)}</text>',
    ]
    for level in np.linspace(low, high, 5):
        row = at(np.array([left]), np.array([level])).split(",")[1]
        text = f"1e{level:.1f}" if logarithmic else f"{level:.4g}"
        out.append(f'<line x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{row}" y2="{row}" stroke="#ddd"/>')
        out.append(f'<text x="{_LEFT - 6}" y="{row}" font-size="11" text-anchor="end" dy="4">{text}</text>')
    for place in np.linspace(left, right, 6):
        column = at(np.array([place]), np.array([low])).split(",")[0]
        out.append(f'<text x="{column}" y="{_HEIGHT - 22}" font-size="11" text-anchor="middle">{place:.4g}</text>')
    middle = _LEFT + (_WIDTH - _LEFT - _RIGHT) / 2
    out.append(
        f'<text x="{middle}" y="{_HEIGHT - 6}" font-size="12" text-anchor="middle">{html.escape(x_label)}</text>'
    )
    out.append(
        f'<text x="14" y="{_HEIGHT / 2}" font-size="12" text-anchor="middle" '
        f'transform="rotate(-90 14 {_HEIGHT / 2})">{html.escape(y_label)}</text>'
    )
    for number, (name, (x, y)) in enumerate(curves.items()):
        colour = COLOURS[number % len(COLOURS)]
        out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="{at(x, y)}"/>')
        row_text = _TOP + 14 + 18 * number
        out.append(
            f'<text x="{_WIDTH - _RIGHT + 8}" y="{row_text}" font-size="12" fill="{colour}">{html.escape(name)}</text>'
        )
    return "\n".join([*out, "</svg>"])


def _thinned(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    every = max(len(x) // _MAX_POINTS, 1)
    return x[::every], y[::every]


def _span(values: Sequence[NDArray[np.float64]], margin: float) -> tuple[float, float]:
    """Return the least and the greatest value, with a share of their distance added, never the same twice."""
    low, high = min(float(one.min()) for one in values), max(float(one.max()) for one in values)
    pad = margin * (high - low) or (max(abs(high), 1e-9) * 0.05 if high == low else 0.0)
    return low - pad, high + pad


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table as HTML."""

    def row(tag: str, cells: Sequence[object]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"

    return "\n".join(["<table>", row("th", head), *(row("td", cells) for cells in rows), "</table>"])


def page(title: str, parts: Sequence[str]) -> str:
    """Return an HTML page of headings, texts, tables and charts."""
    head = f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
    return f"{head}<style>{_STYLE}</style></head><body>\n<h1>{html.escape(title)}</h1>\n" + "\n".join(
        [*parts, "</body></html>", ""]
    )
