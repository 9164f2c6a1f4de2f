import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.mapping.pose_graph import OUTLIER_CHI2, Edge, optimize, squared_errors

TIGHT = np.diag([1e4, 1e4, 1e4])


def chain(steps: list[tuple[float, float, float]], information: np.ndarray = TIGHT) -> list[Edge]:
    return [Edge(k, k + 1, np.array(step), information) for k, step in enumerate(steps)]


def test_a_chain_is_the_product_of_its_steps() -> None:
    steps = [(1.0, 0.0, np.pi / 2), (1.0, 0.0, np.pi / 2), (2.0, 0.5, 0.1)]
    solution = optimize(np.random.default_rng(0).normal(size=(4, 3)) * 0.1, chain(steps))
    expected = [solution.poses[0]]
    for step in steps:
        expected.append(pose2.compose(expected[-1], step))
    assert solution.poses == pytest.approx(np.array(expected), abs=1e-4)
    assert solution.chi2 == pytest.approx(0.0, abs=1e-4)


def test_the_first_pose_is_held() -> None:
    start = np.array([[3.0, -2.0, 0.7], [0.0, 0.0, 0.0]])
    assert optimize(start, chain([(1.0, 0.0, 0.0)])).poses[0] == pytest.approx(start[0], abs=1e-6)


def test_a_gap_is_shared_by_the_variances() -> None:
    """Three steps along a line whose sum is 3.0, and one measurement of the whole that says 3.4."""
    variances = np.array([0.01, 0.02, 0.05])
    edges = [Edge(k, k + 1, np.array([1.0, 0.0, 0.0]), np.diag([1.0 / v, 1e4, 1e6])) for k, v in enumerate(variances)]
    edges.append(Edge(0, 3, np.array([3.4, 0.0, 0.0]), np.diag([1.0 / 0.02, 1e4, 1e6])))
    poses = optimize(np.array([[x, 0.0, 0.0] for x in range(4)], float), edges).poses
    steps = 1.0 + 0.4 * variances / (variances.sum() + 0.02)
    assert np.diff(poses[:, 0]) == pytest.approx(steps, abs=1e-4)


def test_false_closures_are_rejected_and_true_ones_kept() -> None:
    true = ring(40)
    rng = np.random.default_rng(1)
    edges = noisy_steps(true, rng, 0.02)
    for k in range(0, 20, 2):
        edges.append(closure(true, k, k + 20, rng, 0.02))
    good = len(edges)
    for k in (3, 9, 15):
        edges.append(Edge(k, k + 17, np.array([0.2, 0.1, 0.3]), np.eye(3) / 0.02**2, closure=True))
    solution = optimize(dead_reckoning(true[0], edges[:39]), edges)
    assert solution.rejected == (good, good + 1, good + 2)
    assert np.hypot(*(solution.poses - true)[:, :2].T).max() < 0.15


@pytest.mark.slow
def test_chordal_start_solves_what_descent_from_odometry_does_not() -> None:
    """A long walk on a grid of streets with a bad compass; the best solution is that reached from the truth."""
    rng = np.random.default_rng(3)
    true = manhattan(1500, rng)
    edges = noisy_steps(true, rng, 0.08)
    distance = np.abs(true[:, None, :2] - true[None, :, :2]).max(axis=2)
    pairs = np.argwhere(np.triu(distance < 1.1, 20))
    for first, second in rng.permutation(pairs)[:1500]:
        edges.append(closure(true, int(first), int(second), rng, 0.08, robust=False))
    start = dead_reckoning(true[0], edges[:1500])
    best = optimize(true, edges).chi2
    assert optimize(start, edges).chi2 > 2.0 * best
    assert optimize(start, edges, chordal=True).chi2 == pytest.approx(best, rel=1e-3)


def test_it_ends_where_gtsam_ends() -> None:
    gtsam = pytest.importorskip("gtsam")
    rng = np.random.default_rng(5)
    true = manhattan(300, rng)
    edges = noisy_steps(true, rng, 0.05)
    distance = np.abs(true[:, None, :2] - true[None, :, :2]).max(axis=2)
    for first, second in rng.permutation(np.argwhere(np.triu(distance < 1.1, 20)))[:300]:
        edges.append(closure(true, int(first), int(second), rng, 0.05, robust=False))
    graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(*true[0]), gtsam.noiseModel.Isotropic.Sigma(3, 1e-4)))
    for edge in edges:
        noise = gtsam.noiseModel.Gaussian.Information(edge.information)
        graph.add(gtsam.BetweenFactorPose2(edge.first, edge.second, gtsam.Pose2(*edge.measurement), noise))
    start = dead_reckoning(true[0], edges[:300])
    for index, pose in enumerate(start):
        values.insert(index, gtsam.Pose2(*pose))
    parameters = gtsam.LevenbergMarquardtParams()
    parameters.setRelativeErrorTol(1e-10)
    theirs = gtsam.LevenbergMarquardtOptimizer(graph, values, parameters).optimize()
    ours = optimize(start, edges)
    assert ours.chi2 == pytest.approx(2.0 * graph.error(theirs), rel=1e-4)
    expected = np.array([[pose.x(), pose.y()] for pose in (theirs.atPose2(index) for index in range(len(start)))])
    assert ours.poses[:, :2] == pytest.approx(expected, abs=0.05)


def test_a_single_pose_stays() -> None:
    assert optimize(np.array([[1.0, 2.0, 3.0]]), []).poses == pytest.approx(np.array([[1.0, 2.0, 3.0]]))


def test_squared_errors_are_mahalanobis() -> None:
    poses = np.array([[0.0, 0.0, np.pi / 2], [0.0, 2.0, np.pi / 2]])
    edge = Edge(0, 1, np.array([1.5, 0.0, 0.0]), np.diag([4.0, 1.0, 1.0]))
    assert squared_errors(poses, [edge]) == pytest.approx([4.0 * 0.5**2])
    assert OUTLIER_CHI2 > 16.3  # the 99.9 % quantile for three degrees of freedom


def ring(count: int) -> np.ndarray:
    """Two rounds on a circle."""
    angle = np.arange(count) * 4.0 * np.pi / count
    return np.stack([5.0 * np.sin(angle), 5.0 - 5.0 * np.cos(angle), pose2.wrap(angle)], axis=1)


def manhattan(count: int, rng: np.random.Generator) -> np.ndarray:
    poses = [np.zeros(3)]
    for _ in range(count):
        poses.append(pose2.compose(poses[-1], (1.0, 0.0, rng.choice([0.0, 0.0, 0.0, np.pi / 2, -np.pi / 2]))))
    return np.array(poses)


def closure(
    true: np.ndarray, first: int, second: int, rng: np.random.Generator, noise: float, robust: bool = True
) -> Edge:
    measured = pose2.compose(pose2.between(true[first], true[second]), noise * rng.standard_normal(3))
    return Edge(first, second, measured, np.eye(3) / noise**2, closure=robust)


def noisy_steps(true: np.ndarray, rng: np.random.Generator, noise: float) -> list[Edge]:
    return [closure(true, k, k + 1, rng, noise, robust=False) for k in range(len(true) - 1)]


def dead_reckoning(start: np.ndarray, edges: list[Edge]) -> np.ndarray:
    poses = [start]
    for edge in edges:
        poses.append(pose2.compose(poses[-1], edge.measurement))
    return np.array(poses)
