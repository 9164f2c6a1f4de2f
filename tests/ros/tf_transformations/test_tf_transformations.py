"""Matrices, angles and quaternions against scipy, and each decomposition against what it takes apart."""

import itertools
import math

import numpy as np
import pytest
import tf_transformations as tf
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from properties import examples

AXES = [
    kind + "".join(order)
    for kind in "sr"
    for order in itertools.product("xyz", repeat=3)
    if order[0] != order[1] != order[2]
]
angles = st.floats(-3.1, 3.1)
numbers = st.floats(-5.0, 5.0)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)
directions = vectors.filter(lambda vector: np.linalg.norm(vector) > 0.1)
quaternions = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4).map(np.array).filter(lambda q: np.linalg.norm(q) > 0.1).map(tf.unit_vector)
)


def point(matrix: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Where a matrix takes a point."""
    moved = matrix @ np.append(at, 1.0)
    return moved[:3] / moved[3]


def scipy_axes(axes: str) -> str:
    return axes[1:] if axes[0] == "s" else axes[1:].upper()


# Quaternions and angles


def test_there_are_24_conventions() -> None:
    assert len(AXES) == len(set(AXES)) == 24


@pytest.mark.parametrize("axes", AXES)
@examples(20)
@given(ai=angles, aj=angles, ak=angles)
def test_angles_as_scipy_has_them(axes: str, ai: float, aj: float, ak: float) -> None:
    expected = Rotation.from_euler(scipy_axes(axes), [ai, aj, ak])
    quaternion = tf.quaternion_from_euler(ai, aj, ak, axes)
    assert (Rotation.from_quat(quaternion) * expected.inv()).magnitude() < 1e-7
    np.testing.assert_allclose(tf.euler_matrix(ai, aj, ak, axes)[:3, :3], expected.as_matrix(), atol=1e-12)


@pytest.mark.parametrize("axes", AXES)
@examples(20)
@given(quaternion=quaternions)
def test_angles_of_a_rotation_make_that_rotation(axes: str, quaternion: np.ndarray) -> None:
    matrix = tf.quaternion_matrix(quaternion)
    for found in (tf.euler_from_matrix(matrix, axes), tf.euler_from_quaternion(quaternion, axes)):
        np.testing.assert_allclose(tf.euler_matrix(*found, axes), matrix, atol=1e-6)
    assert all(isinstance(angle, float) for angle in found)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_gimbal_lock(axes: str, end: float) -> None:
    proper = axes[1] == axes[3]
    middle = (math.pi if end > 0 else 0.0) if proper else end * math.pi / 2
    matrix = np.round(tf.euler_matrix(0.3, middle, 0.5, axes), 15)
    matrix[np.abs(matrix) < 1e-14] = 0.0
    found = tf.euler_from_matrix(matrix, axes)
    np.testing.assert_allclose(tf.euler_matrix(*found, axes), matrix, atol=1e-7)
    assert found[2 if axes[0] == "s" else 0] == 0.0


def test_roll_pitch_and_yaw_in_plain_words() -> None:
    np.testing.assert_allclose(tf.quaternion_from_euler(0, 0, math.pi / 2), [0, 0, math.sqrt(0.5), math.sqrt(0.5)])
    assert tf.euler_from_quaternion([0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)]) == pytest.approx((0, 0, math.pi / 2))
    yawed_then_pitched = tf.euler_matrix(0, 0.2, 0.3) @ [1, 0, 0, 1]
    expected = [math.cos(0.3) * math.cos(0.2), math.sin(0.3) * math.cos(0.2), -math.sin(0.2), 1]
    np.testing.assert_allclose(yawed_then_pitched, expected)
    np.testing.assert_allclose(tf.euler_matrix(1, 2, 3, "rxyz"), tf.euler_matrix(3, 2, 1, "szyx"))


def test_conventions_by_number_and_by_wrong_names() -> None:
    for numbers_, name in (
        ((0, 0, 0, 0), "sxyz"),
        ((0, 0, 0, 1), "rzyx"),
        ((2, 1, 1, 1), "rzyz"),
        ((1, 1, 0, 0), "syxz"),
    ):
        np.testing.assert_array_equal(tf.euler_matrix(1, 2, 3, numbers_), tf.euler_matrix(1, 2, 3, name))
    for name in ("xyz", "sxxy", "sxy", "sabc", "txyz", ""):
        with pytest.raises(KeyError):
            tf.euler_matrix(1, 2, 3, name)


@given(quaternions, st.floats(0.1, 10.0))
def test_quaternions_and_matrices(quaternion: np.ndarray, length: float) -> None:
    matrix = tf.quaternion_matrix(quaternion * length)
    np.testing.assert_allclose(matrix[:3, :3], Rotation.from_quat(quaternion).as_matrix(), atol=1e-12)
    np.testing.assert_array_equal(matrix[3], [0, 0, 0, 1])
    for given_ in (matrix, matrix[:3, :3]):
        back = tf.quaternion_from_matrix(given_)
        assert back[3] >= 0.0
        np.testing.assert_allclose(back * np.sign(back @ quaternion), quaternion, atol=1e-9)


@pytest.mark.parametrize("axis", np.eye(3))
def test_half_turns_have_quaternions(axis: np.ndarray) -> None:
    found = tf.quaternion_from_matrix(np.diag(2 * axis - 1))
    np.testing.assert_allclose(np.abs(found), [*axis, 0], atol=1e-15)


def test_a_quaternion_of_nothing_turns_nothing() -> None:
    np.testing.assert_array_equal(tf.quaternion_matrix([0, 0, 0, 0]), np.eye(4))


@given(quaternions, quaternions)
def test_products(one: np.ndarray, two: np.ndarray) -> None:
    found = tf.quaternion_multiply(one, two)
    np.testing.assert_allclose(
        tf.quaternion_matrix(found), tf.quaternion_matrix(one) @ tf.quaternion_matrix(two), atol=1e-9
    )
    np.testing.assert_allclose(tf.quaternion_multiply(one * 3, tf.quaternion_inverse(one * 3)), [0, 0, 0, 1], atol=1e-9)
    np.testing.assert_array_equal(tf.quaternion_conjugate(one), [-one[0], -one[1], -one[2], one[3]])


def test_a_known_product() -> None:
    np.testing.assert_array_equal(tf.quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]), [-44, -14, 48, 28])


@given(angles, directions)
def test_rotations_about_an_axis(angle: float, axis: np.ndarray) -> None:
    expected = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
    quaternion = tf.quaternion_about_axis(angle, axis)
    assert (Rotation.from_quat(quaternion) * expected.inv()).magnitude() < 1e-7
    np.testing.assert_allclose(tf.rotation_matrix(angle, axis)[:3, :3], expected.as_matrix(), atol=1e-12)


@given(quaternions, quaternions, st.floats(0.0, 1.0))
def test_slerp_as_scipy_has_it(one: np.ndarray, two: np.ndarray, fraction: float) -> None:
    start, end = Rotation.from_quat(one), Rotation.from_quat(two)
    assume((start.inv() * end).magnitude() < math.pi - 1e-3)
    found = Rotation.from_quat(tf.quaternion_slerp(one, two, fraction))
    expected = Slerp([0.0, 1.0], Rotation.concatenate([start, end]))(fraction)
    assert (found * expected.inv()).magnitude() < 1e-6


def test_the_ends_and_the_long_way_of_slerp() -> None:
    one, two = tf.quaternion_about_axis(0.0, [0, 0, 1]), tf.quaternion_about_axis(1.0, [0, 0, 1])
    np.testing.assert_array_equal(tf.quaternion_slerp(one, two, 0.0), one)
    np.testing.assert_array_equal(tf.quaternion_slerp(2 * one, two, 1.0, spin=1), two)
    np.testing.assert_array_equal(tf.quaternion_slerp(one, one, 0.3), one)
    np.testing.assert_allclose(tf.quaternion_slerp(one, two, 0.5), tf.quaternion_about_axis(0.5, [0, 0, 1]))
    np.testing.assert_allclose(tf.quaternion_slerp(one, -two, 0.5), tf.quaternion_about_axis(0.5, [0, 0, 1]))
    long_way = tf.quaternion_slerp(one, -two, 0.5, shortestpath=False)
    assert tf.euler_from_quaternion(long_way)[2] == pytest.approx(0.5 - math.pi)
    np.testing.assert_allclose(tf.quaternion_slerp(one, two, 2.0), tf.quaternion_about_axis(2.0, [0, 0, 1]))


def test_random_rotations_are_uniform() -> None:
    generator = np.random.default_rng(5)
    found = np.array([tf.random_quaternion(generator.random(3)) for _ in range(4000)])
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    np.testing.assert_allclose(found.T @ found / len(found), np.eye(4) / 4, atol=0.02)
    matrix = tf.random_rotation_matrix()
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(4), atol=1e-12)
    assert np.linalg.norm(tf.random_quaternion()) == pytest.approx(1.0)
    np.testing.assert_array_equal(tf.random_quaternion([0.0, 0.25, 0.5])[:2], [1.0, math.cos(math.pi / 2)])


# Matrices and what they do to points


@given(vectors, vectors)
def test_translations(by: np.ndarray, at: np.ndarray) -> None:
    matrix = tf.translation_matrix(by)
    np.testing.assert_allclose(point(matrix, at), at + by, atol=1e-12)
    np.testing.assert_array_equal(tf.translation_from_matrix(matrix), by)


@given(vectors, directions, vectors)
def test_reflections(on: np.ndarray, normal: np.ndarray, at: np.ndarray) -> None:
    matrix = tf.reflection_matrix(on, normal)
    n = normal / np.linalg.norm(normal)
    np.testing.assert_allclose(point(matrix, at), at - 2 * ((at - on) @ n) * n, atol=1e-9)
    found_point, found_normal = tf.reflection_from_matrix(matrix)
    assert tf.is_same_transform(matrix, tf.reflection_matrix(found_point, found_normal))
    assert found_point[3] == 1.0


@given(angles, directions, vectors)
def test_rotations(angle: float, axis: np.ndarray, on: np.ndarray) -> None:
    matrix = tf.rotation_matrix(angle, axis, on)
    np.testing.assert_allclose(point(matrix, on + axis), on + axis, atol=1e-9)
    assume(abs(angle) > 1e-3 or angle == 0.0)
    found = tf.rotation_from_matrix(matrix)
    assert abs(found[0]) == pytest.approx(abs(angle), abs=1e-6)
    np.testing.assert_allclose(tf.rotation_matrix(*found), matrix, atol=1e-6)
    assert found[2].shape == (4,)


def test_a_half_turn() -> None:
    matrix = tf.rotation_matrix(math.pi, [1, 2, 2], [3, 0, 0])
    assert tf.is_same_transform(tf.rotation_matrix(*tf.rotation_from_matrix(matrix)), matrix)


@given(st.floats(-3.0, 3.0), vectors, st.one_of(st.none(), directions), vectors)
def test_scalings(factor: float, origin: np.ndarray, along: np.ndarray | None, at: np.ndarray) -> None:
    matrix = tf.scale_matrix(factor, origin, along)
    offset = at - origin
    if along is None:
        expected = origin + factor * offset
    else:
        d = along / np.linalg.norm(along)
        expected = at + (factor - 1) * (offset @ d) * d
    np.testing.assert_allclose(point(matrix, at), expected, atol=1e-9)
    assume(abs(factor - 1.0) > 1e-2)
    found = tf.scale_from_matrix(matrix)
    assert found[0] == pytest.approx(factor)
    assert (found[2] is None) == (along is None)
    assert tf.is_same_transform(matrix, tf.scale_matrix(*found))


@given(vectors, directions, vectors)
def test_orthogonal_projections(on: np.ndarray, normal: np.ndarray, at: np.ndarray) -> None:
    matrix = tf.projection_matrix(on, normal)
    moved = point(matrix, at)
    n = normal / np.linalg.norm(normal)
    np.testing.assert_allclose(moved, at - ((at - on) @ n) * n, atol=1e-9)
    found = tf.projection_from_matrix(matrix)
    assert found[3:] == (None, False)
    assert tf.is_same_transform(matrix, tf.projection_matrix(*found))


@given(vectors, directions, directions, vectors)
def test_oblique_projections(on: np.ndarray, normal: np.ndarray, along: np.ndarray, at: np.ndarray) -> None:
    n = normal / np.linalg.norm(normal)
    assume(abs(along @ n) > 0.2)
    matrix = tf.projection_matrix(on, normal, along)
    moved = point(matrix, at)
    assert (moved - on) @ n == pytest.approx(0.0, abs=1e-7)
    np.testing.assert_allclose(np.cross(moved - at, along), 0.0, atol=1e-6)


@given(vectors, directions, vectors, vectors, st.booleans())
def test_central_projections(on: np.ndarray, normal: np.ndarray, eye: np.ndarray, at: np.ndarray, pseudo: bool) -> None:
    n = normal / np.linalg.norm(normal)
    assume(abs((eye - on) @ n) > 0.2)
    assume(abs((at - eye) @ n) > 0.2)
    matrix = tf.projection_matrix(on, normal, perspective=eye, pseudo=pseudo)
    moved = point(matrix, at)
    if pseudo:
        flat = point(tf.projection_matrix(on, normal, perspective=eye), at)
        np.testing.assert_allclose(np.cross(moved - flat, n), 0.0, atol=1e-6)  # only the depth differs
    else:
        assert (moved - on) @ n == pytest.approx(0.0, abs=1e-6)
        np.testing.assert_allclose(np.cross(moved - eye, at - eye), 0.0, atol=1e-4)


def test_parameters_of_a_central_projection() -> None:
    matrix = tf.projection_matrix([0.3, -0.2, 1.0], [0.1, 0.4, 1.0], perspective=[0.5, 0.6, -2.0])
    found = tf.projection_from_matrix(matrix)
    assert (found[2], found[4]) == (None, False)
    assert tf.is_same_transform(tf.projection_matrix(*found), matrix)


@pytest.mark.parametrize("perspective", [False, True])
def test_clipping(perspective: bool) -> None:
    left, right, bottom, top, near, far = -1.0, 2.0, 0.5, 3.0, 0.7, 9.0
    matrix = tf.clip_matrix(left, right, bottom, top, near, far, perspective)
    grow = far / near if perspective else 1.0
    np.testing.assert_allclose(point(matrix, [left, bottom, near]), [-1, -1, -1])
    np.testing.assert_allclose(point(matrix, [right, top, near]), [1, 1, -1])
    np.testing.assert_allclose(point(matrix, [grow * right, grow * top, far]), [1, 1, 1])


@pytest.mark.parametrize(
    "bounds", [(1, 0, 0, 1, 1, 2), (0, 1, 1, 1, 1, 2), (0, 1, 0, 1, 2, 1), (0, 1, 0, 1, 0, 1), (0, 1, 0, 1, -1, 1)]
)
def test_frustums_that_are_none(bounds: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="invalid frustum"):
        tf.clip_matrix(*bounds, perspective=True)


@given(st.floats(-1.3, 1.3), directions, directions, vectors, vectors)
def test_shears(angle: float, one: np.ndarray, two: np.ndarray, on: np.ndarray, at: np.ndarray) -> None:
    direction = np.cross(one, two)
    assume(np.linalg.norm(direction) > 0.1)
    matrix = tf.shear_matrix(angle, direction, on, one)
    d, n = direction / np.linalg.norm(direction), one / np.linalg.norm(one)
    np.testing.assert_allclose(point(matrix, at), at + math.tan(angle) * ((at - on) @ n) * d, atol=1e-8)


def test_parameters_of_a_shear() -> None:
    normal = np.array([0.3, -1.0, 0.5])
    matrix = tf.shear_matrix(0.4, np.cross([1.0, 2.0, 3.0], normal), [0.2, 1.3, -0.4], normal)
    found = tf.shear_from_matrix(matrix)
    assert found[0] == pytest.approx(0.4)
    np.testing.assert_allclose(tf.shear_matrix(*found), matrix, atol=1e-6)


def test_a_shear_out_of_its_plane() -> None:
    with pytest.raises(ValueError, match="not orthogonal"):
        tf.shear_matrix(0.1, [1, 0, 1], [0, 0, 0], [0, 0, 1])


@pytest.mark.parametrize(
    ("function", "matrix"),
    [
        (tf.reflection_from_matrix, np.eye(4)),
        (tf.reflection_from_matrix, tf.rotation_matrix(0.3, [0, 0, 1])),
        (tf.projection_from_matrix, np.eye(4)),
        (tf.shear_from_matrix, tf.scale_matrix(2.0)),
    ],
)
def test_matrices_of_another_kind(function: object, matrix: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"no .* (eigenvalue|eigenvector)"):
        function(matrix)


# Taking matrices apart


@given(
    st.tuples(*[st.floats(0.2, 3.0)] * 3),
    st.booleans(),
    vectors,
    st.tuples(angles, st.floats(-1.4, 1.4), angles),
    vectors,
    st.tuples(*[st.floats(-0.1, 0.1)] * 3),
)
def test_decomposition(
    scale: tuple, mirrored: bool, shear: np.ndarray, turned: tuple, moved: np.ndarray, perspective: tuple
) -> None:
    scale = np.array(scale) * (-1 if mirrored else 1)
    last = 1.0 - np.dot(perspective, moved)
    matrix = tf.compose_matrix(scale, shear, turned, moved, [*perspective, last])
    found = tf.decompose_matrix(7.0 * matrix)
    np.testing.assert_allclose(found[0], scale, rtol=1e-6)
    np.testing.assert_allclose(found[1], shear, atol=1e-6)
    np.testing.assert_allclose(tf.euler_matrix(*found[2]), tf.euler_matrix(*turned), atol=1e-6)
    np.testing.assert_allclose(found[3], moved, atol=1e-9)
    np.testing.assert_allclose(found[4], [*perspective, last], atol=1e-6)
    assert tf.is_same_transform(tf.compose_matrix(*found), matrix)


def test_composition_in_order() -> None:
    matrix = tf.compose_matrix([1, 2, 3], [0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [7, 8, 9])
    shear = np.eye(4)
    shear[0, 1], shear[0, 2], shear[1, 2] = 0.1, 0.2, 0.3
    expected = tf.concatenate_matrices(
        tf.translation_matrix([7, 8, 9]), tf.euler_matrix(0.4, 0.5, 0.6), shear, np.diag([1, 2, 3, 1])
    )
    np.testing.assert_allclose(matrix, expected)
    np.testing.assert_array_equal(tf.compose_matrix(), np.eye(4))


def test_singular_matrices() -> None:
    with pytest.raises(ValueError, match="singular"):
        tf.decompose_matrix(np.diag([1.0, 0.0, 1.0, 1.0]))
    with pytest.raises(ValueError, match="is zero"):
        tf.decompose_matrix(np.diag([1.0, 1.0, 1.0, 0.0]))


def test_crystals() -> None:
    np.testing.assert_allclose(
        tf.orthogonalization_matrix([10, 10, 10], [90, 90, 90]), np.diag([10, 10, 10, 1]), atol=1e-12
    )
    lengths, corner = [9.8, 12.0, 15.5], np.radians([87.2, 80.7, 69.7])
    edges = tf.orthogonalization_matrix(lengths, np.degrees(corner))[:3, :3].T
    np.testing.assert_allclose(np.linalg.norm(edges, axis=1), lengths)
    for number, (one, two) in enumerate(((1, 2), (2, 0), (0, 1))):
        cosine = edges[one] @ edges[two] / lengths[one] / lengths[two]
        assert cosine == pytest.approx(math.cos(corner[number]))
    np.testing.assert_allclose(np.triu(edges.T, 1), 0.0, atol=1e-12)


# Fitting points


@pytest.mark.parametrize("usesvd", [True, False])
@pytest.mark.parametrize("scaling", [True, False])
@given(quaternion=quaternions, shift=vectors, seed=st.integers(0, 1000))
def test_superimposition(usesvd: bool, scaling: bool, quaternion: np.ndarray, shift: np.ndarray, seed: int) -> None:
    generator = np.random.default_rng(seed)
    source = generator.normal(size=(3, 12))
    factor = 1.7 if scaling else 1.0
    target = factor * Rotation.from_quat(quaternion).as_matrix() @ source + shift[:, np.newaxis]
    matrix = tf.superimposition_matrix(source, target, scaling=scaling, usesvd=usesvd)
    np.testing.assert_allclose(point(matrix, source[:, 0]), target[:, 0], atol=1e-6)
    expected = tf.translation_matrix(shift) @ tf.quaternion_matrix(quaternion) @ tf.scale_matrix(factor)
    np.testing.assert_allclose(matrix, expected, atol=1e-6)


@given(st.integers(0, 1000))
def test_superimposition_of_points_that_do_not_fit_as_scipy_has_it(seed: int) -> None:
    generator = np.random.default_rng(seed)
    source, target = generator.normal(size=(4, 9)), generator.normal(size=(4, 9))
    centred = [values[:3] - values[:3].mean(axis=1, keepdims=True) for values in (source, target)]
    expected = Rotation.align_vectors(centred[1].T, centred[0].T)[0].as_matrix()
    for usesvd in (True, False):
        found = tf.superimposition_matrix(source, target, usesvd=usesvd)
        np.testing.assert_allclose(found[:3, :3], expected, atol=1e-6)


# Small things


@given(quaternions, vectors)
def test_inverses_and_products(quaternion: np.ndarray, shift: np.ndarray) -> None:
    matrix = tf.concatenate_matrices(tf.translation_matrix(shift), tf.quaternion_matrix(quaternion))
    assert tf.is_same_transform(tf.concatenate_matrices(matrix, tf.inverse_matrix(matrix)), tf.identity_matrix())
    assert tf.is_same_transform(matrix, -2.0 * matrix)
    assert not tf.is_same_transform(matrix, tf.translation_matrix([1, 0, 0]) @ matrix)


def test_lengths() -> None:
    values = np.arange(24.0).reshape(2, 3, 4)
    assert tf.vector_norm([3.0, 4.0]) == 5.0
    assert tf.vector_norm([]) == 0.0
    for axis in (0, 1, 2, -1):
        np.testing.assert_allclose(tf.vector_norm(values, axis=axis), np.linalg.norm(values, axis=axis))
        np.testing.assert_allclose(np.linalg.norm(tf.unit_vector(values + 1, axis=axis), axis=axis), 1.0)
    np.testing.assert_allclose(tf.vector_norm(values), [np.linalg.norm(values)])
    out = np.empty((2, 3))
    assert tf.vector_norm(values, axis=2, out=out) is None
    np.testing.assert_allclose(out, np.linalg.norm(values, axis=2))


def test_directions() -> None:
    given_ = [0.0, 3.0, 4.0]
    np.testing.assert_allclose(tf.unit_vector(given_), [0, 0.6, 0.8])
    assert given_ == [0.0, 3.0, 4.0]
    assert tf.unit_vector([]).tolist() == []
    out = np.empty(3)
    assert tf.unit_vector(given_, out=out) is None
    np.testing.assert_allclose(out, [0, 0.6, 0.8])
    assert tf.random_vector(5).shape == (5,)
    assert np.all((tf.random_vector((2, 3)) >= 0) & (tf.random_vector((2, 3)) < 1))


# The arcball


def test_dragging_turns_what_was_gripped_to_the_mouse() -> None:
    ball = tf.Arcball()
    ball.place([320, 240], 320)
    ball.down([400, 200])
    ball.drag([350, 300])
    grip = tf.arcball_map_to_sphere([400, 200], [320, 240], 320)
    place = tf.arcball_map_to_sphere([350, 300], [320, 240], 320)
    # As on a real ball of glass, the object turns by twice the angle.
    moved = ball.matrix()[:3, :3] @ grip
    assert math.acos(moved @ grip) == pytest.approx(2 * math.acos(grip @ place))
    np.testing.assert_allclose(np.cross(grip, place) @ moved, 0.0, atol=1e-12)


def test_not_moving_and_letting_go() -> None:
    ball = tf.Arcball(initial=tf.quaternion_about_axis(0.5, [0, 0, 1]))
    before = ball.matrix()
    ball.down([0.1, 0.1])
    ball.drag([0.1, 0.1])
    np.testing.assert_allclose(ball.matrix(), before)


def test_it_goes_on_turning() -> None:
    ball = tf.Arcball()
    ball.setaxes([0, 0, 1])
    ball.setconstrain(True)
    assert ball.getconstrain() is True
    ball.down([0.5, 0.0])
    ball.drag([0.5, -0.05])
    angle = tf.euler_from_matrix(ball.matrix())[2]
    ball.next()
    roll, pitch, yaw = tf.euler_from_matrix(ball.matrix())
    assert (roll, pitch, yaw) == pytest.approx((0.0, 0.0, 2 * angle))
    ball.next(1.0)
    assert tf.euler_from_matrix(ball.matrix())[2] == pytest.approx(4 * angle)


@pytest.mark.parametrize("initial", [np.eye(4), [0, 0, 0, 2]])
def test_how_it_may_begin(initial: object) -> None:
    np.testing.assert_array_equal(tf.Arcball(initial).matrix(), np.eye(4))


def test_how_it_may_not_begin() -> None:
    with pytest.raises(ValueError, match="initial not a quaternion or matrix"):
        tf.Arcball([1, 2, 3])


def test_points_on_the_ball() -> None:
    np.testing.assert_allclose(tf.arcball_map_to_sphere([0, 0], [0, 0], 1), [0, 0, 1])
    np.testing.assert_allclose(tf.arcball_map_to_sphere([9, 0], [0, 0], 1), [1, 0, 0])
    np.testing.assert_allclose(tf.arcball_map_to_sphere([0, 0.6], [0, 0], 1), [0, -0.6, 0.8])
    np.testing.assert_allclose(tf.arcball_constrain_to_axis([0.6, 0, 0.8], [1, 0, 0]), [0, 0, 1])
    np.testing.assert_allclose(tf.arcball_constrain_to_axis([1, 0, 0], [1, 0, 0]), [0, 1, 0])
    np.testing.assert_allclose(tf.arcball_constrain_to_axis([0, 0, 1], [0, 0, 1]), [1, 0, 0])
    np.testing.assert_allclose(tf.arcball_constrain_to_axis([0, 1, -1], [0, 1, 0]), [0, 0, 1])
    axes = [[1, 0, 0], [0, 1, 0]]
    np.testing.assert_array_equal(tf.arcball_nearest_axis([0, 0.6, 0.8], axes), [1, 0, 0])
