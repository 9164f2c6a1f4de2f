"""Graphs that tests route through."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


def node(identifier: int, x: float, y: float, **properties: Any) -> dict[str, Any]:
    return {
        "type": "Feature", "properties": {"id": identifier, **properties},
        "geometry": {"type": "Point", "coordinates": [x, y]},
    }  # fmt: skip


def edge(identifier: int, start: int, end: int, **properties: Any) -> dict[str, Any]:
    return {
        "type": "Feature", "properties": {"id": identifier, "startid": start, "endid": end, **properties},
        "geometry": {"type": "LineString", "coordinates": []},
    }  # fmt: skip


def square(**properties: Any) -> list[dict[str, Any]]:
    """Return a square of 4 m: nodes 0 to 3 counter-clockwise from the origin, edges 10 to 13 ahead, 20 to 23 back.

    Properties of an edge or node are given as ``e10={...}`` or ``n0={...}``.
    """
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
    features = [node(i, *corners[i], **properties.get(f"n{i}", {})) for i in range(4)]
    for i in range(4):
        j = (i + 1) % 4
        features.append(edge(10 + i, i, j, **properties.get(f"e{10 + i}", {})))
        features.append(edge(20 + i, j, i, **properties.get(f"e{20 + i}", {})))
    return features


def write(path: Path, features: list[Any]) -> Path:
    """Write a file with a feature a line, the first one on line 2."""
    lines = ",\n".join(json.dumps(feature) for feature in features)
    path.write_text(f'{{"type": "FeatureCollection", "features": [\n{lines}\n]}}')
    return path
