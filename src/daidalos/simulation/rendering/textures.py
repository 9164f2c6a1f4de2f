"""Textures of a scene in one array, each with its smaller levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class TextureAtlas:
    """Textures behind one another.

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
    """Put images (rows, columns, 4) into an atlas."""
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
    """Return an image and its halves down to one texel, each the mean of the one before."""
    chain = [image]
    while max(chain[-1].shape[:2]) > 1:
        chain.append(_halved(chain[-1]))
    return chain


def _halved(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Average two by two texels; an odd last row or column counts twice."""
    rows, columns = image.shape[:2]
    even = np.pad(image, ((0, rows % 2), (0, columns % 2), (0, 0)), mode="edge").astype(np.uint16)
    pairs = even[0::2] + even[1::2]
    return ((pairs[:, 0::2] + pairs[:, 1::2] + 2) // 4).astype(np.uint8)
