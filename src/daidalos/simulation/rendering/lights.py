"""Intensity of a light at a surface point."""

from __future__ import annotations

import math
from typing import Any

from daidalos.common.kernels import compiled

LIGHT_SIZE = 18
"""Numbers that describe a light: type, position, direction, colour, range, fading (3), cosines of the cone (2),
falloff, whether it is on."""

POINT, SPOT, DIRECTIONAL = 0.0, 1.0, 2.0


@compiled(fastmath=True)
def light_intensity(light: Any, x: Any, y: Any, z: Any, nx: Any, ny: Any, nz: Any) -> Any:
    """Return the intensity of a light at the point (x, y, z) of a surface with normal (nx, ny, nz)."""
    if light[17] == 0.0:
        return 0.0
    length = math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-12
    if light[0] == DIRECTIONAL:
        return max(0.0, -(nx * light[4] + ny * light[5] + nz * light[6]) / length)
    dx, dy, dz = light[1] - x, light[2] - y, light[3] - z
    distance = math.sqrt(dx * dx + dy * dy + dz * dz) + 1e-12
    if distance > light[10]:
        return 0.0
    facing = (nx * dx + ny * dy + nz * dz) / (distance * length)
    if facing <= 0.0:
        return 0.0
    intensity = facing / max(light[11] + light[12] * distance + light[13] * distance * distance, 1e-6)
    if light[0] == SPOT:
        along = -(dx * light[4] + dy * light[5] + dz * light[6]) / distance
        if along <= light[15]:
            return 0.0
        if along < light[14]:
            intensity *= ((along - light[15]) / (light[14] - light[15])) ** light[16]
    return intensity
