"""Lines and ink, against a picture painted point by point."""

import io
import math

import numpy as np
import pytest
from PIL import Image

from daidalos.nodes.turtlesim import _drawing
from daidalos.nodes.turtlesim._drawing import PIXELS, Drawing
from daidalos.nodes.turtlesim._turtle import SIZE, Pen

RED = Pen(255, 0, 0, 8)


def painted(start: tuple[float, float], end: tuple[float, float], radius: float) -> np.ndarray:
    """The readable twin: which pixels are within a radius of a line, in units."""
    scale = (PIXELS - 1) / SIZE
    mask = np.zeros((PIXELS, PIXELS), bool)
    (x1, y1), (x2, y2) = ((x * scale, PIXELS - 1 - y * scale) for x, y in (start, end))
    for row in range(PIXELS):
        for column in range(PIXELS):
            length = math.hypot(x2 - x1, y2 - y1)
            share = ((column - x1) * (x2 - x1) + (row - y1) * (y2 - y1)) / length**2
            share = min(max(share, 0.0), 1.0)
            mask[row, column] = math.hypot(column - x1 - share * (x2 - x1), row - y1 - share * (y2 - y1)) <= radius
    return mask


def ink_of(drawing: Drawing) -> np.ndarray:
    scale = (PIXELS - 1) / SIZE
    return np.array(
        [
            [drawing.colour_at(column / scale, (PIXELS - 1 - row) / scale) is not None for column in range(PIXELS)]
            for row in range(PIXELS)
        ]
    )


@pytest.mark.slow
@pytest.mark.parametrize("line", [((2.0, 2.0), (4.0, 3.0)), ((10.9, 0.0), (11.0889, 0.3)), ((5.0, 5.0), (5.0, 9.0))])
def test_ink_is_where_the_tip_was(line: tuple[tuple[float, float], tuple[float, float]]) -> None:
    drawing = Drawing()
    drawing.draw(*line, RED)
    assert np.array_equal(ink_of(drawing), painted(*line, 4.0))


def test_colours() -> None:
    drawing = Drawing()
    assert drawing.colour_at(3.0, 3.0) is None
    drawing.draw((2.0, 3.0), (4.0, 3.0), RED)
    drawing.draw((3.0, 2.0), (3.0, 4.0), Pen(1, 2, 3, 0))
    assert drawing.colour_at(2.5, 3.0) == (255, 0, 0)
    assert drawing.colour_at(3.0, 3.0) == (1, 2, 3)
    drawing.clear()
    assert drawing.colour_at(3.0, 3.0) is None


def test_what_lies_beside_the_paper_is_no_error() -> None:
    drawing = Drawing()
    drawing.draw((-9.0, -9.0), (-8.0, -8.0), RED)
    drawing.draw((5.0, 5.0), (1e9, 5.0), RED)
    assert drawing.colour_at(SIZE, 5.0) == (255, 0, 0)


def test_news_are_told_once() -> None:
    drawing = Drawing()
    drawing.draw((1.0, 2.0), (3.0, 4.0), RED)
    lines, pens = drawing.news()
    assert lines.tolist() == [1.0, 2.0, 3.0, 4.0]
    assert pens.tolist() == [255, 0, 0, 8]
    assert drawing.news()[0].size == 0
    drawing.draw((3.0, 4.0), (5.0, 6.0), Pen(width=0))
    assert drawing.news()[1].tolist() == [0xB3, 0xB8, 0xFF, 1]
    assert drawing.all_lines()[0].size == 8
    drawing.clear()
    assert (drawing.clearings, drawn := drawing.drawn) == (1, 0), drawn
    assert drawing.news()[0].size == drawing.all_lines()[0].size == 0


def test_old_lines_become_a_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_drawing, "_MAX_LINES", 10)
    drawing = Drawing()
    for step in range(25):
        assert drawing.picture() == b"" or step > 20
        drawing.draw((step * 0.4, 5.0), (step * 0.4 + 0.4, 5.0), RED)
    lines, _ = drawing.all_lines()
    assert 10 <= lines.size / 4 <= 20
    assert lines[-4:].tolist() == pytest.approx([9.6, 5.0, 10.0, 5.0])
    picture = np.asarray(Image.open(io.BytesIO(drawing.picture())))
    assert picture.shape == (PIXELS, PIXELS, 4)
    middle = round(PIXELS - 1 - 5.0 * (PIXELS - 1) / SIZE)
    assert picture[middle, 100].tolist() == [255, 0, 0, 255]  # from a line that is told no more
    assert picture[10, 10].tolist() == [0, 0, 0, 0]
