"""Reader of PlotJuggler's layouts (``.xml``)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element, parse_markup
from daidalos.studio.arrangement import Arrangement, ArrangementError, Curve, Plot, Split

_INDEX = re.compile(r"\[(\d+)\]")


def read_plotjuggler(path: Path) -> Arrangement:
    """Read a layout.

    Raises
    ------
    ArrangementError
        When it is not a layout of PlotJuggler.
    OSError
        When it cannot be read.
    """
    return parse_plotjuggler(path.read_bytes(), str(path))


def parse_plotjuggler(text: bytes, path: str) -> Arrangement:
    """Parse the text of a layout; `path` is the file's, for errors.

    Raises
    ------
    ArrangementError
        When it is not a layout of PlotJuggler.
    """
    try:
        root = parse_markup(text, path)
    except DescriptionError as error:
        raise ArrangementError(path, error.line, error.message) from None
    sheets = [tab for widget in root.walk() if widget.tag == "tabbed_widget" for tab in widget.all("Tab")]
    if root.tag != "root" or not sheets:
        raise ArrangementError(path, None, "not a layout of PlotJuggler: <tabbed_widget> with a <Tab> is missing")
    left_out: list[str] = []
    tabs = []
    for number, sheet in enumerate(sheets, 1):
        container = sheet.first("Container")
        content = None if container is None else _content(container.children, left_out)
        if content is not None:
            tabs.append((sheet.attribute("tab_name", "") or f"tab{number}", content))
    left_out += [f"the custom series {snippet.attribute('name', '')}" for snippet in _snippets(root)]
    buffer = root.first("streaming_buffer_size")
    return Arrangement(tabs=tuple(tabs), span=_seconds(buffer), left_out=tuple(left_out))


def _content(elements: Sequence[Element], left_out: list[str]) -> Plot | Split | None:
    """Return what the first splitter or dock area holds; None where there is none."""
    for element in elements:
        if element.tag == "DockSplitter":
            return _split(element, left_out)
        if element.tag == "DockArea":
            plots = [_plot(plot, left_out) for plot in element.all("plot")]
            return plots[0] if plots else Plot(())
    return None


def _split(element: Element, left_out: list[str]) -> Split | Plot | None:
    parts = [part for child in element if (part := _content([child], left_out)) is not None]
    if len(parts) < 2:
        return parts[0] if parts else None
    sizes = [_share(text) for text in element.attribute("sizes", "").split(";")]
    shares = sizes if len(sizes) == len(parts) and all(size > 0 for size in sizes) else [1.0] * len(parts)
    total = sum(shares)
    across = element.attribute("orientation", "|") == "|"
    return Split(across, tuple(share / total for share in shares), tuple(parts))


def _plot(element: Element, left_out: list[str]) -> Plot:
    is_xy = element.attribute("mode", "TimeSeries") == "XYPlot"
    curves = []
    for curve in element.all("curve"):
        name = curve.attribute("name", "")
        left_out += [f"the transform {each.attribute('name', '')} of {name}" for each in curve.all("transform")]
        over, path = (curve.attribute("curve_x", ""), curve.attribute("curve_y", "")) if is_xy else ("", name)
        if path and (over or not is_xy):
            curves.append(Curve(_path(path), curve.attribute("color", ""), _path(over)))
    return Plot(tuple(curves))


def _path(name: str) -> str:
    """Return a field's path as the studio writes it: elements of arrays as /0, not [0]."""
    return _INDEX.sub(r"/\1", name)


def _snippets(root: Element) -> list[Element]:
    return [snippet for equations in root.all("customMathEquations") for snippet in equations.all("snippet")]


def _seconds(buffer: Element | None) -> float:
    return 0.0 if buffer is None else max(0.0, _share(buffer.attribute("value", "0")))


def _share(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return 0.0
