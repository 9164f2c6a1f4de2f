"""Which executables in C++ are built."""

import shutil
import subprocess
from pathlib import Path

import pytest

from daidalos.workspaces.cmake.contents import Target
from daidalos.workspaces.compiling import plan, summary


def target(name, *sources, kind="executable", links=(), destination="lib/pkg"):
    return Target(name, kind, "", [Path(source) for source in sources], list(links), destination=destination)


def planned(*targets, build=Path("build")):
    return plan({one.name: one for one in targets}, build)


@pytest.fixture
def compiler(monkeypatch):
    monkeypatch.setattr("shutil.which", lambda name: f"/bin/{name}")


def test_plain_executables_are_compiled(compiler):
    compilations, left_out = planned(target("node", "a.cpp", "b.cpp", links=["Threads::Threads"]))
    assert left_out == []
    assert compilations[0].destination == "lib/pkg/node"
    assert compilations[0].command[1:] == [
        *("-O2", "-std=c++17", "a.cpp", "b.cpp", "-o", str(Path("build/node")), "-pthread"),
    ]


def test_the_packages_own_libraries_are_compiled_into_them(compiler):
    library = target("parts", "parts.cpp", kind="library", destination="lib")
    compilations, left_out = planned(library, target("node", "a.cpp", links=["parts"]))
    assert left_out == []
    assert {"a.cpp", "parts.cpp"} <= set(compilations[0].command)


def test_what_needs_other_packages_is_left_out_also_by_way_of_a_library(compiler):
    library = target("parts", "parts.cpp", kind="library", links=["rclcpp::rclcpp"], destination="lib")
    compilations, left_out = planned(library, target("node", "a.cpp", links=["parts", "std_msgs"]))
    assert compilations == []
    assert summary(left_out) == (
        "left out: parts, node (C++ that needs rclcpp, std_msgs, of which only the Python side comes with Daidalos)"
    )


def test_a_library_without_a_name_is_that_of_the_packages_messages(compiler):
    """`target_link_libraries(node "${cpp_typesupport_target}")`, a variable that nothing sets here."""
    line = summary(planned(target("node", "a.cpp", links=["", "Qt5::Widgets"]))[1])
    assert "needs its own messages, Qt5, of which" in line


def test_what_became_of_a_target_is_a_sentence(compiler):
    (left_out,) = planned(target("talker", "a.cpp", links=["rclcpp"]))[1]
    assert left_out.sentence == (
        "'talker' is C++ and was left out of the build: "
        "it needs rclcpp, of which only the Python side comes with Daidalos"
    )


def test_only_the_flag_is_taken_from_a_library(compiler):
    line = summary(planned(target("node", "a.cpp", links=["lifecycle_msgs", "-lusb"]))[1])
    assert "needs lifecycle_msgs, usb, of which" in line


def test_long_lists_are_cut(compiler):
    line = summary(planned(target("node", "a.cpp", links=["a", "b", "c", "d", "e"]))[1])
    assert "needs a, b, c, d and more, of which" in line


def test_without_a_compiler_that_is_the_reason(monkeypatch):
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert summary(planned(target("node", "a.cpp"))[1]) == "left out: node (this machine has no C++ compiler)"


def test_nothing_left_out_needs_no_line():
    assert summary([]) == ""


@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no C++ compiler")
def test_the_command_makes_a_program(tmp_path):
    source = tmp_path / "a.cpp"
    source.write_text("#include <cstdio>\nint main() { std::puts(WORD); }\n")
    node = target("node", source)
    node.definitions.append('WORD="made"')
    compilation = planned(node, build=tmp_path)[0][0]
    subprocess.run(compilation.command, check=True)
    assert subprocess.run([compilation.output], capture_output=True, text=True).stdout == "made\n"
