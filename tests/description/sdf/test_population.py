import itertools
import math

import pytest

from daidalos.description import sdf
from daidalos.description.errors import DescriptionError


def population(distribution, count=6, region="<box><size>4 2 0.5</size></box>"):
    text = (
        "<population name='p'><model name='can'><link name='l'/></model><pose>10 0 0 0 0 1.5707963267948966</pose>"
        f"<model_count>{count}</model_count><distribution>{distribution}</distribution>{region}</population>"
    )
    return sdf.parse(f"<sdf version='1.9'><world name='w'>{text}</world></sdf>").models


def places(distribution, **options):
    """Return positions in the region's own frame."""
    return [(m.pose.position[1], 10 - m.pose.position[0]) for m in population(distribution, **options)]


def test_models_are_numbered():
    assert [model.name for model in population("<type>random</type>", 3)] == [
        "can_clone_0",
        "can_clone_1",
        "can_clone_2",
    ]


def test_a_grid():
    found = places("<type>grid</type><rows>2</rows><cols>3</cols><step>1 2 0</step>")
    assert found == [pytest.approx((x, y)) for y in (-1, 1) for x in (-1, 0, 1)]


@pytest.mark.parametrize(("axis", "ends"), [("x", ((-2, 0), (2, 0))), ("y", ((0, -1), (0, 1)))])
def test_lines(axis, ends):
    found = places(f"<type>linear-{axis}</type>", count=5)
    assert (found[0], found[-1]) == (pytest.approx(ends[0]), pytest.approx(ends[1]))
    gaps = [math.dist(a, b) for a, b in itertools.pairwise(found)]
    assert gaps == pytest.approx([gaps[0]] * 4)


@pytest.mark.parametrize("kind", ["random", "uniform"])
def test_regions(kind):
    for x, y in places(f"<type>{kind}</type>", count=50):
        assert abs(x) <= 2
        assert abs(y) <= 1
    disc = "<cylinder><radius>3</radius><length>1</length></cylinder>"
    found = places(f"<type>{kind}</type>", count=200, region=disc)
    distances = [math.hypot(x, y) for x, y in found]
    assert max(distances) <= 3
    # Evenly over the area: half of them within 3 / sqrt(2).
    assert sum(d < 3 / math.sqrt(2) for d in distances) == pytest.approx(100, abs=25)


def test_the_world_is_the_same_each_time():
    assert places("<type>random</type>") == places("<type>random</type>")


def test_mistakes():
    with pytest.raises(DescriptionError, match="unknown distribution 'heap'"):
        places("<type>heap</type>")
    with pytest.raises(DescriptionError, match="<model> is missing"):
        sdf.parse("<sdf version='1.9'><world name='w'><population name='p'/></world></sdf>")
