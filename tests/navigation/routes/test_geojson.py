"""The reader of graph files: what it reads, and one line with the place for whatever is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.errors import NoValidGraph
from daidalos.navigation.routes.loaders.geojson_graph_file_loader import GeoJsonGraphFileLoader
from navigation.routes.graphs import edge, node, square, write


def load(path: Path) -> Any:
    return GeoJsonGraphFileLoader().load(path)


def test_what_a_file_says_is_read(tmp_path: Path) -> None:
    door = {"type": "open_door", "trigger": "ON_ENTER", "metadata": {"service_name": "/door"}}
    features = [edge(9, 0, 1, cost=2.5, overridable=False, metadata={"speed_limit": 80}, operations={"door": door})]
    features += [node(0, 1, 2.5, frame="odom"), node(1, 3.0, 2.5), {"geometry": {"type": "Polygon"}}]
    graph = load(write(tmp_path / "graph.geojson", features))
    (only,) = graph.edges
    assert (only.start.x, only.start.y, only.start.frame, only.end.frame) == (1.0, 2.5, "odom", "")
    assert (only.cost, only.overridable, only.number("speed_limit", 100.0)) == (2.5, False, 80.0)
    assert (only.operations[0].type, only.operations[0].trigger) == ("open_door", "ON_ENTER")
    assert only.operations[0].metadata == {"service_name": "/door"}


@pytest.mark.parametrize(
    ("change", "line", "problem"),
    [
        (lambda f: f[5]["properties"].update(endid=77), 7, "feature 5 has the endid 77, but there is no such node"),
        (lambda f: f[1]["properties"].update(id=0), 3, "feature 1 has the id 0 of another node"),
        (lambda f: f[1]["properties"].update(id=70000), 3, "the id 70000, expected an integer from 0 to 65535"),
        (lambda f: f[4]["properties"].pop("startid"), 6, "has no property 'startid'; there are: endid, id"),
        (lambda f: f[0]["geometry"].update(coordinates=["a", 1]), 2, "expected two numbers"),
        (lambda f: f[4]["properties"].update(cost="much"), 6, "has the cost 'much', expected a number"),
        (lambda f: f[4]["properties"].update(operations={"a": {"type": "b", "trigger": "ENTER"}}), 6, "NODE, ON_"),
        (lambda f: f.insert(0, 5), 2, "feature 0 has no 'geometry'"),
        (lambda f: f.clear(), None, "has no nodes or no edges"),
    ],
)
def test_an_error_names_file_line_and_value(tmp_path: Path, change: Any, line: int | None, problem: str) -> None:
    features = square()
    change(features)
    path = write(tmp_path / "graph.geojson", features)
    with pytest.raises(NoValidGraph) as caught:
        load(path)
    assert caught.value.location is not None
    assert caught.value.location.line == line
    assert problem in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{", "graph.geojson:1: is not valid JSON"),
        ('{"features": [NaN]}', "NaN"),
        ("[]", "has no list 'features'"),
        ("[" * 100000, "is not valid JSON"),
    ],
)
def test_what_is_no_graph_is_refused(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "graph.geojson"
    path.write_text(text)
    with pytest.raises(NoValidGraph, match=problem):
        load(path)
    with pytest.raises(NoValidGraph, match="cannot be read: No such file"):
        load(tmp_path / "none.geojson")


def test_edges_of_one_identifier_are_kept_with_a_warning(tmp_path: Path) -> None:
    warnings: list[str] = []
    path = write(tmp_path / "graph.geojson", [*square(), edge(10, 0, 2)])
    graph = GeoJsonGraphFileLoader(context=NavigationContext(warn=warnings.append)).load(path)
    assert len(graph.edges) == 9
    assert "2 edges have the id 10" in warnings[0]


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 99999) | st.floats() | st.sampled_from(["Point", "LineString", "id"]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["geometry", "type", "properties", "id", "startid", "coordinates"]), inner)
    ),
    max_leaves=12,
)


@given(JSON)
def test_no_input_raises_anything_else(tmp_path_factory: pytest.TempPathFactory, feature: Any) -> None:
    path = tmp_path_factory.getbasetemp() / "graph.geojson"
    path.write_text(json.dumps({"features": [*square()[:2], feature]}))
    with pytest.raises(NoValidGraph):
        load(path)
