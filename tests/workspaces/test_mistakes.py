"""Mistakes in the files of packages are named with file and line, in one message."""

import pytest

from . import packages

pytestmark = pytest.mark.slow


def build(terminal, name):
    one = terminal()
    printed = one.run(f"colcon build --packages-select {name} --event-handlers console_start_end- summary-")
    return one.status, printed


def test_a_field_of_unknown_type(workspace, terminal):
    packages.cmake_package(
        workspace / "src",
        "bad_message",
        'rosidl_generate_interfaces(${PROJECT_NAME} "msg/Sphere.msg" DEPENDENCIES geometry_msgs)',
        {"msg/Sphere.msg": "float64 radius\ngeometry_msgs/Pont center\n"},
        packages.INTERFACES_XML,
    )
    status, printed = build(terminal, "bad_message")
    assert status == 1
    path = workspace / "src" / "bad_message" / "msg" / "Sphere.msg"
    problem = "there is no message 'geometry_msgs/Pont'; did you mean 'geometry_msgs/Point' or 'geometry_msgs/Point32'?"
    assert f"{path}:2: {problem}" in printed.splitlines()
    assert "Traceback" not in printed


def test_a_line_that_is_no_field(workspace, terminal):
    packages.cmake_package(
        workspace / "src",
        "bad_line",
        'rosidl_generate_interfaces(${PROJECT_NAME} "srv/Add.srv")',
        {"srv/Add.srv": "int64 a\n---\nint64\n"},
        packages.INTERFACES_XML,
    )
    status, printed = build(terminal, "bad_line")
    assert status == 1
    assert f"{workspace}/src/bad_line/srv/Add.srv:3: " in printed
    assert "Traceback" not in printed


def test_a_folder_that_is_not_there(workspace, terminal):
    packages.cmake_package(workspace / "src", "no_folder", "install(DIRECTORY launch DESTINATION share/x)", {})
    status, printed = build(terminal, "no_folder")
    assert status == 1
    path = workspace / "src" / "no_folder" / "CMakeLists.txt"
    assert f"{path}:4: install(): there is no folder 'launch'" in printed.splitlines()


def test_a_parenthesis_too_few(workspace, terminal):
    packages.cmake_package(workspace / "src", "open_end", "install(FILES", {})
    status, printed = build(terminal, "open_end")
    assert status == 1
    assert f"{workspace}/src/open_end/CMakeLists.txt:4: the '(' after 'install' is never closed" in printed


def test_a_tag_that_is_not_closed(workspace, terminal):
    packages.cmake_package(workspace / "src", "bad_xml", "", {})
    path = workspace / "src" / "bad_xml" / "package.xml"
    path.write_text(path.read_text().replace("</license>", ""))
    try:
        printed = terminal().run("colcon list")
        fault = next(line for line in printed.splitlines() if "bad_xml" in line)
        assert "src/bad_xml/package.xml:10: not valid XML: mismatched tag (column 3)" in fault
    finally:
        path.unlink()


def test_a_manifest_without_a_license(workspace, terminal):
    packages.cmake_package(workspace / "src", "no_license", "", {})
    path = workspace / "src" / "no_license" / "package.xml"
    path.write_text(path.read_text().replace("<license>Apache-2.0</license>", ""))
    try:
        printed = terminal().run("rosdep keys --from-paths src")
        assert printed.splitlines() == [
            'ERROR: src/no_license/package.xml:2: The package node must contain at least one "license" tag'
        ]
    finally:
        path.unlink()


def test_a_dependency_that_nothing_is_known_of(workspace, terminal):
    packages.python_package(workspace / "src", "needy", {}, needs="rclpy no_such_thing python3-no-such-library")
    try:
        one = terminal()
        printed = one.run("rosdep install -i --from-path src/needy -y")
        assert one.status == 1
        assert printed.splitlines()[-1] == "needy: Cannot locate rosdep definition for [no_such_thing]"
        assert "pip\tno-such-library" in one.run("rosdep check --from-paths src/needy --skip-keys no_such_thing")
    finally:
        (workspace / "src" / "needy" / "package.xml").unlink()


def test_a_setup_file_that_fails(workspace, terminal):
    folder = packages.python_package(workspace / "src", "bad_setup", {})
    (folder / "setup.py").write_text("from setuptools import setup\nsetup(name=package_name)\n")
    status, printed = build(terminal, "bad_setup")
    assert status == 1
    assert printed.splitlines()[1:-1] == ["src/bad_setup/setup.py:2: NameError: name 'package_name' is not defined"]


def test_a_build_among_the_sources_is_warned_of(workspace, terminal):
    one = terminal()
    one.run("cd src")
    printed = one.run("colcon build --packages-select none")
    assert f"'{workspace}/src' is a folder of sources" in printed
    assert f"run 'colcon build' in '{workspace}'" in printed
    assert "is a folder of sources" not in one.run(f"cd {workspace} && colcon build --packages-select none")
