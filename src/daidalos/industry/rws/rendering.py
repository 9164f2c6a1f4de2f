"""Items of resources as the two versions of Robot Web Services write them: XHTML, and JSON in HAL."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape

from daidalos.industry.rws.resources import Item

XHTML = "application/xhtml+xml"
JSON_2 = "application/hal+json;v=2.0"
XHTML_2 = "application/xhtml+xml;v=2.0"


def as_json(items: Sequence[Item], base: str, path: str, version: int) -> str:
    """Return items as JSON."""
    state = [{"_type": one.kind, "_title": one.title, **one.values} for one in items]
    document: dict[str, object] = {"_links": {"base": {"href": base}, "self": {"href": path}}}
    if version == 1:
        document["_embedded"] = {"_state": state}
    elif any(one.kind.endswith("-li") for one in items):
        document["_embedded"] = {"resources": state}
    else:
        document["state"] = state
    return json.dumps(document)


def as_xhtml(items: Sequence[Item], base: str, path: str) -> str:
    """Return items as XHTML."""
    entries = "".join(_entry(one, path) for one in items)
    return _page("state", base, f'<a href="{escape(path)}" rel="self"></a><ul>{entries}</ul>')


def event(items: Sequence[Item], base: str, group: str) -> str:
    """Return items that have changed as the message of a subscription."""
    entries = "".join(_entry(one, one.path) for one in items)
    return _page("Event", base, f'<a href="{escape(group)}" rel="group"></a><ul>{entries}</ul>')


def failure(code: int, message: str, is_json: bool) -> str:
    """Return an error."""
    if is_json:
        return json.dumps({"status": {"code": code, "msg": message}})
    inner = f'<span class="code">{code}</span><span class="msg">{escape(message)}</span>'
    return _page("status", "/", f'<div class="status">{inner}</div>')


def _entry(item: Item, path: str) -> str:
    values = "".join(f'<span class="{escape(name)}">{escape(value)}</span>' for name, value in item.values.items())
    link = f'<a href="{escape(path)}" rel="self"></a>'
    return f'<li class="{escape(item.kind)}" title="{escape(item.title)}">{link}{values}</li>'


def _page(title: str, base: str, body: str) -> str:
    return (
        '<?xml version="1.0" encoding="UTF-8"?><html xmlns="http://www.w3.org/1999/xhtml">'
        f'<head><title>{title}</title><base href="{escape(base)}"/></head>'
        f'<body><div class="state">{body}</div></body></html>'
    )
