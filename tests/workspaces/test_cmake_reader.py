"""CMakeLists.txt read without CMake; where CMake is installed, it is asked for its opinion."""

import contextlib
import shutil
import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.workspaces.cmake.reader import read_package
from daidalos.workspaces.cmake.syntax import parse
from daidalos.workspaces.errors import WorkspaceError
from properties import examples

from . import packages

PYTHON_FOLDER = "lib/python3.11/site-packages"


@pytest.fixture
def read(tmp_path):
    """Reads a package made of these commands and files."""

    def read_commands(body, files=None, **definitions):
        packages.write(tmp_path / "source", {**(files or {}), "CMakeLists.txt": f"project(pkg)\n{body}"})
        return read_package(tmp_path / "source", tmp_path / "build", tmp_path / "prefix", PYTHON_FOLDER, definitions)

    return read_commands


def placed(contents):
    return {file.destination: file for file in contents.files}


def test_a_folder_is_installed_with_its_name_or_without(read):
    files = {"launch/a.launch.py": "", "launch/deep/b.yaml": ""}
    body = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\ninstall(DIRECTORY launch/ DESTINATION share/x)"
    assert sorted(placed(read(body, files))) == [
        "share/pkg/launch/a.launch.py",
        "share/pkg/launch/deep/b.yaml",
        "share/x/a.launch.py",
        "share/x/deep/b.yaml",
    ]


def test_patterns_choose_files(read):
    files = {"d/a.py": "", "d/b.txt": "", "d/skip/c.py": ""}
    body = 'install(DIRECTORY d DESTINATION share FILES_MATCHING PATTERN "*.py" PATTERN skip EXCLUDE)'
    assert list(placed(read(body, files))) == ["share/d/a.py"]


def test_programs_are_executable_and_may_be_renamed(read):
    body = "install(PROGRAMS scripts/node.py DESTINATION lib/${PROJECT_NAME} RENAME node)"
    contents = read(body, {"scripts/node.py": "#!/usr/bin/env python3\n"})
    assert placed(contents)["lib/pkg/node"].executable


def test_optional_files_may_be_missing(read):
    assert read("install(FILES none.txt DESTINATION share OPTIONAL)").files == []


def test_loops_functions_and_conditions_run(read):
    files = {"a/x": "", "b/x": "", "c/x": ""}
    body = """
        set(FOLDERS a b c)
        list(REMOVE_ITEM FOLDERS c)
        function(share_it folder)
          cmake_parse_arguments(ARG "LOUD" "INTO" "" ${ARGN})
          if(ARG_LOUD AND NOT ARG_INTO STREQUAL "")
            install(DIRECTORY ${folder} DESTINATION ${ARG_INTO})
          endif()
        endfunction()
        foreach(folder IN LISTS FOLDERS)
          share_it(${folder} LOUD INTO "share/${PROJECT_NAME}")
          share_it(${folder} INTO share/never)
        endforeach()
        """
    assert sorted(placed(read(body, files))) == ["share/pkg/a/x", "share/pkg/b/x"]


def test_folders_below_have_their_own_paths_and_variables(read):
    files = {
        "below/CMakeLists.txt": "set(X 2)\ninstall(FILES f.txt DESTINATION share/${X})\nset(Y 3 PARENT_SCOPE)",
        "below/f.txt": "",
    }
    contents = read("set(X 1)\nadd_subdirectory(below)\ninstall(FILES below/f.txt DESTINATION share/${X}${Y})", files)
    assert sorted(placed(contents)) == ["share/13/f.txt", "share/2/f.txt"]


def test_definitions_of_the_command_line_count(read):
    body = "option(BUILD_IT x ON)\nif(BUILD_IT)\n install(FILES f DESTINATION share)\nendif()"
    assert placed(read(body, {"f": ""}))
    assert not placed(read(body, {"f": ""}, BUILD_IT="OFF"))


def test_globs_find_interfaces(read):
    body = """
        file(GLOB msgs RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} "msg/*.msg")
        rosidl_generate_interfaces(
            ${PROJECT_NAME} ${msgs} "srv/C.srv" DEPENDENCIES std_msgs LIBRARY_NAME ${PROJECT_NAME})
        """
    contents = read(body, {"msg/A.msg": "", "msg/B.msg": "", "srv/C.srv": "---\n"})
    assert [path.name for path in contents.interfaces.files] == ["A.msg", "B.msg", "C.srv"]


def test_python_packages_have_the_executables_of_their_setup_cfg(read):
    files = {
        "pkg/__init__.py": "",
        "pkg/node.py": "",
        "setup.cfg": "[options.entry_points]\nconsole_scripts =\n  node = pkg.node:main\n",
    }
    contents = read("ament_python_install_package(${PROJECT_NAME})", files)
    assert sorted(placed(contents)) == [f"{PYTHON_FOLDER}/pkg/__init__.py", f"{PYTHON_FOLDER}/pkg/node.py"]
    assert contents.python_packages[0].scripts == (("node", "pkg.node:main"),)


def test_plugins_resources_and_hooks_are_registered(read):
    files = {"plugins.xml": "<library/>", "env/models.dsv.in": "prepend-non-duplicate;MODELS;share/@PROJECT_NAME@\n"}
    body = """
        pluginlib_export_plugin_description_file(nav2_core plugins.xml)
        ament_index_register_resource(rviz_ogre_media_exports CONTENT "a;b")
        ament_environment_hooks("env/models.dsv.in")
        ament_environment_hooks("${ament_cmake_package_templates_ENVIRONMENT_HOOK_LIBRARY_PATH}")
        """
    contents = read(body, files)
    assert [(one.type, one.content) for one in contents.resources] == [
        ("nav2_core__pluginlib__plugin", "share/pkg/plugins.xml\n"),
        ("rviz_ogre_media_exports", "a;b"),
    ]
    assert contents.hooks == ["share/pkg/environment/models.dsv"]
    hook = placed(contents)["share/pkg/environment/models.dsv"].source
    assert hook.read_text() == "prepend-non-duplicate;MODELS;share/pkg\n"


def test_what_is_not_understood_is_noted_with_its_line(read):
    assert (
        read("\nmake_coffee(STRONG)")
        .notes[0]
        .endswith("CMakeLists.txt:3: make_coffee() is not understood and was left out")
    )


def test_what_programs_and_other_packages_would_have_made_is_no_mistake(read):
    """Real files do all of this, and CMake with ROS 2 builds them."""
    contents = read("""
        execute_process(COMMAND git describe OUTPUT_VARIABLE GIT)
        string(STRIP ${GIT} GIT)
        find_package(QT NAMES Qt6 Qt5 REQUIRED COMPONENTS Widgets)
        if(${QT_VERSION_MAJOR} GREATER "5")
          install(FILES none DESTINATION share)
        endif()
        add_executable(node ${CMAKE_CURRENT_BINARY_DIR}/made.cpp)
        install(FILES ${CMAKE_CURRENT_BINARY_DIR}/made.hpp DESTINATION include)
        install(DIRECTORY ${CMAKE_BINARY_DIR}/docs DESTINATION share)
        """)
    assert contents.files == []
    assert contents.targets["node"].links == ["generated code"]
    assert len(contents.notes) == 3


@pytest.mark.parametrize(
    ("body", "line", "fault"),
    [
        ("if(A)\n", 2, "if() has no endif()"),
        ("endforeach()\n", 2, "endforeach() without its foreach()"),
        ("install(FILES x DESTINATION share)\n", 2, "there is no file 'x'"),
        ("install(FILES x)\n", 2, "needs a DESTINATION"),
        ('set(A "b)\n', 2, "a quoted text is never closed"),
        ("install FILES\n", 2, "expected '(' after 'install'"),
        ("add_executable(node none.cpp)\n", 2, "there is no file 'none.cpp'"),
        ("rosidl_generate_interfaces(${PROJECT_NAME} msg/No.msg)\n", 2, "there is no file 'msg/No.msg'"),
        ('message(FATAL_ERROR "not here")\n', 2, "not here"),
        ("if(A B C)\nendif()\n", 2, "where AND or OR was expected"),
        ("list(LENGTH)\n", 2, "list() cannot be run with these arguments"),
        ("install(FILES CMakeLists.txt DESTINATION /etc)\n", 2, "outside of the folder to install to"),
    ],
)
def test_mistakes_are_named_with_their_line(read, body, line, fault):
    with pytest.raises(WorkspaceError) as caught:
        read(body)
    assert f"CMakeLists.txt:{line}: " in str(caught.value)
    assert fault in str(caught.value)


def test_a_file_without_project_is_named(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text("find_package(ament_cmake REQUIRED)\n")
    with pytest.raises(WorkspaceError, match=r"there is no project\(\)"):
        read_package(tmp_path, tmp_path / "build", tmp_path / "prefix", PYTHON_FOLDER)


@given(st.text(alphabet='abif(){}$;"\\#[]= \n', max_size=60))
@examples(300)
def test_any_text_is_read_or_refused(text):
    with contextlib.suppress(WorkspaceError):
        parse(text, "CMakeLists.txt")


CONDITIONS = """
    set(ON_IT ON)
    set(OFF_IT OFF)
    set(NAME walk)
    set(EMPTY "")
    set(LIST a b c)
    """
CASES = [
    "ON_IT", "OFF_IT", "NOT OFF_IT", "NAME", "UNSET", "EMPTY", "1", "0", "2.5", "-1", "YES", "N", "foo-NOTFOUND",
    '"ON_IT"', '"1"', "NAME STREQUAL walk", '"NAME" STREQUAL "walk"', "walk STREQUAL NAME", "NAME MATCHES ^w.*k$",
    "a IN_LIST LIST", "d IN_LIST LIST", "1.10 VERSION_GREATER 1.9", "1.2.0 VERSION_EQUAL 1.2", "3 LESS 20",
    "abc LESS 20", "a STRLESS b", "DEFINED NAME", "DEFINED UNSET", "NOT DEFINED UNSET AND ON_IT",
    "ON_IT OR UNSET AND OFF_IT", "(ON_IT OR UNSET) AND OFF_IT", "EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt",
    "IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}", "TARGET none", "COMMAND set", "NOT (ON_IT AND NAME)",
    "5 GREATER_EQUAL 5", "a STREQUAL a AND b STREQUAL c",
]  # fmt: skip
VALUES = [
    'list(APPEND LIST d e)\nset(R "${LIST}")',
    "list(LENGTH LIST R)",
    "list(GET LIST 0 -1 R)",
    "list(FIND LIST b R)",
    'list(JOIN LIST "+" R)',
    "list(FILTER LIST EXCLUDE REGEX ^b)\nset(R ${LIST})",
    "list(REVERSE LIST)\nset(R ${LIST})",
    "list(INSERT LIST 1 x)\nset(R ${LIST})",
    "list(TRANSFORM LIST PREPEND p_)\nset(R ${LIST})",
    'string(REPLACE "l" "L" R "hello")',
    'string(REGEX REPLACE "(.)b" "\\\\1_" R "abab")',
    'string(REGEX MATCH "[0-9]+" R "ab12cd34")',
    'string(TOUPPER "${NAME}" R)',
    'string(STRIP "  x " R)',
    "get_filename_component(R a/b.tar.gz NAME_WE)",
    "get_filename_component(R a/b.tar.gz EXT)",
    "get_filename_component(R a/b.tar.gz DIRECTORY)",
    "set(INNER NAME)\nset(R ${${INNER}})",
    "set(R a;b c)",
    'set(R "a;b" c)',
    "set(R [==[a ${NAME} ]]b]==])",
    'set(R "a\\tb\\${NAME}")',
    "set(R)\nforeach(i RANGE 2 6 2)\n list(APPEND R ${i})\nendforeach()",
    "set(R)\nforeach(i a b)\n if(i STREQUAL b)\n break()\n endif()\n list(APPEND R ${i})\nendforeach()",
    "set(R x)\nmacro(m v)\n set(R ${v}${ARGC}${ARGN})\nendmacro()\nm(1 2 3)",
    "set(R x)\nfunction(f v)\n set(R ${v})\nendfunction()\nf(1)",
    "set(R x)\nfunction(f v)\n set(R ${v}${ARGV1} PARENT_SCOPE)\n return()\nendfunction()\nf(1 2)",
]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cmake") is None, reason="there is no cmake")
def test_cmake_itself_agrees(read, tmp_path):
    questions = [f"if({case})\n set(R yes)\nelse()\n set(R no)\nendif()" for case in CASES]
    commands = [
        f'{CONDITIONS}\nunset(R)\n{question}\nmessage("{number}=${{R}}")'
        for number, question in enumerate([*questions, *VALUES])
    ]
    contents = read("\n".join(commands))
    ours = dict(note.partition(": ")[2].split("=", 1) for note in contents.notes)
    script = tmp_path / "script"
    packages.write(
        script, {"CMakeLists.txt": "cmake_minimum_required(VERSION 3.20)\nproject(pkg NONE)\n" + "\n".join(commands)}
    )
    done = subprocess.run(
        ["cmake", "-S", str(script), "-B", str(tmp_path / "out")], capture_output=True, text=True, check=True
    )
    theirs = dict(line.split("=", 1) for line in done.stderr.splitlines() if line[:1].isdigit())
    assert len(theirs) == len(commands)
    wrong = {
        (*CASES, *VALUES)[int(number)]: (ours.get(number), value)
        for number, value in theirs.items()
        if ours.get(number) != value
    }
    assert wrong == {}
