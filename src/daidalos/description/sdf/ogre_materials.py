"""Material scripts of the OGRE engine, as used by Gazebo classic's models: colours and one texture."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from daidalos.description.link import Rgba

_COLORS = ("ambient", "diffuse", "emissive")


@dataclass(frozen=True)
class OgreMaterial:
    """Material of a script; None for values that it does not set."""

    ambient: Rgba | None = None
    diffuse: Rgba | None = None
    emissive: Rgba | None = None
    texture: Path | None = None


def find_material(name: str, places: Sequence[Path]) -> OgreMaterial | None:
    """Return the material with a name.

    Parameters
    ----------
    name : str
    places : sequence of Path
        Scripts, and folders of scripts and textures.
    """
    if not name:
        return None
    for script in _files(places, "*.material"):
        properties = _materials(script, script.stat().st_mtime_ns).get(name)
        if properties is not None:
            folders = [place if place.is_dir() else place.parent for place in places]
            return _material(properties, [*folders, script.parent, script.parent.parent / "textures"])
    return None


def _files(places: Iterable[Path], pattern: str) -> list[Path]:
    return [path for place in places for path in (sorted(place.glob(pattern)) if place.is_dir() else [place])]


@lru_cache(maxsize=64)
def _materials(script: Path, _modified: int) -> dict[str, dict[str, list[str]]]:
    """Return the properties of each material; the first value of a property is that of the first pass."""
    text = re.sub(r"//.*|/\*[\s\S]*?\*/", "", script.read_text(encoding="utf-8", errors="replace"))
    found: dict[str, dict[str, list[str]]] = {}
    bases: dict[str, str] = {}
    for head, body in _blocks(text):
        name, _, base = (part.strip() for part in head.removeprefix("material").partition(":"))
        bases[name] = base
        properties = found.setdefault(name, {})
        for line in body.splitlines():
            key, *values = line.split() or [""]
            properties.setdefault(key, values)
    return {name: found.get(bases[name], {}) | properties for name, properties in found.items()}


def _blocks(text: str) -> Iterable[tuple[str, str]]:
    """Yield the head and the body of each material."""
    for head in re.finditer(r"^\s*(material\s[^{\n]*)\s*\{", text, re.MULTILINE):
        depth, end = 1, head.end()
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        yield head.group(1).strip(), text[head.end() : end]


def _material(properties: dict[str, list[str]], folders: Iterable[Path]) -> OgreMaterial:
    ambient, diffuse, emissive = (_color(properties.get(key, [])) for key in _COLORS)
    image = " ".join(properties.get("texture", [])[:1])
    texture = next((folder / image for folder in folders if image and (folder / image).is_file()), None)
    return OgreMaterial(ambient, diffuse, emissive, texture)


def _color(words: list[str]) -> Rgba | None:
    try:
        values = [float(word) for word in words[:4]]
    except ValueError:
        return None
    if len(values) < 3:
        return None
    return values[0], values[1], values[2], values[3] if len(values) > 3 else 1.0
