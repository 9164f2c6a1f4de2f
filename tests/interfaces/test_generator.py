"""Classes of users' own packages: written to a folder, imported from there, used like the built-in ones."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from daidalos.interfaces.build import write_built_in
from daidalos.interfaces.codec import codec_of
from daidalos.interfaces.generator import module_name, write_package
from daidalos.interfaces.library import BUILT_IN, InterfaceNotFound, Library

DEFINITIONS = {
    "msg/Tool.msg": (
        '# A tool.\n\nstring name "torch"  # what it is called\nuint8 KIND_TORCH=1\nfloat64[3] offset\nbool from\n'
    ),
    "msg/Point.msg": "geometry_msgs/Point[] points\nPoint2[<=2] pair\n",
    "msg/Point2.msg": "int32 x\nint32 y\n",
    "msg/Shadows.msg": (
        "string property\nint32 unknown\nint32 range\nfloat64 float -inf\nbool bool\nstring str\n"
        "Point2[2] list\nint8 value\n"
    ),
    "srv/Change.srv": "Tool tool\n---\nbool success\nstring message\n",
    "action/Weld.action": "float32 speed 0.5\n---\nfloat32 length\n---\nfloat32 progress\n",
}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Iterator[str]:
    """The name of an interface package that can be imported."""
    name = f"cell_msgs_{abs(hash(request.node.name)) % 10**6}"
    for path, text in DEFINITIONS.items():
        file = tmp_path / "share" / name / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    library = Library([tmp_path / "share", BUILT_IN])
    write_package(name, [library.get(one) for one in library.names(name)], library.get, tmp_path / "python")
    monkeypatch.syspath_prepend(str(tmp_path / "python"))
    yield name
    for module in [module for module in sys.modules if module.split(".")[0] == name]:
        del sys.modules[module]


def module(package: str, kind: str) -> ModuleType:
    return importlib.import_module(f"{package}.{kind}")


def test_messages_of_a_users_package(package):
    tool = module(package, "msg").Tool(offset=[1.0, 2.0, 3.0])
    assert tool.name == "torch"
    assert tool.KIND_TORCH == 1
    codec = codec_of(type(tool))
    assert codec.decode(codec.encode(tool)) == tool
    with pytest.raises(AssertionError, match="'name'"):
        tool.name = 1


def test_fields_may_be_called_like_what_is_built_into_python(package):
    shadows = module(package, "msg").Shadows(property="a", unknown=1, range=2, bool=True, str="b", value=3)
    assert (shadows.property, shadows.unknown, shadows.range, shadows.float) == ("a", 1, 2, -math.inf)
    assert (shadows.bool, shadows.str, shadows.value) == (True, "b", 3)
    assert [point.x for point in shadows.list] == [0, 0]
    shadows.property = "c"
    codec = codec_of(type(shadows))
    assert codec.decode(codec.encode(shadows)) == shadows
    with pytest.raises(AssertionError, match="'property'"):
        shadows.property = 1


def test_a_field_may_be_called_like_a_word_of_python(package):
    assert module(package, "msg").Tool(from_=True).from_ is True


def test_two_classes_of_one_name_are_told_apart(package):
    messages, geometry = module(package, "msg"), importlib.import_module("geometry_msgs.msg")
    message = messages.Point(points=[geometry.Point(x=1.0)], pair=[messages.Point2(y=2)])
    assert codec_of(messages.Point).decode(codec_of(messages.Point).encode(message)) == message
    with pytest.raises(AssertionError, match="sub message of type 'Point'"):
        messages.Point(points=[messages.Point()])


def test_services_and_actions_of_a_users_package(package):
    change = module(package, "srv").Change
    assert change.Request().tool.name == "torch"
    weld = module(package, "action").Weld
    assert weld.Goal().speed == 0.5
    goal = weld.Impl.SendGoalService.Request(goal=weld.Goal(speed=1.5))
    assert codec_of(type(goal)).decode(codec_of(type(goal)).encode(goal)) == goal


def test_definitions_explain_themselves_where_they_are_used(package):
    kind = module(package, "msg").Tool
    assert kind.__doc__.startswith("A tool.")
    assert "what it is called" in kind.__doc__
    assert kind.__init__.__annotations__["name"] == "str"
    assert "Tool" in dir(module(package, "msg"))
    assert (Path(importlib.import_module(package).__file__).parent / "py.typed").is_file()


def test_nothing_is_imported_before_it_is_used(package):
    module(package, "msg").Point2()
    assert f"{package}.msg._point2" in sys.modules
    assert f"{package}.msg._tool" not in sys.modules
    with pytest.raises(AttributeError, match="no attribute 'Hammer'"):
        _ = module(package, "msg").Hammer


def test_a_type_that_is_not_defined_is_named(tmp_path):
    file = tmp_path / "share" / "cell_msgs" / "msg" / "Cell.msg"
    file.parent.mkdir(parents=True)
    file.write_text("Robot robot\n")
    library = Library([tmp_path / "share"])
    with pytest.raises(InterfaceNotFound, match="cell_msgs/msg/Robot"):
        write_package("cell_msgs", [library.get("cell_msgs/msg/Cell")], library.get, tmp_path / "python")


def test_what_is_no_longer_defined_is_removed(tmp_path):
    share, target = tmp_path / "share", tmp_path / "python"
    target.mkdir()
    for name in ("One", "Two"):
        file = share / "some_msgs" / "msg" / f"{name}.msg"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("int32 data\n")
    write_built_in(share, target)
    (share / "some_msgs" / "msg" / "Two.msg").unlink()
    write_built_in(share, target)
    assert sorted(path.name for path in (target / "some_msgs" / "msg").iterdir()) == ["__init__.py", "_one.py"]


@pytest.mark.parametrize(
    ("name", "module"),
    [
        ("TFMessage", "_tf_message"),
        ("PointCloud2", "_point_cloud2"),
        ("UInt8", "_u_int8"),
        ("ColorRGBA", "_color_rgba"),
    ],
)
def test_modules_are_named_as_rosidl_names_them(name, module):
    assert module_name(name) == module
