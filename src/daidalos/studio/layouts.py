"""HTTP handlers: files of RViz and PlotJuggler that the page opens and saves."""

from __future__ import annotations

import json
from pathlib import PurePath
from typing import Any

from aiohttp import web

from daidalos.studio.arrangement import Arrangement, ArrangementError, Display, Plot, Split, View
from daidalos.studio.plotjuggler_layout import parse_plotjuggler
from daidalos.studio.plotjuggler_writing import PlotsState, write_plotjuggler
from daidalos.studio.records import RecordError, from_json
from daidalos.studio.rviz_config import parse_rviz
from daidalos.studio.rviz_writing import RvizState, write_rviz

MAX_FILE_BYTES = 8 << 20


async def read_layout(request: web.Request) -> web.Response:
    """Return what a file asks for; its name is in the query, its text in the request."""
    name = request.query.get("name", "")
    try:
        arrangement = _parse(await request.read(), name)
    except (ArrangementError, UnicodeDecodeError) as error:
        text = f"{name}: not a text file" if isinstance(error, UnicodeDecodeError) else str(error)
        return web.Response(status=400, text=text)
    return web.json_response(arrangement.to_json())


async def write_plots(request: web.Request) -> web.Response:
    """Return the text of a layout of PlotJuggler with the plots that the page shows."""
    try:
        text = write_plotjuggler(_plots_state(json.loads(await request.read())))
    except (ArrangementError, RecordError, ValueError) as error:
        return web.Response(status=400, text=str(error))
    except RecursionError:
        return web.Response(status=400, text="the splits are nested too deeply")
    return web.Response(text=text, content_type="application/xml")


async def write_layout(request: web.Request) -> web.Response:
    """Return the text of a display configuration with what the page shows."""
    try:
        text = write_rviz(_state(json.loads(await request.read())))
    except (ArrangementError, RecordError, ValueError) as error:
        return web.Response(status=400, text=str(error))
    return web.Response(text=text, content_type="application/yaml")


def _parse(data: bytes, name: str) -> Arrangement:
    if PurePath(name).suffix.lower() == ".xml":
        return parse_plotjuggler(data, name)
    return parse_rviz(data.decode(), name)


def _state(given: Any) -> RvizState:
    if not isinstance(given, dict):
        raise RecordError("expected an object")
    state = from_json(RvizState, given)
    for display in state.displays:
        _check_settings(display)
    if state.view is not None:
        _check_view(state.view)
    return state


def _plots_state(given: Any) -> PlotsState:
    if not isinstance(given, dict) or not isinstance(given.get("tabs"), list):
        raise RecordError('expected an object with "tabs"')
    tabs = []
    for tab in given["tabs"]:
        if not isinstance(tab, list) or len(tab) != 2 or not isinstance(tab[0], str):
            raise RecordError("expected a tab to be a title and its content")
        tabs.append((tab[0], _content(tab[1])))
    span, source = given.get("span", 0.0), given.get("source", "")
    if not isinstance(span, int | float) or not isinstance(source, str):
        raise RecordError("expected the span to be a number and the source to be a text")
    return PlotsState(tuple(tabs), float(span), source)


def _content(given: Any) -> Plot | Split:
    if not isinstance(given, dict):
        raise RecordError("expected the content of a tab to be a plot or a split")
    if "parts" not in given:
        return from_json(Plot, given)
    parts, shares = given["parts"], given.get("shares")
    if not isinstance(parts, list) or not isinstance(shares, list) or not 0 < len(parts) == len(shares):
        raise RecordError("expected a split to have parts and the share of each")
    if not all(isinstance(each, int | float) and each > 0 for each in shares):
        raise RecordError("expected the shares of a split to be positive numbers")
    return Split(given.get("across") is True, tuple(shares), tuple(map(_content, parts)))


def _check_settings(display: Display) -> None:
    settings: Any = display.settings
    if not isinstance(settings, dict) or not all(
        isinstance(each, str | int | float | bool) for each in settings.values()
    ):
        raise RecordError(f'expected the settings of "{display.name}" to be texts, numbers and switches')


def _check_view(view: View) -> None:
    numbers = [*view.focus, view.distance, view.yaw, view.pitch]
    if len(view.focus) != 3 or not all(isinstance(each, int | float) for each in numbers) or view.distance <= 0:
        raise RecordError("expected the view to have a focus of three numbers, a distance, a yaw and a pitch")
