"""Drawing of the turtles: lines for the window, and pixels for the colour sensor."""

from __future__ import annotations

import io
import math

import numpy as np
from numpy.typing import NDArray

from daidalos.nodes.turtlesim._turtle import SIZE, Pen

PIXELS = 500
_SCALE = (PIXELS - 1) / SIZE
_MAX_NEWS = 1000
_MAX_LINES = 40_000  # ten minutes of driving; older lines are shown as a picture


class Drawing:
    """Canvas of the turtles.

    Attributes
    ----------
    clearings
        How often it was wiped.
    drawn
        How many lines were drawn since.
    """

    def __init__(self) -> None:
        self.clearings = 0
        self.drawn = 0
        self._ink: NDArray[np.uint8] = np.zeros((PIXELS, PIXELS, 4), np.uint8)
        self._lines: list[tuple[float, float, float, float]] = []
        self._pens: list[tuple[int, int, int, int]] = []
        self._sent = 0

    def clear(self) -> None:
        """Wipe everything."""
        self.clearings += 1
        self.drawn = self._sent = 0
        self._ink[:] = 0
        self._lines.clear()
        self._pens.clear()

    def draw(self, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Draw a line between two points, in units."""
        self.drawn += 1
        self._lines.append((*start, *end))
        self._pens.append((pen.r, pen.g, pen.b, max(pen.width, 1)))
        if len(self._lines) > 2 * _MAX_LINES:
            del self._lines[:_MAX_LINES], self._pens[:_MAX_LINES]
        self._draw_round_tip(_pixel(start), _pixel(end), pen)

    def colour_at(self, x: float, y: float) -> tuple[int, int, int] | None:
        """Return the colour of the ink at a point, None where the paper is blank."""
        column, row = _pixel((x, y))
        r, g, b, alpha = self._ink[round(row), round(column)].tolist()
        return (r, g, b) if alpha else None

    def news(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """Return the lines drawn since the last call: ends of shape (4 n,), pens of shape (4 n,).

        None where they are too many: who was not listening for that long asks for all of them.
        """
        count, self._sent = self.drawn - self._sent, self.drawn
        return self._newest(count if count <= _MAX_NEWS else 0)

    def all_lines(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """Return the newest lines, as `news` does; `picture` shows the others."""
        return self._newest(len(self._lines))

    def picture(self) -> bytes:
        """Return everything as a PNG picture, empty while `all_lines` has every line."""
        if self.drawn <= len(self._lines):
            return b""
        from PIL import Image

        content = io.BytesIO()
        Image.fromarray(self._ink).save(content, "PNG")
        return content.getvalue()

    def _newest(self, count: int) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        first = len(self._lines) - count
        return (
            np.array(self._lines[first:], np.float32).reshape(-1),
            np.array(self._pens[first:], np.uint8).reshape(-1),
        )

    def _draw_round_tip(self, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Colour the pixels that a round tip passes over."""
        radius = max(pen.width, 1) / 2
        columns, rows = (
            np.arange(max(math.floor(min(a, b) - radius), 0), min(math.ceil(max(a, b) + radius), PIXELS - 1) + 1)
            for a, b in zip(start, end, strict=True)
        )
        if not columns.size or not rows.size:
            return  # beside the paper
        along = np.subtract(end, start)
        dx, dy = columns[None, :] - start[0], rows[:, None] - start[1]
        share = np.clip((dx * along[0] + dy * along[1]) / max(float(along @ along), 1e-12), 0.0, 1.0)
        inside = np.hypot(dx - share * along[0], dy - share * along[1]) <= max(radius, math.sqrt(0.5))
        self._ink[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1][inside] = (pen.r, pen.g, pen.b, 255)


def _pixel(point: tuple[float, float]) -> tuple[float, float]:
    """Return column and row of a point."""
    return point[0] * _SCALE, PIXELS - 1 - point[1] * _SCALE
