"""The lazy packages: what they list is there, and importing them costs little."""

import importlib
import inspect
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(importlib.import_module("launch").__file__).parent.parent
STUBS = sorted(
    ".".join(stub.parent.relative_to(ROOT).parts)
    for package in ("launch", "launch_xml", "launch_yaml", "launch_ros", "launch_testing", "launch_pytest")
    for stub in (ROOT / package).rglob("__init__.pyi")
)


@pytest.mark.parametrize("package", STUBS)
def test_every_listed_name_is_there(package):
    module = importlib.import_module(package)
    for found in pkgutil.iter_modules(module.__path__):
        importlib.import_module(f"{package}.{found.name}")
    stub = Path(module.__file__).with_suffix(".pyi").read_text()
    for name in module.__all__:
        value = getattr(module, name)
        # A module that has been imported must not hide a function of the same name.
        assert inspect.ismodule(value) == (f"from . import {name} as" in stub), name
    assert set(module.__all__) <= set(dir(module))


def test_every_module_of_actions_and_substitutions_is_listed():
    for package in ("launch.actions", "launch.substitutions", "launch.event_handlers", "launch.conditions"):
        module = importlib.import_module(package)
        stub = (ROOT / package.replace(".", "/") / "__init__.pyi").read_text()
        for file in Path(module.__file__).parent.glob("[a-z]*.py"):
            assert f"from .{file.stem} " in stub or file.stem == "log_info", file.stem


def test_modules_are_there_without_an_import_of_their_own():
    code = "import launch; launch.event_handlers.on_process_start.OnProcessStart; launch.actions.opaque_function"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_unknown_names():
    with pytest.raises(AttributeError, match=r"module 'launch\.actions' has no attribute 'NoSuchAction'"):
        importlib.import_module("launch.actions").NoSuchAction  # noqa: B018
    with pytest.raises(ImportError, match="NoSuchAction"):
        exec("from launch.actions import NoSuchAction")


def run(program):
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout


def test_describing_does_not_pay_for_running():
    heavy = "{'asyncio', 'yaml', 'psutil', 'rclpy', 'numpy', 'importlib.metadata', 'xml.etree.ElementTree'}"
    program = f"""
import sys
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
print(sorted({heavy} & set(sys.modules)))
"""
    assert run(program) == "[]\n"
    assert run(f"import sys, launch; print(sorted({heavy} & set(sys.modules)))") == "[]\n"
