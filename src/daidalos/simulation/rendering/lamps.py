"""How much light of a lamp reaches a place."""

from __future__ import annotations

import math
from typing import Any

from daidalos.simulation.rendering.compilation import compiled_loosely

LAMP = 18
"""Numbers that describe a lamp: kind, place, direction, colour, range, fading (3), cosines of the cone (2), falloff,
whether it shines."""

POINT, SPOT, DIRECTIONAL = 0.0, 1.0, 2.0


@compiled_loosely
def lamp_light(lamp: Any, x: Any, y: Any, z: Any, nx: Any, ny: Any, nz: Any) -> Any:
    """Return how much light of a lamp arrives at a place with a normal."""
    if lamp[17] == 0.0:
        return 0.0
    length = math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-12
    if lamp[0] == DIRECTIONAL:
        return max(0.0, -(nx * lamp[4] + ny * lamp[5] + nz * lamp[6]) / length)
    dx, dy, dz = lamp[1] - x, lamp[2] - y, lamp[3] - z
    distance = math.sqrt(dx * dx + dy * dy + dz * dz) + 1e-12
    if distance > lamp[10]:
        return 0.0
    facing = (nx * dx + ny * dy + nz * dz) / (distance * length)
    if facing <= 0.0:
        return 0.0
    light = facing / max(lamp[11] + lamp[12] * distance + lamp[13] * distance * distance, 1e-6)
    if lamp[0] == SPOT:
        along = -(dx * lamp[4] + dy * lamp[5] + dz * lamp[6]) / distance
        if along <= lamp[15]:
            return 0.0
        if along < lamp[14]:
            light *= ((along - lamp[15]) / (lamp[14] - lamp[15])) ** lamp[16]
    return light
