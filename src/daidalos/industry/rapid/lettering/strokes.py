"""Strokes of letters: outlines of fonts, and a single-stroke alphabet of our own."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError

Point = tuple[float, float]
FLATNESS = 0.02
"""Greatest distance of an outline's lines from its curves [mm]."""

MAX_TEXT = 200


@dataclass(frozen=True)
class Stroke:
    """A line of the pen without lifting.

    Attributes
    ----------
    points : list of (x, y)
        Corners [mm]; the pen goes straight from one to the next.
    """

    points: list[Point]

    @property
    def is_closed(self) -> bool:
        """Return whether it ends where it begins."""
        return len(self.points) > 2 and math.dist(self.points[0], self.points[-1]) < 1e-6


def strokes_of_text(text: str, height: float, font: Path | None) -> list[Stroke]:
    """Return the strokes of a text whose capitals have a height [mm], from the left end of its base line.

    Parameters
    ----------
    text
        One line.
    height
        Height of capitals [mm].
    font
        A TrueType or OpenType file, whose outlines are drawn; None for the single-stroke alphabet.

    Raises
    ------
    UserError
        Where the text is empty or too long, the height is not positive, the font cannot be read or lacks a letter.
    """
    if not text.strip() or len(text) > MAX_TEXT or any(not one.isprintable() for one in text):
        raise UserError(f"the text has to be one line of 1 to {MAX_TEXT} printable letters")
    if not (math.isfinite(height) and height > 0.0):
        raise UserError(f"the height of letters has to be more than 0 mm, not {height:g}")
    return _outlines(text, height, font) if font is not None else _single_strokes(text, height)


# Fonts


def _outlines(text: str, height: float, path: Path) -> list[Stroke]:
    try:
        from fontTools.ttLib import TTFont, TTLibError
    except ImportError:
        raise UserError("reading fonts needs fonttools: pip install 'daidalos[industry]'") from None
    try:
        with TTFont(path, fontNumber=0, lazy=True) as font:
            return _outlines_of(font, text, height, path)
    except FileNotFoundError:
        raise UserError(f"{path}: there is no such font") from None
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (TTLibError, KeyError, ValueError, AssertionError, IndexError, EOFError) as error:
        raise UserError(f"{path}: is no font that can be read: {error}") from None


def _outlines_of(font: Any, text: str, height: float, path: Path) -> list[Stroke]:
    names, glyphs = font.getBestCmap() or {}, font.getGlyphSet()
    missing = sorted({one for one in text if ord(one) not in names})
    if missing:
        raise UserError(f"{path}: the font has no '{missing[0]}'")
    capital = _capital_height(glyphs, names, font)
    scale, x, found = height / capital, 0.0, []
    for letter in text:
        glyph = glyphs[names[ord(letter)]]
        pen = _FlatteningPen(glyphs, scale, x)
        glyph.draw(pen)
        found += pen.strokes
        x += scale * glyph.width
    return found


def _capital_height(glyphs: Any, names: dict[int, str], font: Any) -> float:
    """Return the height of H in units of the font, or that of the line without one."""
    if ord("H") in names:
        pen = _FlatteningPen(glyphs, 1.0, 0.0)
        glyphs[names[ord("H")]].draw(pen)
        top = max((y for one in pen.strokes for _, y in one.points), default=0.0)
        if top > 0.0:
            return top
    return float(font["head"].unitsPerEm) * 0.7


class _FlatteningPen:
    """Pen of fontTools that collects outlines as polylines [mm]."""

    def __init__(self, glyphs: Any, scale: float, x: float) -> None:
        self._glyphs, self._scale, self._x = glyphs, scale, x
        self.strokes: list[Stroke] = []
        self._points: list[Point] = []

    def moveTo(self, point: Point) -> None:
        """Start an outline."""
        self._points = [self._placed(point)]

    def lineTo(self, point: Point) -> None:
        """Append a line."""
        self._append(self._placed(point))

    def qCurveTo(self, *points: Point | None) -> None:
        """Append quadratic curves, whose points between are implied."""
        given = [self._placed(one) for one in points if one is not None]
        if points[-1] is None:
            given.append(_middle(given[-1], given[0]))
            self._points = [given[-1]]
        controls, end = given[:-1], given[-1]
        for n, control in enumerate(controls):
            goal = end if n == len(controls) - 1 else _middle(control, controls[n + 1])
            self._curve([self._points[-1], control, goal])
        if not controls:
            self._append(end)

    def curveTo(self, *points: Point) -> None:
        """Append a cubic curve."""
        self._curve([self._points[-1], *(self._placed(one) for one in points)])

    def closePath(self) -> None:
        """End an outline where it began."""
        if self._points:
            self._append(self._points[0])
        self.endPath()

    def endPath(self) -> None:
        """End an outline."""
        if len(self._points) > 1:
            self.strokes.append(Stroke(self._points))
        self._points = []

    def addComponent(self, name: str, transformation: tuple[float, ...]) -> None:
        """Draw a part of a composed letter."""
        from fontTools.pens.transformPen import TransformPen

        self._glyphs[name].draw(TransformPen(self, transformation))

    def _placed(self, point: Point) -> Point:
        return self._x + self._scale * point[0], self._scale * point[1]

    def _append(self, point: Point) -> None:
        if math.dist(point, self._points[-1]) > 1e-9:
            self._points.append(point)

    def _curve(self, controls: list[Point]) -> None:
        """Append lines that are at most `FLATNESS` away from a Bezier curve."""
        bend = max(
            math.hypot(a[0] - 2 * b[0] + c[0], a[1] - 2 * b[1] + c[1])
            for a, b, c in zip(controls, controls[1:], controls[2:], strict=False)
        )
        degree = len(controls) - 1
        count = max(1, math.ceil(math.sqrt(degree * (degree - 1) * bend / (8.0 * FLATNESS))))
        for n in range(1, count + 1):
            points, share = controls, n / count
            while len(points) > 1:
                points = [_between(a, b, share) for a, b in itertools.pairwise(points)]
            self._append(points[0])


def _middle(a: Point, b: Point) -> Point:
    return _between(a, b, 0.5)


def _between(a: Point, b: Point, share: float) -> Point:
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])


# The single-stroke alphabet

_ADVANCE = 1.5
"""Gap between letters in units of the grid."""

# Letters on a grid 6 high: polylines as digits x y, separated by blanks; "(" before a point between makes an arc.
_LETTERS = {
    "A": "00 26 40|0.67,2 3.33,2", "B": "00 06 2.5,6 (4,4.5 2.5,3 0,3|2.5,3 (4,1.5 2.5,0 00",
    "C": "4,5 (2,6 0,4 02 (2,0 41", "D": "00 06 2,6 (4.12,5.12 5,3 (4.12,0.88 20 00", "E": "40 00 06 46|03 33",
    "F": "00 06 46|03 33", "G": "4,5 (2,6 0,4 02 (2,0 42 43 23", "H": "00 06|40 46|03 43", "I": "00 06",
    "J": "01 (1.5,0 31 36", "K": "00 06|46 03 40", "L": "06 00 40", "M": "00 06 23 46 40", "N": "00 06 40 46",
    "O": "02 (2,0 42 44 (2,6 04 02", "P": "00 06 2.5,6 (4,4.5 2.5,3 03", "Q": "02 (2,0 42 44 (2,6 04 02|2,2 40",
    "R": "00 06 2.5,6 (4,4.5 2.5,3 03|2,3 40", "S": "41 (2,0 01.5 (1,2.7 2,3 (3,3.3 4,4.5 (2,6 05", "T": "20 26|06 46",
    "U": "06 02 (2,0 42 46", "V": "06 20 46", "W": "06 10 24 30 46", "X": "00 46|06 40", "Y": "06 23 46|23 20",
    "Z": "06 46 00 40", "0": "02 (2,0 42 44 (2,6 04 02|03 43", "1": "04 26 20", "2": "0,4.5 (2,6 4,4.5 00 40",
    "3": "0.2,5.2 (2,6 4,4.5 (3.4,3.4 2,3 (3.5,2.5 4,1.5 (2,0 0.2,0.8", "4": "30 36 02 42",
    "5": "46 06 03.5 23.5 (4,1.75 20 00",
    "6": "35.8 (0.6,4 02 (2,0 42 (2,3.7 02", "7": "06 46 10", "8": "2,3 (0,4.5 2,6 (4,4.5 2,3 (0,1.5 20 (4,1.5 2,3",
    "9": "44 (2,2.3 04 (2,6 44 (3.4,2 10.2", "-": "03 33", ".": "00 0,0.4", "!": "06 02|00 0,0.4", "+": "03 43|21 25",
}  # fmt: skip


def _single_strokes(text: str, height: float) -> list[Stroke]:
    scale, x, found = height / 6.0, 0.0, []
    for letter in text.upper():
        if letter == " ":
            x += 3.0
            continue
        if letter not in _LETTERS:
            known = "".join(_LETTERS)
            raise UserError(f"the single-stroke alphabet has no '{letter}', only {known}; give a --font")
        lines = [_polyline(part) for part in _LETTERS[letter].split("|")]
        found += [Stroke([(scale * (x + a), scale * b) for a, b in line]) for line in lines]
        x += max(a for line in lines for a, _ in line) + _ADVANCE
    return found


def _polyline(text: str) -> list[Point]:
    points: list[Point] = []
    via: Point | None = None
    for word in text.split():
        numbers = word.lstrip("(")
        first, _, second = numbers.partition(",") if "," in numbers else (numbers[0], "", numbers[1:])
        point = (float(first), float(second))
        if word.startswith("("):
            via = point
        elif via is not None:
            points += _arc(points[-1], via, point)
            via = None
        else:
            points.append(point)
    return points


def _arc(start: Point, via: Point, end: Point) -> list[Point]:
    """Return points on the circle from a start, which is left out, through a point to an end."""
    (ax, ay), (bx, by), (cx, cy) = start, via, end
    d = 2.0 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    ux = (a2 * (by - cy) + b2 * (cy - ay) + c2 * (ay - by)) / d
    uy = (a2 * (cx - bx) + b2 * (ax - cx) + c2 * (bx - ax)) / d
    begin, through, stop = (math.atan2(y - uy, x - ux) for x, y in (start, via, end))
    turn = 2.0 * math.pi
    to_via, to_end = (through - begin) % turn, (stop - begin) % turn
    sweep = to_end if to_via <= to_end else to_end - turn
    radius = math.dist(start, (ux, uy))
    count = max(4, math.ceil(abs(sweep) / 0.1))
    found = [
        (ux + radius * math.cos(begin + sweep * n / count), uy + radius * math.sin(begin + sweep * n / count))
        for n in range(1, count)
    ]
    return [*found, end]
