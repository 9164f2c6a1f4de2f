"""The built page's files, and which files of a folder browsers may have."""

from __future__ import annotations

from pathlib import Path

STATIC = Path(__file__).resolve().parent / "static"
BUILT_IN_EXTENSIONS = "built_in.json"
"""File of the built page: what its own panels and displays do, by name."""
GZIP = ".gz"
"""What the names of compressed files have at their end."""

# The registry of a system may name other types, which browsers refuse for modules and workers.
CONTENT_TYPES = {
    ".css": "text/css",
    ".html": "text/html",
    ".ico": "image/vnd.microsoft.icon",
    ".js": "text/javascript",
    ".mjs": "text/javascript",
    ".ts": "text/plain",
    ".json": "application/json",
    ".map": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
    ".woff2": "font/woff2",
}


def find_file(folder: Path, path: str, packed: str = "") -> Path | None:
    """Return the file of a path below a folder that browsers may have; None where there is none.

    With `packed`, such as ``.gz``, return the compressed file that has this suffix besides.
    """
    parts = [part for part in path.split("/") if part] or ["index.html"]
    if any(part.startswith(".") or "\\" in part or ":" in part for part in parts):
        return None
    found = folder.joinpath(*parts[:-1], parts[-1] + packed)
    try:
        inside = found.resolve().is_relative_to(folder.resolve())
        return found if inside and Path(parts[-1]).suffix in CONTENT_TYPES and found.is_file() else None
    except (OSError, ValueError, RuntimeError):  # a name that no file can have, or a link to itself
        return None
