"""`rosidl generate` and `rosidl translate`, with the generators and translators that are installed."""

import importlib
import json
import sys
from pathlib import Path

import pytest
from rosidl_cli.cli import main
from rosidl_cli.command.generate.api import generate
from rosidl_cli.command.helpers import interface_path_as_tuple, legacy_generator_arguments_file
from rosidl_cli.command.translate.api import translate
from rosidl_cli.extensions import parse_extension_specification

from daidalos.interfaces.definition import messages_of
from daidalos.interfaces.idl import read_idl
from daidalos.interfaces.library import BUILT_IN, Library
from daidalos.interfaces.parser import parse

SPHERE = """\
# A ball.

uint8 SOLID=1  # not hollow

# Middle [m]
geometry_msgs/Point center
float64 radius 0.5
string<=8[2] names ["a 'b'", "c"]
Layer[] layers
"""
SPHERE_IDL = """\
// generated from rosidl_adapter/resource/msg.idl.em
// with input from toys/msg/Sphere.msg
// generated code does not contain a copyright notice

#include "geometry_msgs/msg/Point.idl"
#include "toys/msg/Layer.idl"

module toys {
  module msg {
    typedef string<8> string__8__2[2];
    module Sphere_Constants {
      @verbatim (language="comment", text=
        "not hollow")
      const uint8 SOLID = 1;
    };
    @verbatim (language="comment", text=
      "A ball.")
    struct Sphere {
      @verbatim (language="comment", text=
        "Middle")
      @unit (value="m")
      geometry_msgs::msg::Point center;

      @default (value=0.5)
      double radius;

      @default (value="(\\"a 'b'\\", 'c')")
      string__8__2 names;

      sequence<toys::msg::Layer> layers;
    };
  };
};
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A package's folder, as the current one."""
    (tmp_path / "msg").mkdir()
    (tmp_path / "srv").mkdir()
    (tmp_path / "msg" / "Sphere.msg").write_text(SPHERE)
    (tmp_path / "msg" / "Layer.msg").write_text("float32 thickness 1.5\n")
    (tmp_path / "srv" / "Fill.srv").write_text("Sphere sphere\n---\nbool done\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def to_idl(package, file, output):
    return translate(package_name=package, interface_files=[file], output_format="idl", output_path=output)


def fields(interface):
    return [[(one.name, one.type.idl()) for one in message.fields] for message in messages_of(interface)]


def test_generated_classes_can_be_imported(folder, monkeypatch, capsys):
    files = ["msg/Sphere.msg", "msg/Layer.msg", "srv/Fill.srv"]
    assert main(["generate", "-t", "py", "-o", "out/toys", "toys", *files]) == 0
    assert capsys.readouterr() == ("", "")
    monkeypatch.syspath_prepend(folder / "out")
    importlib.invalidate_caches()
    try:
        from toys.msg import Layer, Sphere
        from toys.srv import Fill

        sphere = Fill.Request(sphere=Sphere(layers=[Layer()])).sphere
        assert (sphere.radius, sphere.layers[0].thickness, Sphere.SOLID) == (0.5, 1.5, 1)
    finally:
        for name in [name for name in sys.modules if name.partition(".")[0] == "toys"]:
            del sys.modules[name]


def test_included_packages_may_be_in_idl(folder):
    to_idl("toys", "msg/Layer.msg", Path("share/toys"))
    (folder / "msg" / "Stack.msg").write_text("toys/Layer[3] layers\n")
    [files] = generate(
        package_name="other",
        interface_files=[f"{folder}:msg/Stack.msg"],
        include_paths=["share"],
        output_path=Path("out"),
        types=["py[typesupport_implementations: [rosidl_typesupport_c]]"],
    )
    assert "out/msg/_stack.py" in files
    assert "from toys.msg._layer import Layer" in Path("out/msg/_stack.py").read_text()


def test_translation(folder):
    written = to_idl("toys", "msg/Sphere.msg", folder)
    assert written == [f"{folder}:msg/Sphere.idl"]
    assert (folder / "msg" / "Sphere.idl").read_text() == SPHERE_IDL


@pytest.mark.slow
def test_what_is_built_in_keeps_its_fields_in_idl(tmp_path):
    library = Library()
    names = [name for package in ("std_msgs", "test_msgs", "rcl_interfaces") for name in library.names(package)]
    assert len(names) > 50
    for name in names:
        package, kind, short = name.split("/")
        file = f"{BUILT_IN / package}:{kind}/{short}.{kind}"
        to_idl(package, file, tmp_path)
        found = read_idl((tmp_path / kind / f"{short}.idl").read_text(), short)
        read = parse(found.text, package, kind, short)
        expected = [
            [(one.name, one.type.idl()) for one in message.fields] for message in messages_of(library.get(name))
        ]
        assert [[(one.name, one.type.idl()) for one in message.fields] for message in messages_of(read)] == expected


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["generate", "-t", "cpp", "toys", "msg/Layer.msg"], "there is no 'cpp' in rosidl_cli.command.generate.type_"),
        (["generate", "-ts", "c", "toys", "msg/Layer.msg"], "there is no 'c' in rosidl_cli.command.generate.typesup"),
        (["generate", "-t", "py[", "toys", "msg/Layer.msg"], "py[ is not a valid spec"),
        (["generate", "-t", "py[no: 1]", "toys", "msg/Layer.msg"], "Failed to instantiate extension 'py'"),
        (["generate", "toys", "msg/None.msg"], "No such file or directory: "),
        (["generate", "toys", "/msg/Layer.msg"], "'/msg/Layer.msg' cannot be absolute"),
        (["generate", "toys", "msg/Sphere.msg"], "no definition of 'toys/msg/Layer' in "),
        (["generate", "toys", "msg/Wrong.msg"], "Wrong.msg:1: "),
        (["translate", "--to", "idl", "toys", "msg/Wrong.msg"], "Wrong.msg: "),
        (
            ["translate", "--to", "proto", "toys", "msg/Layer.msg"],
            "no translator from 'msg' to 'proto' for msg/",
        ),
    ],
)
def test_a_mistake_is_one_line(folder, capsys, arguments, fault):
    (folder / "msg" / "Wrong.msg").write_text("float32 Two Words\n")
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"rosidl {arguments[0]}: ")
    assert fault in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("spec", ["bad[", "bad[]", "bad[:]", "bad[a: [}]"])
def test_invalid_specifications(spec):
    with pytest.raises(ValueError, match="is not a valid spec"):
        parse_extension_specification(spec)


def test_specifications():
    assert parse_extension_specification("name") == ("name", {})
    assert parse_extension_specification("name[key: value, n: 2]") == ("name", {"key": "value", "n": 2})


def test_arguments_of_generators_with_a_file(folder):
    assert interface_path_as_tuple("sub:msg/A.idl") == (folder / "sub", Path("msg/A.idl"))
    dependency = folder / "share" / "bar" / "msg" / "Bar.idl"
    dependency.parent.mkdir(parents=True)
    dependency.touch()
    with legacy_generator_arguments_file(
        package_name="foo",
        interface_files=["msg/A.idl"],
        include_paths=["share"],
        templates_path="t",
        output_path="out",
    ) as path:
        content = json.loads(Path(path).read_text())
    assert content["idl_tuples"] == [f"{folder}:msg/A.idl"]
    assert content["ros_interface_dependencies"] == [f"bar:{dependency}"]
    assert content["output_dir"] == str(folder / "out")
    assert not Path(path).exists()
