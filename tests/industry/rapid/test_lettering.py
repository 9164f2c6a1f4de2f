"""Letters as strokes, the programs that draw them, and drawings compared with letters."""

import math
from pathlib import Path

import numpy as np
import pytest

from daidalos.cli.daidalos import main
from daidalos.common.errors import UserError
from daidalos.industry.rapid.lettering.drawing import compare, drawn_strokes
from daidalos.industry.rapid.lettering.strokes import FLATNESS, Stroke, strokes_of_text


def make_font(path: Path) -> None:
    """Write a font with an H, and an O of two circles of quadratic curves."""
    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.ttGlyphPen import TTGlyphPen

    def rectangle() -> object:
        pen = TTGlyphPen(None)
        pen.moveTo((0, 0))
        for point in ((0, 700), (400, 700), (400, 0)):
            pen.lineTo(point)
        pen.closePath()
        return pen.glyph()

    def ring() -> object:
        pen = TTGlyphPen(None)
        for radius in (350, 250):
            points = [(350 + radius * math.cos(a), 350 + radius * math.sin(a)) for a in np.arange(8) * math.pi / 4]
            out = radius / math.cos(math.pi / 8)
            angles = (np.arange(8) + 0.5) * math.pi / 4
            controls = [(350 + out * math.cos(a), 350 + out * math.sin(a)) for a in angles]
            pen.moveTo(points[0])
            for n in range(8):
                pen.qCurveTo(controls[n], points[(n + 1) % 8])
            pen.closePath()
        return pen.glyph()

    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder([".notdef", "H", "O"])
    builder.setupCharacterMap({ord("H"): "H", ord("O"): "O"})
    builder.setupGlyf({".notdef": rectangle(), "H": rectangle(), "O": ring()})
    builder.setupHorizontalMetrics({".notdef": (500, 0), "H": (500, 0), "O": (800, 0)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2()
    builder.setupPost()
    builder.setupNameTable({"familyName": "Test"})
    builder.save(path)


def test_outlines_of_a_font(tmp_path: Path) -> None:
    pytest.importorskip("fontTools")
    make_font(tmp_path / "f.ttf")
    strokes = strokes_of_text("HO", 70.0, tmp_path / "f.ttf")
    assert len(strokes) == 3
    assert all(one.is_closed for one in strokes)
    assert np.array(strokes[0].points) == pytest.approx(np.array([(0, 0), (0, 70), (40, 70), (40, 0), (0, 0)]))
    for stroke, radius in zip(strokes[1:], (35.0, 25.0), strict=True):
        for x, y in stroke.points:
            assert math.hypot(x - 85.0, y - 35.0) == pytest.approx(radius, abs=FLATNESS + 0.2)


@pytest.mark.parametrize(
    ("text", "height", "font", "message"),
    [
        ("", 40.0, None, "one line"),
        ("A\nB", 40.0, None, "one line"),
        ("A", math.nan, None, "height"),
        ("é", 40.0, None, "has no 'É'"),
        ("A", 40.0, "missing.ttf", "there is no such font"),
        ("A", 40.0, "broken.ttf", "no font that can be read"),
        ("Q", 40.0, "f.ttf", "the font has no 'Q'"),
    ],
)
def test_text_that_cannot_be_drawn(text: str, height: float, font: str | None, message: str, tmp_path: Path) -> None:
    pytest.importorskip("fontTools")
    make_font(tmp_path / "f.ttf")
    (tmp_path / "broken.ttf").write_bytes(b"\x00\x01\x00\x00 and nothing more")
    with pytest.raises(UserError, match=message):
        strokes_of_text(text, height, tmp_path / font if font else None)


def test_alphabet_is_as_high_as_asked() -> None:
    for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789":
        heights = [y for one in strokes_of_text(letter, 30.0, None) for _, y in one.points]
        assert (min(heights), max(heights)) == pytest.approx((0.0, 30.0), abs=1.1), letter


def test_comparison_measures_offsets() -> None:
    line = [Stroke([(0.0, 0.0), (50.0, 0.0)])]
    moved = [Stroke([(0.0, 0.1), (50.0, 0.1)])]
    assert compare(line, line).overlap == pytest.approx(1.0)
    assert compare(line, line).deviation < 1e-9
    found = compare(line, moved)
    assert found.deviation == pytest.approx(0.1, abs=1e-6)
    assert found.overlap == pytest.approx(0.4 / 0.6, abs=0.01)
    missing = compare(line, [*line, Stroke([(0.0, 5.0), (1.0, 5.0)])])
    assert missing.deviation == pytest.approx(5.0)


def test_strokes_are_where_the_pen_touches() -> None:
    frame = np.eye(4)
    frame[:3, 3] = [100.0, 0.0, 50.0]
    path = np.array([[100, 0, 60], [100, 0, 50], [110, 0, 50], [110, 0, 60], [120, 0, 50.01], [120, 5, 50.01]], float)
    assert [one.points for one in drawn_strokes(path, frame)] == [[(0, 0), (10, 0)], [(20, 0), (20, 5)]]


def test_written_program_draws_the_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    module, picture = str(tmp_path / "abb.mod"), str(tmp_path / "abb.svg")
    assert main(["rapid", "write", "ABB", "-o", module]) == 0
    assert main(["rapid", "check", module]) == 0
    assert main(["rapid", "draw", module, "-o", picture, "--text", "ABB"]) == 0
    last = capsys.readouterr().err.splitlines()[-1].split()
    assert last[0] == "overlap"
    assert float(last[1]) > 99.0
    assert float(last[5]) <= 0.2
    assert Path(picture).read_text().count("<polyline") == 6
    assert main(["rapid", "write", "ABB", "-o", module]) != 0
    assert "exists; choose another name or add --force" in capsys.readouterr().err


def test_report_of_a_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    module, report = tmp_path / "line.mod", tmp_path / "line.html"
    module.write_text(
        "MODULE line\nPROC main()\nMoveAbsJ [[10,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, z50, tool0;\n"
        "MoveAbsJ [[20,10,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tool0;\nENDPROC\nENDMODULE\n"
    )
    assert main(["rapid", "trace", str(module), "-o", str(report)]) == 0
    text = report.read_text()
    assert "http" not in text.replace("http://www.w3.org", "")
    assert "{{" not in text
    assert "line.mod:3" in text
    assert "cycle time" in text
    assert main(["rapid", "trace", str(module), "-o", str(report)]) != 0
    assert main(["rapid", "trace", str(module), "-o", str(report), "--force", "--robot", "irb12"]) != 0
    assert "did you mean 'irb120'" in capsys.readouterr().err
