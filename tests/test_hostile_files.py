"""Files from anywhere: each reader ends with one line about what is wrong, in little time and memory."""

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from properties import examples

MAX_MEMORY = 300 << 20
"""Bytes that this process may grow by while it reads all of them; each has at most a hundred kilobytes."""


@pytest.fixture(scope="module", autouse=True)
def _memory_stays_bounded() -> Iterator[None]:
    if sys.platform == "win32":
        yield
        return
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * unit < MAX_MEMORY


def _parameters(path: Path) -> Any:
    from rclpy.impl.parameter_file import read_file

    return read_file(path)


def _launch(path: Path) -> Any:
    from launch import LaunchContext
    from launch.launch_description_sources import AnyLaunchDescriptionSource
    from launch.launch_file_error import LaunchFileError

    try:
        description = AnyLaunchDescriptionSource(str(path)).get_launch_description(LaunchContext())
    except RuntimeError as error:
        if type(error) is RuntimeError:  # as ROS 2's front ends raise it; `ros2 launch` prints its text
            raise LaunchFileError.from_exception(error, str(path)) from None
        raise
    return description.get_launch_arguments()


def _rviz(path: Path) -> Any:
    from daidalos.studio.rviz_config import read_rviz

    return read_rviz(path)


def _plotjuggler(path: Path) -> Any:
    from daidalos.studio.plotjuggler_layout import read_plotjuggler

    return read_plotjuggler(path)


def _map(path: Path) -> Any:
    from daidalos.mapping.map_file import load_map

    return load_map(path)


def _bag(path: Path) -> Any:
    from daidalos.bags.metadata import read_metadata

    (path.parent / "metadata.yaml").write_bytes(path.read_bytes())
    return read_metadata(path.parent)


def _storage(path: Path) -> Any:
    from daidalos.bags.storage import settings as storage_settings

    return storage_settings(path)


def _overrides(path: Path) -> Any:
    from daidalos.cli.ros2.bag.qos_overrides import read_overrides

    return read_overrides(str(path))


def _bridge(path: Path) -> Any:
    from daidalos.nodes.ros_gz_bridge._mapping import read_file

    return read_file(path)


def _urdf(path: Path) -> Any:
    from daidalos.description import urdf

    return urdf.load(path)


def _sdf(path: Path) -> Any:
    from daidalos.description import sdf

    return sdf.load(path)


def _manifest(path: Path) -> Any:
    from daidalos.workspaces.manifest import read

    return read(path)


def _policy(path: Path) -> Any:
    from daidalos.cli.ros2.keystore.policy import access_control

    return access_control(path, "/a")


def _frame(path: Path) -> Any:
    from daidalos.studio.protocol import parse_text
    from daidalos.studio.records import complete

    return complete(parse_text(path.read_text(encoding="utf-8", errors="replace")))


def _docks(path: Path) -> Any:
    from daidalos.navigation.docking.database import read_docks

    return read_docks(path)


def _scenario(path: Path) -> Any:
    from daidalos.testing.documents import read_scenario

    return read_scenario(path)


def _calibration(path: Path) -> Any:
    from camera_info_manager.files import loadCalibrationFile

    try:
        return loadCalibrationFile(path, "camera")
    except ValueError as error:  # as the original raises it; drivers show its text
        if str(path) not in str(error):
            raise
        raise UserError(str(error)) from None


def _outputs(path: Path) -> Any:
    from rosbag2_py._rewrite import _outputs

    return _outputs(path)


def _route_graph(path: Path) -> Any:
    from daidalos.navigation.routes.loaders.geojson_graph_file_loader import GeoJsonGraphFileLoader

    return GeoJsonGraphFileLoader().load(path)


def _moving_heads(path: Path) -> Any:
    from daidalos.industry.lighting.configuration import read_configuration

    return read_configuration(path)


def _head_geometry(path: Path) -> Any:
    from daidalos.industry.lighting.calibration_file import read_geometry

    return read_geometry(path)


def _head_points(path: Path) -> Any:
    from daidalos.industry.lighting.calibration_file import read_points

    return read_points(path)


def _head_session(path: Path) -> Any:
    from daidalos.industry.lighting.calibration_file import read_session

    return read_session(path, "head")


def _fixture(path: Path) -> Any:
    from daidalos.industry.lighting.fixture_file import read_fixture

    return read_fixture(str(path))


def _motion_primitives(path: Path) -> Any:
    from daidalos.navigation.planners.state_lattice import read_lattice

    return read_lattice(path)


def _rapid_program(path: Path) -> Any:
    from daidalos.industry.rapid.sources import read_program_file

    return read_program_file(path)


Reader = Callable[[Path], Any]
YAML: dict[str, tuple[Reader, str]] = {
    "parameters": (_parameters, "a.yaml"),
    "launch": (_launch, "a.launch.yaml"),
    "rviz": (_rviz, "a.rviz"),
    "map": (_map, "a.yaml"),
    "bag": (_bag, "a.yaml"),
    "storage settings": (_storage, "a.yaml"),
    "qos overrides": (_overrides, "a.yaml"),
    "bridge": (_bridge, "a.yaml"),
    "docks": (_docks, "a.yaml"),
    "scenario": (_scenario, "a.scenario.yaml"),
    "calibration": (_calibration, "a.yaml"),
    "outputs of bag convert": (_outputs, "a.yaml"),
    "moving heads": (_moving_heads, "a.yaml"),
    "geometry of a head": (_head_geometry, "a.yaml"),
    "points of a head": (_head_points, "a.yaml"),
    "session of a head": (_head_session, "a.yaml"),
}
XML: dict[str, tuple[Reader, str]] = {
    "launch": (_launch, "a.launch.xml"),
    "plotjuggler": (_plotjuggler, "a.xml"),
    "urdf": (_urdf, "a.urdf"),
    "xacro": (_urdf, "a.xacro"),
    "sdf": (_sdf, "a.sdf"),
    "manifest": (_manifest, "package.xml"),
    "policy": (_policy, "a.xml"),
    "program of RAPID": (_rapid_program, "a.pgf"),
}
JSON: dict[str, tuple[Reader, str]] = {
    "frame of a client": (_frame, "a.json"),
    "route graph": (_route_graph, "a.geojson"),
    "fixture": (_fixture, "a.json"),
    "motion primitives": (_motion_primitives, "a.json"),
}

_BOMB = "\n".join(["a0: &a0 [x]", *(f"a{k + 1}: &a{k + 1} [{', '.join([f'*a{k}'] * 10)}]" for k in range(12))])
_MERGES = "\n".join(
    ["a0: &a0 {x: 1}", *(f"a{k + 1}: &a{k + 1} {{<<: [{', '.join([f'*a{k}'] * 10)}]}}" for k in range(12))]
)
HOSTILE_YAML: dict[str, bytes] = {
    "empty": b"",
    "aliases": _BOMB.encode(),
    "merges": _MERGES.encode(),
    "alias of itself": b"a: &a [*a]\nb: &b {c: *b}",
    "unknown alias": b"a: *nothing",
    "not UTF-8": b"a: 1\nb: \xff\xfe",
    "UTF-16": "a: 1".encode("utf-16"),
    "control character": b"a: 1\nb: \x01\n",
    "zero": b"a: \x00\n",
    "deep lists": b"[" * 4_000,
    "deep mappings": b"{a: " * 4_000,
    "deep dashes": b"- " * 4_000 + b"a",
    "deep and closed": b"a: " + b"[" * 3_000 + b"]" * 3_000,
    "list as a key": b"? [a, b]\n: 1",
    "mapping as a key": b"? {a: 1}\n: 1",
    "number as a key": b"1: {2: {3: 4}}\n1.5: a\ntrue: b\nnull: c",
    "long number": b"a: " + b"9" * 100_000,
    "long number as a key": b"9" * 3_000 + b": 1",
    "sexagesimal": b"a: " + b":".join([b"59"] * 2_000),
    "impossible date": b"a: 2020-13-45\nb: 2020-01-01T99:99:99",
    "python": b"a: !!python/object/apply:os.system ['exit 1']",
    "wrong tag": b"a: !!int text\nb: !!binary '*'\nc: !!set [1]",
    "no digits": b"a: !!int ",
    "no time": b"a: !!timestamp word",
    "no boolean": b"a: !!bool word",
    "null everywhere": b"launch:\nVisualization Manager:\nimage:\nrosbag2_bagfile_information:\n",
    "scalar": b"text",
    "list": b"- a\n- [b]\n- {c: null}",
    "two documents": b"a: 1\n---\nb: 2",
    "directive": b"%YAML 9.9\n---\na: 1",
    "tabs": b"a:\n\t- b",
}
HOSTILE_XML: dict[str, bytes] = {
    "empty": b"",
    "entities": (
        b'<!DOCTYPE r [<!ENTITY a "xxxxxxxxxx">'
        + b"".join(b'<!ENTITY a%d "%s">' % (k + 1, (b"&a%d;" % k if k else b"&a;") * 10) for k in range(12))
        + b"]><r>&a12;</r>"
    ),
    "external entity": b'<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot name="&a;">&a;</robot>',
    "deep": b"<a>" * 3_000 + b"</a>" * 3_000,
    "deep launch": b"<launch>" + b"<group>" * 3_000 + b"</group>" * 3_000 + b"</launch>",
    "deep robot": b'<robot name="r">' + b"<a>" * 3_000 + b"</a>" * 3_000 + b"</robot>",
    "deep world": b"<sdf version='1.6'>" + b"<model name='a'>" * 3_000 + b"</model>" * 3_000 + b"</sdf>",
    "not UTF-8": b"<robot name='\xff'/>",
    "UTF-16": "<launch/>".encode("utf-16"),
    "unknown encoding": b"<?xml version='1.0' encoding='nothing'?><robot/>",
    "control character": b"<launch>\x01</launch>",
    "zero": b"<launch>\x00</launch>",
    "wrong root": b"<nothing/>",
    "unclosed": b"<launch><group>",
    "numbers": b'<robot name="r"><link name="a"><inertial><mass value="'
    + b"9" * 100_000
    + b'"/></inertial></link></robot>',
    "not numbers": b'<robot name="r"><link name="a"><visual><origin xyz="nan 1e999 x"/></visual></link></robot>',
    "many attributes": b"<launch " + b" ".join(b'a%d="1"' % k for k in range(3_000)) + b"/>",
    "undeclared prefix": b"<a:launch/>",
    "long name": b"<" + b"a" * 100_000 + b"/>",
}
HOSTILE_JSON: dict[str, bytes] = {
    "empty": b"",
    "deep": b"[" * 100_000,
    "deep operation": b'{"op": "subscribe", "subscriptions": ' + b"[" * 100_000,
    "long number": b'{"op": "getParameters", "parameterNames": [], "id": ' + b"9" * 100_000 + b"}",
    "infinite": b'{"op": "fetchAsset", "uri": "a", "requestId": Infinity}',
    "lone surrogate": b'{"op": "fetchAsset", "uri": "\\ud800", "requestId": 1}',
    "list": b"[1]",
    "null": b'{"op": null}',
    "wrong types": json.dumps({"op": "advertise", "channels": [{"id": {}, "topic": 1}]}).encode(),
}


def _cases() -> list[Any]:
    return [
        pytest.param(reader, name, data, id=f"{kind}: {title}")
        for readers, inputs in ((YAML, HOSTILE_YAML), (XML, HOSTILE_XML), (JSON, HOSTILE_JSON))
        for kind, (reader, name) in readers.items()
        for title, data in inputs.items()
    ]


def read(reader: Reader, path: Path) -> None:
    """Read a file that may be refused: by an error whose message is one short line."""
    kind, text = None, "read"
    try:
        reader(path)
    except Exception as error:  # which is described here: the report of a deep recursion takes for ever
        kind, text = type(error), str(error)
    module = "" if kind is None else kind.__module__.partition(".")[0]
    assert module not in ("builtins", "yaml", "xml", "pyexpat"), f"{kind}: {text[:300]}"
    assert len(text.splitlines()) == 1, text[:300]
    assert len(text) < 2_000


@pytest.mark.slow
@pytest.mark.parametrize(("reader", "name", "data"), _cases())
def test_a_hostile_file_ends_in_one_line(tmp_path: Path, reader: Reader, name: str, data: bytes) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / name).write_bytes(data)
    read(reader, folder / name)


_MATRIX = {"rows": 3, "cols": 3, "data": [1.0] * 9}
DOCUMENTS: dict[str, Any] = {
    "parameters": {"/a": {"ros__parameters": {"b": [1, 2], "c": {"d": "e"}}}},
    "map": {
        "image": "a.pgm", "resolution": 0.05, "origin": [0, 0, 0], "negate": 0, "occupied_thresh": 0.6,
        "free_thresh": 0.2, "mode": "trinary",
    },
    "storage settings": {"noChunking": False, "chunkSize": 10, "compression": "Zstd", "compressionLevel": "Fast"},
    "qos overrides": {
        "/a": {
            "history": "keep_last", "depth": 3, "reliability": "reliable", "durability": "volatile",
            "deadline": {"sec": 1, "nsec": 0}, "liveliness": "automatic", "lifespan": {"sec": 1, "nsec": 0},
        }
    },
    "bridge": [
        {
            "ros_topic_name": "/a", "gz_topic_name": "/a", "ros_type_name": "std_msgs/msg/Bool",
            "gz_type_name": "gz.msgs.Boolean", "direction": "GZ_TO_ROS", "subscriber_queue": 5, "lazy": False,
        }
    ],
    "docks": {"docks": {"home": {"type": "t", "frame": "map", "pose": [0.0, 1.0, 2.0], "id": "x"}}},
    "scenario": {
        "name": "a", "timeout": 10.0, "seed": 3, "world": "empty", "parameters": {"speed": 0.2},
        "robots": [{"model": "turtlebot3_burger", "x": 1.0}],
        "nodes": [{"package": "p", "executable": "e", "parameters": {"a": [1]}, "remap": {"a": "b"}}],
        "steps": [
            {"wait": 1.0},
            {"drive": {"robot": "r", "linear": "$(var speed)", "seconds": 2}},
            {"eventually": {"topic": "/odom", "field": "a", "between": [0.0, 1.0], "within": 5}},
            {"walk": {"name": "w", "path": [[0, 0], [1, 1]], "speed": 1.0, "loop": True}},
            {"kill": "a"},
        ],
        "always": [{"topic": "/a", "field": "b", "below": 1}],
    },
    "calibration": {
        "image_width": 640, "image_height": 480, "camera_name": "c", "distortion_model": "plumb_bob",
        "camera_matrix": _MATRIX, "rectification_matrix": _MATRIX,
        "distortion_coefficients": {"rows": 1, "cols": 5, "data": [0.0] * 5},
        "projection_matrix": {"rows": 3, "cols": 4, "data": [1.0] * 12},
    },
    "outputs of bag convert": {
        "output_bags": [
            {
                "uri": "b", "storage_id": "mcap", "max_bagfile_size": 10, "topics": ["/a"], "all_topics": True,
                "start_time_ns": 1, "end_time_ns": 2, "compression_mode": "file", "compression_format": "zstd",
            }
        ]
    },
    "route graph": {
        "features": [
            {
                "geometry": {"type": "Point", "coordinates": [0.0, 1.0]},
                "properties": {
                    "id": 0, "frame": "map", "metadata": {"class": {"a": 1}},
                    "operations": {"stop": {"type": "a", "trigger": "NODE", "metadata": {"b": 1}}},
                },
            },
            {"geometry": {"type": "Point", "coordinates": [2.0, 1.0]}, "properties": {"id": 1}},
            {
                "geometry": {"type": "MultiLineString", "coordinates": [[[0, 1], [2, 1]]]},
                "properties": {"id": 2, "startid": 0, "endid": 1, "cost": 1.5, "overridable": False, "metadata": {}},
            },
        ]
    },
}  # fmt: skip
MAX_VARIANTS = 150
"""Variants of a document that are tried, spread over all; a longer step than 1 still comes by every odd value."""
_ODD = (
    None, True, -1, 1 << 64, 10**400, 1e308, float("nan"), float("inf"), "", "a\nb\r\x1b[2J", "word", "x" * 300,
    "../../../etc/passwd", "$(var nothing)", "\0", "\ud800", [], [None], [[[]]], {}, {"": None}, [float("nan")] * 3,
    ["a", {"b": 1}], [10**400] * 3, {"sec": 1e400}, {"x" * 300: "x" * 300},
)  # fmt: skip


def _variants(tree: Any) -> Iterator[Any]:
    """Yield a tree with each of its parts left out, doubled or replaced by something odd."""
    yield from _ODD
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield {other: tree[other] for other in tree if other != key}
            yield tree | {key + "x" * 300: value}
            yield from (tree | {key: variant} for variant in _variants(value))
    elif isinstance(tree, list):
        for at, value in enumerate(tree):
            yield tree[:at] + tree[at + 1 :]
            yield [*tree[:at], value, *tree[at:]]
            yield from ([*tree[:at], variant, *tree[at + 1 :]] for variant in _variants(value))


@pytest.mark.slow
@pytest.mark.parametrize("kind", DOCUMENTS)
def test_a_document_with_an_odd_part_is_read_or_refused(tmp_path: Path, kind: str) -> None:
    reader, name = (YAML | JSON)[kind]
    path = tmp_path / name
    variants = list(_variants(DOCUMENTS[kind]))
    for variant in variants[:: max(1, len(variants) // MAX_VARIANTS)]:
        path.write_text(json.dumps(variant), encoding="utf-8")  # which is YAML, too
        read(reader, path)


_WORDS = st.sampled_from(
    ("launch", "group", "node", "pkg", "name", "Displays", "Class", "image", "resolution", "origin", "/**", "topics",
     "ros__parameters", "history", "depth", "version", "files", "write", "if", "value", "Visualization Manager")
)  # fmt: skip
_SCALARS = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), _WORDS)
_TREES = st.recursive(
    _SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.one_of(_WORDS, st.integers(), st.none()), inner, max_size=4)
    ),
    max_leaves=15,
)


@pytest.mark.parametrize(("reader", "name"), YAML.values(), ids=YAML)
@examples(12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(tree=_TREES)
def test_any_tree_of_values_is_read_or_refused(tmp_path: Path, reader: Reader, name: str, tree: Any) -> None:
    import yaml

    (tmp_path / name).write_text(yaml.safe_dump(tree, allow_unicode=True), encoding="utf-8", errors="replace")
    read(reader, tmp_path / name)


@pytest.mark.parametrize(("reader", "name"), [*YAML.values(), *XML.values()])
@examples(8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=60))
def test_any_bytes_are_read_or_refused(tmp_path: Path, reader: Reader, name: str, data: bytes) -> None:
    (tmp_path / name).write_bytes(data)
    read(reader, tmp_path / name)
