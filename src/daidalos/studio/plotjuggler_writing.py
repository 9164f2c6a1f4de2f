"""Writer of PlotJuggler's layouts: changes what the page changed, and keeps the rest as it was read."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from daidalos.description.markup import Element, parse_markup
from daidalos.studio.arrangement import Curve, Plot, Split
from daidalos.studio.plotjuggler_layout import curve_of, is_xy_plot, parse_plotjuggler, plots_of, sheets_of

_INDEX = re.compile(r"/(\d+)(?=/|$)")
_ROUNDING = 0.02
"""Shares that differ by less are those of the file, in whole pixels."""
_DECLARATION = "<?xml version='1.0' encoding='UTF-8'?>\n"
_NEW = (
    '<root><tabbed_widget name="Main Window" parent="main_window"><Tab/><currentTabIndex index="0"/></tabbed_widget>'
    '<use_relative_time_offset enabled="1"/></root>'
)


@dataclass(frozen=True)
class PlotsState:
    """The plots that the page shows, to be saved.

    Parameters
    ----------
    tabs : tuple of (str, Plot or Split)
        Titles and contents: first what the page shows side by side, then each plot that lies behind another.
    span : float
        Time span of plots over time [s]; 0: as in the source.
    source : str
        The text that was read; empty: none.
    """

    tabs: tuple[tuple[str, Plot | Split], ...]
    span: float = 0.0
    source: str = ""


def write_plotjuggler(state: PlotsState) -> str:
    """Return the text of a layout that PlotJuggler reads.

    Plots that were read from a tab behind the first one stay in that tab, with its splits.

    Raises
    ------
    ArrangementError
        When the source is not a layout.
    """
    source, name = (state.source or _NEW).encode(), "the layout to save"
    before = parse_plotjuggler(source, name)
    root = parse_markup(source, name)
    plots, (first, *others) = plots_of(root), sheets_of(root)
    (title, content), *behind = state.tabs or (("plots", Plot(())),)
    if not state.source:
        first.attributes["tab_name"] = title
    is_read_from_first = before.tabs and any(each.tag == "plot" for each in first.walk())
    _write_first(first, content, before.tabs[0][1] if is_read_from_first else None, plots)
    shown = {plot.origin for plot in _plots(content)}
    loose = [
        (name, plot) for name, each in behind for plot in _plots(each) if not plot.origin or plot.origin not in shown
    ]
    _write_others(root, others, {plot.origin: plot for _, plot in loose if plot.origin}, plots)
    present = {id(each) for each in root.walk()}
    widget = next(each for each in root.walk() if each.tag == "tabbed_widget")
    for name, plot in loose:
        if id(plots.get(plot.origin)) not in present:
            widget.children.insert(_end_of_sheets(widget), _new_sheet(name, plot, plots))
    if state.span and state.span != before.span:
        _write_span(root, state.span)
    return _DECLARATION + root.to_text()


def _write_first(sheet: Element, now: Plot | Split, before: Plot | Split | None, plots: Mapping[str, Element]) -> None:
    """Write the plots of a tab in place where they are divided as before, else with new splits."""
    if before is not None and _is_divided_alike(now, before):
        for plot in _plots(now):
            if plot.origin:
                _update(plots[plot.origin], plot)
    else:
        sheet.attributes["containers"] = "1"
        sheet.children = [_container(now, plots)]


def _is_divided_alike(now: Plot | Split, before: Plot | Split) -> bool:
    """Return whether the same plots lie at the same places, with the same sizes but for rounding."""
    if isinstance(now, Plot) or isinstance(before, Plot):
        return isinstance(now, Plot) and isinstance(before, Plot) and now.origin == before.origin
    return (
        now.across == before.across
        and len(now.parts) == len(before.parts) == len(now.shares)
        and all(abs(a - b) < _ROUNDING for a, b in zip(now.shares, before.shares, strict=True))
        and all(_is_divided_alike(a, b) for a, b in zip(now.parts, before.parts, strict=True))
    )


def _write_others(root: Element, sheets: list[Element], kept: Mapping[str, Plot], plots: Mapping[str, Element]) -> None:
    """Write the plots that stay in the tabs behind the first; remove the others, and tabs without plots for them."""
    updated = {id(plots[origin]): plot for origin, plot in kept.items() if origin in plots}
    emptied = []
    for sheet in sheets:
        there = [each for each in sheet.walk() if each.tag == "plot"]
        for each in there:
            if id(each) in updated:
                _update(each, updated[id(each)])
        for container in sheet.all("Container"):
            _prune(container, updated)
        if there and not any(id(each) in updated for each in there):
            emptied.append(id(sheet))
    for widget in root.walk():
        if widget.tag == "tabbed_widget":
            widget.children = [child for child in widget if id(child) not in emptied]


def _prune(parent: Element, kept: Mapping[int, Plot]) -> None:
    """Remove the areas without a plot to keep, and splits that divide nothing then."""
    sizes = parent.attributes.get("sizes", "").split(";")
    shares = sizes if len(sizes) == len(parent.children) else ["1"] * len(parent.children)
    sized = list(zip(parent.children, shares, strict=True))
    left = []
    for child, size in sized:
        if child.tag == "DockSplitter":
            _prune(child, kept)
            if len(child.children) == 1 and parent.tag == "DockSplitter":
                child = child.children[0]
        if child.tag != "DockSplitter" and not any(id(each) in kept for each in child.walk()):
            continue
        if child.tag != "DockSplitter" or child.children:
            left.append((child, size))
    if len(left) < len(sized) and parent.tag == "DockSplitter":
        parent.attributes |= {"count": str(len(left)), "sizes": ";".join(size for _, size in left)}
    parent.children = [child for child, _ in left]


def _new_sheet(title: str, content: Plot | Split, plots: Mapping[str, Element]) -> Element:
    return Element("Tab", {"tab_name": title, "containers": "1"}, children=[_container(content, plots)])


def _end_of_sheets(widget: Element) -> int:
    return max((place for place, child in enumerate(widget, 1) if child.tag == "Tab"), default=0)


def _container(content: Plot | Split, plots: Mapping[str, Element]) -> Element:
    """Return the content of a tab; PlotJuggler expects a splitter around a single plot."""
    whole = content if isinstance(content, Split) else Split(True, (1.0,), (content,))
    return Element("Container", children=[_divided(whole, plots)])


def _divided(content: Plot | Split, plots: Mapping[str, Element]) -> Element:
    if isinstance(content, Plot):
        plot = plots.get(content.origin) or Element("plot", {"mode": "TimeSeries", "style": "Lines"})
        _update(plot, content)
        return Element("DockArea", {"name": "..."}, children=[plot])
    attributes = {
        "orientation": "|" if content.across else "-",
        "count": str(len(content.parts)),
        "sizes": ";".join(f"{share:.6g}" for share in content.shares),
    }
    return Element("DockSplitter", attributes, children=[_divided(part, plots) for part in content.parts])


def _update(element: Element, plot: Plot) -> None:
    """Write the curves of a plot; what is not known of those that it had is kept."""
    wanted = {(curve.path, curve.over): curve for curve in plot.curves}
    is_xy = any(curve.over for curve in plot.curves)
    had_curves = any(child.tag == "curve" for child in element)
    if wanted and is_xy != is_xy_plot(element):
        element.attributes["mode"] = "XYPlot" if is_xy else "TimeSeries"
        element.children = [child for child in element if child.tag not in ("curve", "range")]
    children = []
    for child in element:
        curve = curve_of(child, is_xy=is_xy_plot(element)) if child.tag == "curve" else None
        if curve is not None:
            now = wanted.pop((curve.path, curve.over), None)
            if now is None:
                continue
            if now.color and now.color != curve.color:
                child.attributes["color"] = now.color
        children.append(child)
    element.children = children + [_new_curve(curve) for curve in wanted.values()]
    if wanted and not had_curves:
        element.children = [child for child in element if child.tag != "range"]  # that of nothing


def _new_curve(curve: Curve) -> Element:
    name = _name(curve.path)
    attributes = {"name": name, "color": curve.color or "#1f77b4"}
    if curve.over:
        attributes |= {"curve_x": _name(curve.over), "curve_y": name}
    return Element("curve", attributes)


def _name(path: str) -> str:
    """Return a field's path as PlotJuggler writes it: elements of arrays as [0], not /0."""
    return _INDEX.sub(r"[\1]", path)


def _write_span(root: Element, span: float) -> None:
    buffer = root.first("streaming_buffer_size")
    if buffer is None:
        buffer = Element("streaming_buffer_size")
        root.children.append(buffer)
    buffer.attributes["value"] = f"{span:g}"


def _plots(content: Plot | Split) -> Iterator[Plot]:
    if isinstance(content, Plot):
        yield content
    else:
        for part in content.parts:
            yield from _plots(part)
