"""Extensions by their names, built in and from packages that are installed."""

import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.common.errors import Location
from daidalos.common.extensions import (
    Extension,
    ExtensionError,
    Kind,
    UnknownExtension,
    classes_in,
    describe,
    find,
    listing,
)

CONTRACT = """
class Shape:
    names = ()

class Circle(Shape):
    \"\"\"A circle.

    It is round.
    \"\"\"
    names = ("shapes_round::Circle", *("libcircle.so",))
"""
USERS = """
from house.contract import Shape
class Square(Shape):
    \"\"\"A square.\"\"\"
class Other: ...
"""
ENTRY_POINTS = """
[test.shapes]
my_shapes::Square = my_shapes.square:Square
shapes_round::Circle = my_shapes.square:Other
broken = my_shapes.broken:Broken
lost = my_shapes.square:Lost
other = my_shapes.square:Other
"""


def built_in():
    return classes_in("house")


SHAPES: Kind = Kind("shape", "test.shapes", "house.contract:Shape", "what shapes are for", built_in)


@pytest.fixture(autouse=True)
def packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A house with a contract and a built-in class, and an installed package of somebody else's."""
    for name, text in {
        "house/__init__.py": "",
        "house/contract.py": CONTRACT,
        "my_shapes/__init__.py": "",
        "my_shapes/square.py": USERS,
        "my_shapes/broken.py": "import nothing_that_is_there",
        "my_shapes-1.2.dist-info/METADATA": "Metadata-Version: 2.1\nName: my-shapes\nVersion: 1.2\n",
        "my_shapes-1.2.dist-info/entry_points.txt": ENTRY_POINTS,
        "shapes_square/readme.txt": "a folder that is not a package",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    classes_in.cache_clear()
    yield
    classes_in.cache_clear()
    for name in [name for name in sys.modules if name.partition(".")[0] in ("house", "my_shapes")]:
        del sys.modules[name]


@pytest.mark.parametrize("name", ["shapes_round::Circle", "shapes_round/Circle", "Circle", "libcircle.so"])
def test_built_in_classes_are_found_by_each_spelling(name: str) -> None:
    assert find(SHAPES, name).__name__ == "Circle"


@pytest.mark.parametrize(
    "name",
    [
        "my_shapes::Square",
        "my_shapes/Square",
        "Square",
        "my_shapes.square.Square",
        "my_shapes.square:Square",
        "my_shapes/square/Square",
    ],
)
def test_a_users_class_is_found_by_entry_point_and_by_class_path(name: str) -> None:
    assert find(SHAPES, name).__name__ == "Square"


def test_an_unknown_name_is_said_with_the_nearest_and_who_asked() -> None:
    asked_by = Location("robot.yaml", 12, "my_robot.plugin")
    with pytest.raises(UnknownExtension) as caught:
        find(SHAPES, "shapes_round::Circel", asked_by=asked_by)
    assert str(caught.value) == (
        "robot.yaml:12: 'my_robot.plugin': there is no shape 'shapes_round::Circel'; "
        "did you mean 'shapes_round::Circle'?"
    )


@pytest.mark.parametrize("name", ["", "nowhere.Thing", "shapes_square::Square", "..", "my_shapes.none.Square", "a b.c"])
def test_what_is_not_there_is_not_known(name: str) -> None:
    with pytest.raises(UnknownExtension, match=f"there is no shape '{name}'"):
        find(SHAPES, name)


def test_a_broken_entry_point_ends_in_one_line_and_spoils_no_other() -> None:
    with pytest.raises(ExtensionError) as caught:
        find(SHAPES, "broken")
    assert str(caught.value) == (
        "shape 'broken' of my-shapes 1.2 cannot be loaded from my_shapes.broken:Broken: "
        "No module named 'nothing_that_is_there'"
    )
    with pytest.raises(ExtensionError, match=r"'lost' of my-shapes 1\.2 cannot be loaded.*has no attribute 'Lost'"):
        find(SHAPES, "lost")
    assert find(SHAPES, "Square").__name__ == "Square"


@pytest.mark.parametrize("name", ["other", "my_shapes.square.Other"])
def test_a_class_that_does_not_fulfil_the_contract_is_refused(name: str) -> None:
    with pytest.raises(ExtensionError, match=r"my_shapes\.square:Other is not a Shape"):
        find(SHAPES, name)


def test_a_class_path_that_cannot_be_imported_says_why() -> None:
    with pytest.raises(
        ExtensionError,
        match=r"'my_shapes\.broken[.:]It' cannot be loaded from my_shapes\.broken:It: No module named 'nothing",
    ):
        find(SHAPES, "my_shapes.broken.It")


def test_the_listing_tells_where_each_comes_from_and_imports_none() -> None:
    found = listing(SHAPES)
    assert [(one.name, one.target, one.origin) for one in found[:2]] == [
        ("shapes_round::Circle", "house.contract:Circle", "built in"),
        ("my_shapes::Square", "my_shapes.square:Square", "my-shapes 1.2"),
    ]
    assert [one.name for one in found[2:]] == ["broken", "lost", "other"]
    assert not {"house.contract", "my_shapes.square", "my_shapes.broken"} & set(sys.modules)


def test_descriptions_are_the_first_lines_of_docstrings() -> None:
    circle, square, broken, *_ = listing(SHAPES)
    assert [describe(circle), describe(square)] == ["A circle", "A square"]
    assert describe(broken) == "(cannot be loaded: No module named 'nothing_that_is_there')"


def test_a_name_without_its_package_must_mean_one_class() -> None:
    twice: Kind = Kind("shape", "", "", "", lambda: [Extension(("a::X",), "a:X"), Extension(("b::X",), "b:X")])
    with pytest.raises(UnknownExtension):
        find(twice, "X")


def test_nothing_heavy_is_imported() -> None:
    code = "import sys, daidalos.common.extensions as e; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-S", "-c", f"import sys; sys.path[:0] = {sys.path!r}; {code}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert not {"ast", "inspect", "dataclasses", "importlib.metadata", "difflib", "numpy"} & set(loaded.stdout.split())
