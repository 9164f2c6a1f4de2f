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
    sheets = sheets_of(root)
    if root.tag != "root" or not sheets:
        raise ArrangementError(path, None, "not a layout of PlotJuggler: <tabbed_widget> with a <Tab> is missing")
    reader = _PlotReader(root)
    tabs = []
    for number, sheet in enumerate(sheets, 1):
        content = reader.content_of(sheet)
        if content is not None:
            tabs.append((sheet.attribute("tab_name", "") or f"tab{number}", content))
    left_out = [*reader.left_out, *(f"the custom series {each.attribute('name', '')}" for each in _snippets(root))]
    buffer = root.first("streaming_buffer_size")
    source = text.decode(errors="replace")
    return Arrangement(tabs=tuple(tabs), span=_seconds(buffer), left_out=tuple(left_out), source=source)


def sheets_of(root: Element) -> list[Element]:
    """Return the elements of the tabs of all windows."""
    return [tab for widget in root.walk() if widget.tag == "tabbed_widget" for tab in widget.all("Tab")]


def plots_of(root: Element) -> dict[str, Element]:
    """Return the elements of the plots by their origins."""
    return {str(number): plot for number, plot in enumerate(each for each in root.walk() if each.tag == "plot")}


def curve_of(element: Element, *, is_xy: bool) -> Curve | None:
    """Return what the element of a curve asks for; None where it has no paths."""
    name = element.attribute("name", "")
    over, path = (element.attribute("curve_x", ""), element.attribute("curve_y", "")) if is_xy else ("", name)
    return Curve(_path(path), element.attribute("color", ""), _path(over)) if path and (over or not is_xy) else None


def is_xy_plot(plot: Element) -> bool:
    """Return whether a plot draws fields over fields."""
    return plot.attribute("mode", "TimeSeries") == "XYPlot"


class _PlotReader:
    """Reader of the plots of tabs; keeps what the studio does not have."""

    def __init__(self, root: Element) -> None:
        self.left_out: list[str] = []
        self._origins = {id(plot): origin for origin, plot in plots_of(root).items()}

    def content_of(self, sheet: Element) -> Plot | Split | None:
        """Return what a tab has; None where it is empty."""
        container = sheet.first("Container")
        return None if container is None else self._content(container.children)

    def _content(self, elements: Sequence[Element]) -> Plot | Split | None:
        """Return what the first splitter or dock area holds; None where there is none."""
        for element in elements:
            if element.tag == "DockSplitter":
                return self._split(element)
            if element.tag == "DockArea":
                plots = [self._plot(plot) for plot in element.all("plot")]
                return plots[0] if plots else Plot(())
        return None

    def _split(self, element: Element) -> Split | Plot | None:
        parts = [part for child in element if (part := self._content([child])) is not None]
        if len(parts) < 2:
            return parts[0] if parts else None
        sizes = [_share(text) for text in element.attribute("sizes", "").split(";")]
        shares = sizes if len(sizes) == len(parts) and all(size > 0 for size in sizes) else [1.0] * len(parts)
        total = sum(shares)
        across = element.attribute("orientation", "|") == "|"
        return Split(across, tuple(share / total for share in shares), tuple(parts))

    def _plot(self, element: Element) -> Plot:
        is_xy = is_xy_plot(element)
        curves = []
        for each in element.all("curve"):
            name = each.attribute("name", "")
            self.left_out += [f"the transform {kind.attribute('name', '')} of {name}" for kind in each.all("transform")]
            curve = curve_of(each, is_xy=is_xy)
            if curve is not None:
                curves.append(curve)
        return Plot(tuple(curves), self._origins[id(element)])


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
