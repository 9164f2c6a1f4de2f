"""State lattices: motions that fit together, their files, and what is wrong with them."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError
from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.lattice_motions import LatticeMotions, densified
from daidalos.navigation.planners.state_lattice import LatticeError, lattice_document, read_lattice
from properties import examples


def document(**options):
    return lattice_document(generate_lattice(LatticeOptions(**options)), {}, "2026-01-01")


@pytest.fixture
def written(tmp_path):
    def write(content):
        path = tmp_path / "lattice.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return write


@examples(20)
@given(
    model=st.sampled_from(["ackermann", "diff", "omni"]),
    radius=st.floats(0.2, 1.0),
    count=st.sampled_from([8, 16, 24]),
    ratio=st.sampled_from([0.0, 0.5, 0.9]),
)
def test_motions_end_on_cells_and_headings_and_keep_to_the_radius(model, radius, count, ratio):
    options = LatticeOptions(model, radius, 0.05, 5, count, ratio)
    lattice = generate_lattice(options)
    assert lattice.headings.size == count
    assert lattice.is_symmetric
    turned = {one.start: set() for one in lattice.primitives}
    assert set(turned) == set(range(count))
    for one in lattice.primitives:
        turned[one.start].add(one.turn)
        cells = one.poses[-1, :2] / 0.05
        assert np.allclose(cells, np.round(cells), atol=1e-9)
        assert math.remainder(one.poses[-1, 2] - lattice.headings[one.end], 2.0 * math.pi) == pytest.approx(0.0)
        way = np.concatenate([[[0.0, 0.0, lattice.headings[one.start]]], one.poses])
        steps = np.diff(way[:, :2], axis=0)
        lengths = np.hypot(*steps.T)
        turns = np.abs(np.remainder(np.diff(way[:, 2]) + math.pi, 2.0 * math.pi) - math.pi)
        assert one.length == pytest.approx(one.arc_length + one.straight_length)
        assert lengths.sum() == pytest.approx(one.length, rel=0.02, abs=1e-9)
        assert lengths.max() <= 0.05 + 1e-9
        if one.turn:
            assert one.radius >= radius * (1.0 - 1e-6)
            assert turns.sum() * one.radius == pytest.approx(one.arc_length)
            assert (2.0 * np.sin(0.5 * turns) <= 1.000001 * lengths / radius + 1e-9).all()
            middle = way[:-1, 2] + 0.5 * np.sign(one.turn) * turns
            along = np.cos(middle) * steps[:, 0] + np.sin(middle) * steps[:, 1]
            assert (along > 0.99 * lengths).all()
    assert all({-1, 0, 1} <= sides for sides in turned.values())


def test_lattices_are_symmetric_about_both_axes():
    lattice = generate_lattice(LatticeOptions(num_of_headings=24))
    ends = {(one.start, one.end, *np.round(one.poses[-1, :2] / 0.05).astype(int)) for one in lattice.primitives}
    assert ends == {(-start % 24, -end % 24, x, -y) for start, end, x, y in ends}
    assert ends == {((start + 6) % 24, (end + 6) % 24, -y, x) for start, end, x, y in ends}


def test_no_motion_is_two_others():
    lattice = generate_lattice(LatticeOptions())
    ends = {(one.start, one.end, *np.round(one.poses[-1, :2] / 0.05).astype(int)) for one in lattice.primitives}
    lengths = {key: one.length for one in lattice.primitives for key in ends if key[:2] == (one.start, one.end)}
    for start, middle, x, y in ends:
        for again, end, dx, dy in ends:
            if again == middle and (start, end, x + dx, y + dy) in ends:
                whole = next(
                    one.length
                    for one in lattice.primitives
                    if (one.start, one.end) == (start, end)
                    and np.allclose(one.poses[-1, :2] / 0.05, (x + dx, y + dy), atol=1e-6)
                )
                assert whole < 0.999 * (lengths[start, middle, x, y] + lengths[middle, end, dx, dy])


def test_motions_of_nav2s_sample_for_the_same_options_are_found():
    """Straight on and to the next headings, from its file for a car that turns on 0.5 m, on cells of 0.05 m."""
    found = {
        (one.start, one.end): one
        for one in generate_lattice(LatticeOptions()).primitives
        if one.start in (0, 1) and abs(one.end - one.start) <= 1
    }
    for key, end, radius, length, arc in (
        ((0, 0), (0.15, 0.0), 0.0, 0.15, 0.0),
        ((0, 1), (0.35, 0.1), 0.635, 0.368, 0.295),
        ((1, 0), (0.35, 0.1), 0.635, 0.368, 0.295),
        ((1, 1), (0.2, 0.1), 0.0, 0.224, 0.0),
        ((1, 2), (0.2, 0.15), 0.689, 0.251, 0.222),
    ):
        one = found[key]
        assert one.poses[-1, :2] == pytest.approx(end)
        assert (one.radius, one.length, one.arc_length) == pytest.approx((radius, length, arc), abs=6e-4)


def test_a_file_holds_the_lattice(written):
    for model in ("ackermann", "diff", "omni"):
        made = generate_lattice(LatticeOptions(model))
        read = read_lattice(written(document(motion_model=model)))
        assert (read.motion_model, read.turning_radius, read.grid_resolution) == (model, 0.5, 0.05)
        assert np.array_equal(read.headings, made.headings)
        assert len(read.primitives) == len(made.primitives)
        for one, other in zip(read.primitives, made.primitives, strict=True):
            assert one[:-1] == other[:-1]
            assert np.array_equal(one.poses, other.poses)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.pop("primitives"), "primitives is missing"),
        (lambda d: d.update(primitives=[]), "primitives is empty"),
        (lambda d: d["lattice_metadata"].pop("turning_radius"), "lattice_metadata.turning_radius is missing"),
        (
            lambda d: d["lattice_metadata"].update(turning_radius=0.0),
            "turning_radius is 0.0, expected a number above 0",
        ),
        (lambda d: d["lattice_metadata"].update(motion_model="tank"), "is 'tank', expected ackermann, diff, omni"),
        (lambda d: d["lattice_metadata"].update(heading_angles=[1.0, 0.0]), "heading_angles must be increasing angles"),
        (
            lambda d: d["primitives"][1].update(end_angle_index=16),
            r"primitives\[1\].end_angle_index is 16, expected an",
        ),
        (lambda d: d["primitives"][1].update(left_turn=1), r"primitives\[1\].left_turn is '1', expected true or false"),
        (lambda d: d["primitives"][0].update(poses=[]), r"primitives\[0\].poses must be poses of three numbers"),
        (lambda d: d["primitives"][0]["poses"].append([0.1, 0.0, 2.0]), r"primitives\[0\].poses end at 2 rad, not at"),
        (lambda d: d["primitives"][0].update(trajectory_length=0.01), "trajectory_length is 0.01, but its poses span"),
        (lambda d: d["primitives"][0]["poses"][-1].__setitem__(1, 0.01), "do not end at the centre of a cell"),
        (lambda d: d.update(primitives=d["primitives"][:4]), "primitives has no motion from the headings 1, 2"),
    ],
)
def test_a_wrong_file_is_refused_with_its_place(written, change, message):
    content = document()
    change(content)
    with pytest.raises(LatticeError, match=message) as caught:
        read_lattice(written(content))
    assert "lattice.json" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [("{", "lattice.json:1: is not valid JSON"), ("[]", "is missing"), ('{"primitives": NaN}', "NaN is not a number")],
)
def test_text_that_is_no_lattice_is_refused(written, text, message):
    with pytest.raises(LatticeError, match=message):
        read_lattice(written(text))


@examples(50)
@given(content=st.recursive(st.none() | st.booleans() | st.floats() | st.text(), st.lists, max_leaves=5))
def test_any_value_in_a_file_is_a_lattice_or_an_error(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("lattices") / "lattice.json"
    for place in ("lattice_metadata", "primitives"):
        path.write_text(json.dumps(document() | {place: content}))
        with pytest.raises(LatticeError):
            read_lattice(path)


def test_options_are_checked():
    with pytest.raises(ParameterError, match="multiple of 8, got 12"):
        LatticeOptions(num_of_headings=12)
    with pytest.raises(ParameterError, match="must be at most 5 for this grid_resolution, got 6"):
        LatticeOptions(turning_radius=6.0)


@pytest.mark.parametrize("yaw", [0.0, 0.3, -2.0])
def test_motions_backwards_are_those_forwards_from_the_opposite_heading(yaw):
    lattice = generate_lattice(LatticeOptions())
    motions = LatticeMotions(lattice, yaw, 0.05, 5.0, is_reverse_allowed=True)
    assert motions.headings[motions.first] == pytest.approx(yaw)
    assert motions.ends.shape[0] == 2 * len(lattice.primitives)
    for heading in range(16):
        for motion in range(motions.begin[heading], motions.begin[heading + 1]):
            column, row, end, side, is_reverse = motions.ends[motion]
            poses = motions.poses_of(motion)
            assert math.remainder(poses[-1, 2] - motions.headings[end], 2.0 * math.pi) == pytest.approx(0.0)
            place = motions.place(np.zeros(3), np.array([column, row]))
            assert poses[-1, :2] == pytest.approx(place)
            ahead = poses[0, :2] @ [math.cos(motions.headings[heading]), math.sin(motions.headings[heading])]
            assert (ahead < 0.0) == bool(is_reverse)
            turned = math.remainder(poses[-1, 2] - motions.headings[heading], 2.0 * math.pi)
            assert np.sign(round(turned, 6)) == (-side if is_reverse else side)


def test_poses_between_are_on_the_arc():
    arc = np.array([[math.sin(a), 1.0 - math.cos(a), a] for a in np.linspace(0.0, 1.5, 4)])
    dense = densified(arc, 0.05, 0.0)
    assert np.hypot(dense[:, 0], dense[:, 1] - 1.0) == pytest.approx(np.ones(len(dense)))
    assert np.hypot(*np.diff(dense[:, :2], axis=0).T).max() <= 0.05
    assert dense[-1] == pytest.approx(arc[-1])
    assert densified(np.array([[0, 0, 0], [0, 0, 1.0]]), 0.1, 2.0).shape == (20, 3)
