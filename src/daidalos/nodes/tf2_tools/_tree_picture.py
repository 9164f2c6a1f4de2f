"""Layout of a tree of frames: positions of frames and of the transforms' data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

FONT_SIZE = 12.0
SMALL_SIZE = 9.0
_MARGIN = 30.0
_BOX_HEIGHT = 28.0
_GAP = 26.0
_LETTER = 0.52  # mean width of Helvetica's letters, in sizes
_LEVEL = 132.0
_DROP = 20.0  # from a box to the rail below it
_LINE = 1.3  # from line to line, in sizes


@dataclass(frozen=True)
class Text:
    """Text whose middle is at `x` and whose baseline is at `y`; beginning at `x` where not centred."""

    x: float
    y: float
    content: str
    size: float = FONT_SIZE
    centred: bool = True


@dataclass(frozen=True)
class Box:
    """Frame: the centre and the size of its box."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Arrow:
    """Transform: a line from the parent's box to a rail, along it, and to the child's box."""

    x1: float
    y1: float
    rail: float
    x2: float
    y2: float


@dataclass
class Picture:
    """Drawing; y points down, units are points."""

    width: float = 0.0
    height: float = 0.0
    boxes: list[Box] = field(default_factory=list)
    arrows: list[Arrow] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)


def draw_tree(title: str, parents: Mapping[str, str], notes: Mapping[str, Sequence[str]]) -> Picture:
    """Lay out a tree of frames, roots at the top.

    Parameters
    ----------
    title
        Stands above everything.
    parents
        Child to parent.
    notes
        Child to the lines that stand at its arrow.
    """
    picture = Picture()
    picture.texts.append(Text(_MARGIN, _MARGIN, title, SMALL_SIZE, centred=False))
    children: dict[str, list[str]] = {}
    for child, parent in sorted(parents.items()):
        children.setdefault(parent, []).append(child)
    left = _MARGIN
    for root in sorted(set(children) - set(parents)):
        left = _Branch(root, children, notes).place(picture, left, _MARGIN + 34.0) + _GAP
    picture.width = max(left - _GAP, _MARGIN + text_width(title, SMALL_SIZE)) + _MARGIN
    picture.height = max((box.y + box.height / 2 for box in picture.boxes), default=2 * _MARGIN) + _MARGIN
    return picture


def text_width(content: str, size: float) -> float:
    """Return about how wide a text is."""
    return _LETTER * size * len(content)


class _Branch:
    """Frame with all its descendants."""

    def __init__(self, name: str, children: Mapping[str, Sequence[str]], notes: Mapping[str, Sequence[str]]) -> None:
        self._name = name
        self._notes = notes.get(name, ())
        self._below = [_Branch(child, children, notes) for child in children.get(name, ())]
        self._box_width = text_width(name, FONT_SIZE) + 24.0
        note_width = max((text_width(line, SMALL_SIZE) for line in self._notes), default=0.0)
        # Notes stand to the right of the arrow, which comes in at the middle.
        own = max(self._box_width, 2 * note_width + 16.0)
        below = sum(branch.width for branch in self._below) + _GAP * max(len(self._below) - 1, 0)
        self.width: float = max(own, below)
        self._indent = (self.width - below) / 2

    def place(self, picture: Picture, left: float, top: float) -> float:
        """Place the branch in the drawing and return its right end."""
        x, y = left + self.width / 2, top + _BOX_HEIGHT / 2
        picture.boxes.append(Box(x, y, self._box_width, _BOX_HEIGHT))
        picture.texts.append(Text(x, y + FONT_SIZE * 0.35, self._name))
        begin = left + self._indent
        for branch in self._below:
            branch.place(picture, begin, top + _LEVEL)
            branch.connect(picture, begin, top + _LEVEL, x, top + _BOX_HEIGHT)
            begin += branch.width + _GAP
        return left + self.width

    def connect(self, picture: Picture, left: float, top: float, parent_x: float, parent_y: float) -> None:
        """Draw the arrow from the parent, and what is known of it."""
        x = left + self.width / 2
        picture.arrows.append(Arrow(parent_x, parent_y, parent_y + _DROP, x, top))
        for row, line in enumerate(reversed(self._notes)):
            y = top - 10.0 - row * _LINE * SMALL_SIZE
            picture.texts.append(Text(x + 8.0, y, line, SMALL_SIZE, centred=False))
