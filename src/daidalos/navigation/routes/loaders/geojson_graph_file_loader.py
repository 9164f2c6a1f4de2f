"""Reader of route graphs in GeoJSON: points are nodes, lines are edges."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, parse_json, read_text
from daidalos.common.errors import Location
from daidalos.common.suggestions import hint
from daidalos.navigation.errors import NoValidGraph
from daidalos.navigation.routes.contracts import GraphFileLoader
from daidalos.navigation.routes.graph import TRIGGERS, GraphEdge, GraphNode, GraphOperation, RouteGraph

MAX_ID = 65535
"""Largest identifier that the messages of routes can carry."""


class GeoJsonGraphFileLoader(GraphFileLoader):
    """Reader of GeoJSON with the properties `id`, `startid`, `endid`, `frame`, `cost`, `metadata` and `operations`."""

    names = ("nav2_route::GeoJsonGraphFileLoader",)

    def load(self, path: Path) -> RouteGraph:
        """Implement `GraphFileLoader.load`."""
        try:
            text = read_text(path)
        except DocumentError as error:
            raise NoValidGraph(error.problem, error.location) from None
        except OSError as error:
            raise NoValidGraph(f"cannot be read: {error.strerror or error}", Location(str(path))) from None
        return _Reader(text, str(path), self.context.warn).graph()


class _Reader:
    """Reader of one document, which knows the place of each feature for error messages."""

    def __init__(self, text: str, file: str, warn: Callable[[str], None]) -> None:
        self._warn = warn
        self._text = text
        self._file = file
        self._index: int | None = None

    def graph(self) -> RouteGraph:
        try:
            document = parse_json(self._text, self._file)
        except DocumentError as error:
            raise NoValidGraph(error.problem, error.location) from None
        features = document.get("features") if isinstance(document, dict) else None
        if not isinstance(features, list):
            raise NoValidGraph("has no list 'features', expected a GeoJSON FeatureCollection", Location(self._file))
        nodes: dict[int, GraphNode] = {}
        edges: list[GraphEdge] = []
        for properties, shape in self._features(features, ("Point",)):
            node = self._node(properties, shape)
            self._require(node.id not in nodes, f"has the id {node.id} of another node")
            nodes[node.id] = node
        for properties, _ in self._features(
            features, ("LineString", "MultiLineString")
        ):  # may stand before their nodes
            edges.append(self._edge(properties, nodes))
        if not nodes or not edges:
            raise NoValidGraph("has no nodes or no edges, expected Point and LineString features", Location(self._file))
        for identifier, count in Counter(edge.id for edge in edges).items():
            if count > 1:
                self._warn(f"{self._file}: {count} edges have the id {identifier}; they are closed together")
        return RouteGraph(nodes.values(), edges)

    def _features(self, features: list[Any], kinds: tuple[str, ...]) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield properties and geometry of the features of some types; others, such as areas, are left out."""
        for self._index, feature in enumerate(features):
            shape = feature.get("geometry") if isinstance(feature, dict) else None
            self._require(isinstance(shape, dict), "has no 'geometry'")
            assert isinstance(shape, dict)
            if shape.get("type") in kinds:
                properties = feature.get("properties")
                self._require(isinstance(properties, dict), "has no 'properties'")
                yield properties, shape

    def _node(self, properties: dict[str, Any], shape: dict[str, Any]) -> GraphNode:
        place = shape.get("coordinates")
        is_point = isinstance(place, list) and len(place) >= 2 and all(_is_number(one) for one in place[:2])
        self._require(is_point, f"has the coordinates {place!r}, expected two numbers")
        assert isinstance(place, list)
        frame = properties.get("frame", "")
        self._require(isinstance(frame, str), f"has the frame {frame!r}, expected a name")
        return GraphNode(
            self._id(properties, "id"), float(place[0]), float(place[1]), frame, self._metadata(properties),
            self._operations(properties),
        )  # fmt: skip

    def _edge(self, properties: dict[str, Any], nodes: dict[int, GraphNode]) -> GraphEdge:
        ends = []
        for key in ("startid", "endid"):
            name = self._id(properties, key)
            self._require(name in nodes, f"has the {key} {name}, but there is no such node")
            ends.append(nodes[name])
        cost, overridable = properties.get("cost", 0.0), properties.get("overridable", True)
        self._require(_is_number(cost), f"has the cost {cost!r}, expected a number")
        self._require(isinstance(overridable, bool), f"has overridable {overridable!r}, expected true or false")
        return GraphEdge(
            self._id(properties, "id"), ends[0], ends[1], float(cost), overridable, self._metadata(properties),
            self._operations(properties),
        )  # fmt: skip

    def _id(self, properties: dict[str, Any], key: str) -> int:
        self._require(key in properties, f"has no property '{key}'{hint(key, [str(one) for one in properties])}")
        value = properties[key]
        is_id = isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MAX_ID
        self._require(is_id, f"has the {key} {value!r}, expected an integer from 0 to {MAX_ID}")
        return int(value)

    def _metadata(self, owner: dict[str, Any]) -> dict[str, Any]:
        metadata = owner.get("metadata", {})
        self._require(isinstance(metadata, dict), f"has the metadata {metadata!r}, expected an object")
        return dict(metadata)

    def _operations(self, properties: dict[str, Any]) -> tuple[GraphOperation, ...]:
        given = properties.get("operations", {})
        self._require(isinstance(given, dict | list), f"has the operations {given!r}, expected an object")
        found = []
        for operation in given.values() if isinstance(given, dict) else given:
            self._require(isinstance(operation, dict), f"has the operation {operation!r}, expected an object")
            kind, trigger = operation.get("type"), operation.get("trigger")
            self._require(isinstance(kind, str) and bool(kind), "has an operation without a 'type'")
            self._require(
                trigger in TRIGGERS, f"has an operation with trigger {trigger!r}, expected {', '.join(TRIGGERS)}"
            )
            found.append(GraphOperation(str(kind), str(trigger), self._metadata(operation)))
        return tuple(found)

    def _require(self, holds: bool, problem: str) -> None:
        if not holds:
            raise NoValidGraph(f"feature {self._index} {problem}", Location(self._file, self._line()))

    def _line(self) -> int | None:
        """Return the line on which the present feature begins, from a second reading that keeps positions."""
        assert self._index is not None
        decoder = json.JSONDecoder()
        at = self._text.find("[", self._text.find('"features"'))
        for index in range(self._index + 1):
            at = _skip(self._text, at + 1)
            if index == self._index:
                return self._text.count("\n", 0, at) + 1
            try:
                _, at = decoder.raw_decode(self._text, at)
            except ValueError:
                return None
            at = _skip(self._text, at)
        return None


def _skip(text: str, at: int) -> int:
    """Return the next position that is no white space."""
    while at < len(text) and text[at] in " \t\r\n":
        at += 1
    return at


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max
