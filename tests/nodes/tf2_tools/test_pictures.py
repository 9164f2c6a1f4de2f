"""Pictures of trees: complete, without overlaps, and valid in both formats."""

import re
from itertools import pairwise
from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from daidalos.nodes.tf2_tools._pdf import to_pdf
from daidalos.nodes.tf2_tools._svg import to_svg
from daidalos.nodes.tf2_tools._tree_picture import draw_tree

NOTES = ["Average rate: 10.0", "Buffer length: 5.0"]


@st.composite
def forests(draw: st.DrawFn) -> dict[str, str]:
    """Child to parent: every frame hangs below an earlier one, or is a root."""
    parents = draw(st.lists(st.integers(-1, 20), min_size=1, max_size=20))
    return {f"frame_{i}": f"frame_{p}" if 0 <= p < i else f"root_{p % 3}" for i, p in enumerate(parents)}


@given(forests())
def test_every_frame_has_a_place_of_its_own(parents: dict[str, str]) -> None:
    picture = draw_tree("title", parents, dict.fromkeys(parents, NOTES))
    names = {text.content for text in picture.texts}
    assert names >= set(parents) | set(parents.values())
    assert len(picture.boxes) == len(set(parents) | set(parents.values()))
    assert len(picture.arrows) == len(parents)
    for level in {box.y for box in picture.boxes}:
        row = sorted((box for box in picture.boxes if box.y == level), key=lambda box: box.x)
        assert all(a.x + a.width / 2 < b.x - b.width / 2 for a, b in pairwise(row))
    assert all(box.x - box.width / 2 > 0 and box.x + box.width / 2 < picture.width for box in picture.boxes)
    assert all(box.y + box.height / 2 < picture.height for box in picture.boxes)


def test_children_stand_below_their_parents() -> None:
    picture = draw_tree("", {"left": "root", "right": "root"}, {})
    at = {text.content: (text.x, text.y) for text in picture.texts}
    assert at["left"][1] == at["right"][1] > at["root"][1]
    assert at["left"][0] < at["root"][0] < at["right"][0]


def test_svg_says_names_as_they_are() -> None:
    root = ElementTree.fromstring(to_svg(draw_tree("", {"<b & c>": "map"}, {"<b & c>": NOTES})))
    texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert {"<b & c>", "map", *NOTES} <= set(texts)


def test_pdf_is_a_document() -> None:
    content = to_pdf(draw_tree("now", {"odd (name) \\ ü": "map"}, {}))
    assert content.startswith(b"%PDF-1.4")
    assert content.endswith(b"%%EOF\n")
    table = int(re.search(rb"startxref\n(\d+)\n", content)[1])
    assert content[table:].startswith(b"xref\n0 6\n")
    places = [int(line.split()[0]) for line in content[table:].split(b"\n")[3:8]]
    assert [content[place:].startswith(f"{number} 0 obj".encode()) for number, place in enumerate(places, 1)] == [
        True
    ] * 5
    length = int(re.search(rb"/Length (\d+)", content)[1])
    assert content[content.index(b"stream\n") + 7 :][length:].startswith(b"\nendstream")
    assert rb"(odd \(name\) \\ " + "ü".encode("cp1252") + b")" in content


def test_nothing_to_draw_is_a_picture_too() -> None:
    picture = draw_tree("no tf data received", {}, {})
    assert b"no tf data received" in to_pdf(picture)
    assert "no tf data received" in to_svg(picture)
