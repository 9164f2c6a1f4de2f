"""Files from anywhere: each reader ends with one line about what is wrong, in little time and memory."""

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

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
}
XML: dict[str, tuple[Reader, str]] = {
    "launch": (_launch, "a.launch.xml"),
    "plotjuggler": (_plotjuggler, "a.xml"),
    "urdf": (_urdf, "a.urdf"),
    "xacro": (_urdf, "a.xacro"),
    "sdf": (_sdf, "a.sdf"),
    "manifest": (_manifest, "package.xml"),
    "policy": (_policy, "a.xml"),
}
JSON: dict[str, tuple[Reader, str]] = {"frame of a client": (_frame, "a.json")}

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
