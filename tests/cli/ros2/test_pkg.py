"""`ros2 pkg`: packages that are made and looked at."""

import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import pytest

from .commands import ros2


def dependencies(package):
    return [element.text for element in ElementTree.parse(package / "package.xml").iter("depend")]


def test_a_python_package_can_be_installed_and_run(env, tmp_path):
    words = ("my_pkg", "--build-type", "ament_python", "--node-name", "hello", "--dependencies", "rclpy", "std_msgs")
    result = ros2("pkg", "create", *words, "--license", "MIT", env=env, cwd=tmp_path)
    assert result.status == 0
    package = tmp_path / "my_pkg"
    assert dependencies(package) == ["rclpy", "std_msgs"]
    assert "MIT License" in (package / "LICENSE").read_text()
    assert "hello = my_pkg.hello:main" in (package / "setup.py").read_text()
    program = "import my_pkg.hello; my_pkg.hello.main()"
    done = subprocess.run([sys.executable, "-c", program], cwd=package, capture_output=True, text=True, check=True)
    assert done.stdout == "Hi from my_pkg.\n"


def test_a_cmake_package_has_what_was_asked_for(env, tmp_path):
    words = ("my_pkg", "--node-name", "hello", "--library-name", "greeting", "--dependencies", "rclcpp")
    assert ros2("pkg", "create", *words, "--package-format", "2", env=env, cwd=tmp_path).status == 0
    package = tmp_path / "my_pkg"
    cmake = (package / "CMakeLists.txt").read_text()
    for line in ("project(my_pkg)", "find_package(rclcpp REQUIRED)", "add_executable(hello src/hello.cpp)"):
        assert line in cmake
    assert (package / "include" / "my_pkg" / "greeting.hpp").is_file()
    assert ElementTree.parse(package / "package.xml").getroot().get("format") == "2"
    assert dependencies(package) == ["rclcpp"]


def test_nothing_is_overwritten(env, tmp_path):
    (tmp_path / "my_pkg").mkdir()
    result = ros2("pkg", "create", "my_pkg", env=env, cwd=tmp_path)
    assert result.status == 1
    assert "Traceback" not in result.err
    assert list((tmp_path / "my_pkg").iterdir()) == []


@pytest.mark.parametrize("name", ["1pkg", "my pkg", "test"])
def test_names_that_packages_may_not_have(env, tmp_path, name):
    result = ros2("pkg", "create", name, "--build-type", "ament_python", env=env, cwd=tmp_path)
    assert result.status != 0
    assert "Traceback" not in result.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_packages_are_found(env, tmp_path):
    assert {"rclpy", "std_msgs", "turtlesim"} <= set(ros2("pkg", "list", env=env).out.split())
    prefix = ros2("pkg", "prefix", "std_msgs", env=env).out.strip()
    assert ros2("pkg", "prefix", "--share", "std_msgs", env=env).out == f"{prefix}/share/std_msgs\n"
    assert ros2("pkg", "xml", "std_msgs", "-t", "name", env=env).out == "std_msgs\n"
    result = ros2("pkg", "xml", "std_msgs", "-t", "licens", env=env)
    assert (result.status, result.out) == (1, "")
    assert "Did you mean 'license'?" in result.err
    assert "demo_nodes_py talker\n" in ros2("pkg", "executables", env=env).out
    assert "demo_nodes_py talker\n" in ros2("pkg", "executables", "demo_nodes_py", env=env).out
