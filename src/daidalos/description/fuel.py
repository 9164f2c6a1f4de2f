"""Lookup of Gazebo Fuel models, by URI, among those that Gazebo's tools downloaded."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote

# https://server/1.0/owner/models/name, then a version, then a file of the model; only the first part is a must.
_ADDRESS = re.compile(
    r"https?://(?P<server>[^/]+)/(?:[\d.]+/)?(?P<owner>[^/]+)/(?P<kind>models|worlds)/(?P<name>[^/]+)"
    r"(?:/(?P<version>\d+|tip))?(?:/files)?(?:/(?P<inside>.*))?"
)
_SERVERS = ("fuel.gazebosim.org", "fuel.ignitionrobotics.org")
"""Two names of the same server."""


def fuel_candidates(uri: str, model_path: Sequence[Path] = ()) -> Iterator[Path]:
    """Yield the possible locations of a URI's model or file on this machine; nothing is downloaded.

    These are the cache of Fuel's tools, laid out as server, owner, ``models``, name and version, all in small
    letters; and the folders of models, where it goes by its name, or as Gazebo classic writes such a name:
    ``Ground Plane`` as ``ground_plane``.

    Parameters
    ----------
    uri : str
        ``https://fuel.gazebosim.org/1.0/owner/models/name``, perhaps with a version, ``files`` and a path.
    model_path : sequence of Path
        Folders that hold models.
    """
    address = _ADDRESS.fullmatch(uri.strip())
    if address is None:
        return
    name, inside = unquote(address["name"]), unquote(address["inside"] or "")
    for cache in fuel_caches():
        for server in dict.fromkeys((address["server"], *(_SERVERS if address["server"] in _SERVERS else ()))):
            folder = cache / server / unquote(address["owner"]).lower() / address["kind"] / name.lower()
            yield from (version / inside for version in _versions(folder, address["version"]))
    for folder in model_path:
        yield from (folder / called / inside for called in dict.fromkeys((name, re.sub(r"\W+", "_", name.lower()))))


def fuel_caches() -> list[Path]:
    """Return the folders in which Fuel's tools keep what they downloaded."""
    named = (os.environ.get(variable) for variable in ("GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"))
    home = Path.home()
    return [*(Path(folder) for folder in named if folder), home / ".gz" / "fuel", home / ".ignition" / "fuel"]


def _versions(folder: Path, wanted: str | None) -> list[Path]:
    """Return the requested version, or all of them, newest first."""
    if wanted is not None and wanted.isdigit():
        return [folder / wanted]
    found = [path for path in folder.iterdir() if path.name.isdigit()] if folder.is_dir() else []
    return sorted(found, key=lambda path: int(path.name), reverse=True)
