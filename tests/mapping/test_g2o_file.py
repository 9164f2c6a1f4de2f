from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from daidalos.common import pose2
from daidalos.mapping.errors import GraphFileError
from daidalos.mapping.g2o_file import read_g2o, write_g2o
from daidalos.mapping.pose_graph import Edge, optimize, squared_errors
from properties import examples

numbers = st.floats(-1e6, 1e6)
AS_FILES = examples(50, suppress_health_check=[HealthCheck.function_scoped_fixture])


def grid_of_poses(side: int) -> tuple[np.ndarray, list[Edge]]:
    """A robot that sweeps a square row by row and recognizes the place beside it in the row before."""
    true = []
    for row in range(side):
        columns = range(side) if row % 2 == 0 else range(side - 1, -1, -1)
        true += [(float(column), float(row), 0.0 if row % 2 == 0 else np.pi) for column in columns]
    poses = np.array(true)
    where = {(round(x), round(y)): k for k, (x, y, _) in enumerate(poses)}
    pairs = [(k, k + 1) for k in range(len(poses) - 1)]
    pairs += [(where[x, y], where[x, y + 1]) for x in range(side) for y in range(side - 1)]
    pairs = sorted({pair for pair in pairs if pair[0] < pair[1]})
    information = np.diag([100.0, 100.0, 400.0])
    edges = [Edge(a, b, pose2.between(poses[a], poses[b]), information, closure=b != a + 1) for a, b in pairs]
    return poses, edges


@AS_FILES
@given(
    st.lists(st.tuples(numbers, numbers, st.floats(-3.0, 3.0)), min_size=2, max_size=5),
    st.lists(numbers, min_size=6, max_size=6),
)
def test_what_is_written_is_read(tmp_path: Path, poses: list[tuple[float, ...]], upper: list[float]) -> None:
    information = np.zeros((3, 3))
    information[np.triu_indices(3)] = upper
    information = information + np.triu(information, 1).T
    edges = [Edge(0, 1, np.array(poses[1]), information), Edge(0, len(poses) - 1, np.array(poses[0]), information)]
    write_g2o(tmp_path / "graph.g2o", np.array(poses), edges)
    found_poses, found = read_g2o(tmp_path / "graph.g2o")
    assert np.array_equal(found_poses, np.array(poses))
    assert [(edge.first, edge.second, edge.closure) for edge in found] == [
        (edge.first, edge.second, edge.second != 1) for edge in edges
    ]
    for edge, other in zip(found, edges, strict=True):
        assert np.array_equal(edge.measurement, other.measurement)
        assert np.array_equal(edge.information, other.information)


@AS_FILES
@given(st.binary(max_size=200) | st.text("VERTX_SE2DG 0123456789.-\n", max_size=200).map(str.encode))
def test_any_other_file_is_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "graph.g2o").write_bytes(content)
    problem = ""
    try:
        read_g2o(tmp_path / "graph.g2o")
    except GraphFileError as error:
        problem = str(error)
    assert "\n" not in problem


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("VERTEX_SE2 0 1 2\n", "graph.g2o:1: expected 4 finite numbers after VERTEX_SE2"),
        ("VERTEX_SE2 0 1 2 nan\n", "graph.g2o:1: expected 4 finite numbers"),
        ("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 7 1 0 0 1 0 0 1 0 1\n", "graph.g2o:2: there is no VERTEX_SE2 7"),
        ("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", "graph.g2o:1: expected VERTEX_SE2, EDGE_SE2 or FIX, found 'VERTEX_SE3"),
        ("# nothing\n", "graph.g2o: no VERTEX_SE2 or EDGE_SE2"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "graph.g2o").write_text(text)
    with pytest.raises(GraphFileError, match=message.replace(".", r"\.")):
        read_g2o(tmp_path / "graph.g2o")


def test_a_file_without_poses_is_solved_from_its_edges(tmp_path: Path) -> None:
    poses, edges = grid_of_poses(6)
    write_g2o(tmp_path / "graph.g2o", poses, edges)
    lines = (tmp_path / "graph.g2o").read_text().splitlines(keepends=True)
    (tmp_path / "edges.g2o").write_text("".join(line for line in lines if line.startswith("EDGE")))
    found_poses, found = read_g2o(tmp_path / "edges.g2o")
    assert squared_errors(found_poses, found).max() < 1e-9
    noisy = [replace(edge, measurement=edge.measurement + np.array([0.01, -0.01, 0.02])) for edge in found]
    solution = optimize(found_poses, noisy, chordal=True)
    assert np.hypot(*(solution.poses - poses)[:, :2].T).max() < 0.5
    assert not solution.rejected
