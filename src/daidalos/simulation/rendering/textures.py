"""Texture atlas with mip maps, and its compiled lookups."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled


@dataclass(frozen=True, eq=False)
class TextureAtlas:
    """Textures in one array.

    Parameters
    ----------
    texels : array (n, 4) of uint8
    textures : array (t, 2) of int32
        Of each texture the first row in `levels` and how many there are.
    levels : array (m, 3) of int32
        First texel, width and height.
    """

    texels: NDArray[np.uint8]
    textures: NDArray[np.int32]
    levels: NDArray[np.int32]


def make_atlas(images: Sequence[NDArray[np.uint8]]) -> TextureAtlas:
    """Create an atlas of images (rows, columns, 4)."""
    texels: list[NDArray[np.uint8]] = []
    textures: list[tuple[int, int]] = []
    levels: list[tuple[int, int, int]] = []
    place = 0
    for image in images:
        chain = mip_chain(image)
        textures.append((len(levels), len(chain)))
        for level in chain:
            levels.append((place, level.shape[1], level.shape[0]))
            texels.append(level.reshape(-1, 4))
            place += texels[-1].shape[0]
    return TextureAtlas(
        texels=np.concatenate(texels) if texels else np.zeros((1, 4), dtype=np.uint8),
        textures=np.array(textures, dtype=np.int32).reshape(-1, 2),
        levels=np.array(levels, dtype=np.int32).reshape(-1, 3),
    )


def mip_chain(image: NDArray[np.uint8]) -> list[NDArray[np.uint8]]:
    """Return an image and its mip levels down to one texel, each the mean of the one before."""
    chain = [image]
    while max(chain[-1].shape[:2]) > 1:
        chain.append(_halved(chain[-1]))
    return chain


def _halved(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the mean of two by two texels; an odd last row or column counts twice."""
    rows, columns = image.shape[:2]
    even = np.pad(image, ((0, rows % 2), (0, columns % 2), (0, 0)), mode="edge").astype(np.uint16)
    pairs = even[0::2] + even[1::2]
    return ((pairs[:, 0::2] + pairs[:, 1::2] + 2) // 4).astype(np.uint8)


@compiled(fastmath=True)
def mip_level(levels: Any, texture: Any, ux: Any, vx: Any, uy: Any, vy: Any) -> Any:
    """Return the row of the mip level whose texels are about as large as pixels."""
    first, count = texture[0], texture[1]
    width, height = levels[first, 1], levels[first, 2]
    across = (ux * width) ** 2 + (vx * height) ** 2
    along = (uy * width) ** 2 + (vy * height) ** 2
    size = max(across, along)
    if size <= 1.0:
        return first
    return first + min(count - 1, int(0.5 * math.log2(size) + 0.5))


@compiled(fastmath=True)
def sample(texels: Any, level: Any, u: Any, v: Any) -> Any:
    """Return the bilinearly interpolated colour of a repeating texture."""
    first, width, height = level[0], level[1], level[2]
    x, y = u * width - 0.5, (1.0 - v) * height - 0.5
    left, top = math.floor(x), math.floor(y)
    s, t = np.float32(x - left), np.float32(y - top)
    i, j = int(left) % width, int(top) % height
    i1, j1 = i + 1 if i + 1 < width else 0, j + 1 if j + 1 < height else 0
    a, b = texels[first + j * width + i], texels[first + j * width + i1]
    c, d = texels[first + j1 * width + i], texels[first + j1 * width + i1]
    one, scale = np.float32(1.0), np.float32(1.0 / 255.0)
    wa, wb, wc, wd = (one - s) * (one - t) * scale, s * (one - t) * scale, (one - s) * t * scale, s * t * scale
    return (
        wa * a[0] + wb * b[0] + wc * c[0] + wd * d[0],
        wa * a[1] + wb * b[1] + wc * c[1] + wd * d[1],
        wa * a[2] + wb * b[2] + wc * c[2] + wd * d[2],
    )
