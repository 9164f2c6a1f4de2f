"""The prefix with ``rclcpp``, the C++ messages and their CMake packages, built once and kept in the cache."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from daidalos.common.cache_folder import cache_folder
from daidalos.common.file_locks import lock_file
from daidalos.interfaces.cpp import all_headers
from daidalos.interfaces.definition import Interface, messages_of
from daidalos.interfaces.library import BUILT_IN, KINDS, Library
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.native.python_library import python_start
from daidalos.workspaces.native.toolchain import Toolchain

SOURCES = Path(__file__).parent / "cpp"
_TOOLS = (
    "ament_cmake", "ament_cmake_core", "ament_cmake_export_dependencies", "ament_cmake_export_include_directories",
    "ament_cmake_export_libraries", "ament_cmake_export_targets", "ament_cmake_gtest", "ament_cmake_gmock",
    "ament_cmake_libraries", "ament_cmake_pytest", "ament_cmake_python", "ament_cmake_ros",
    "ament_cmake_target_dependencies", "ament_cmake_test", "ament_cmake_uncrustify", "ament_cmake_copyright",
    "ament_cmake_cppcheck", "ament_cmake_cpplint", "ament_cmake_flake8", "ament_cmake_lint_cmake",
    "ament_cmake_pep257", "ament_cmake_xmllint", "ament_lint_auto", "ament_lint_common", "launch_testing_ament_cmake",
    "rosidl_default_generators", "rosidl_default_runtime",
)  # fmt: skip
_LIBRARIES = {
    "rosidl_runtime_cpp": "",
    "rclcpp": "builtin_interfaces rcl_interfaces rosgraph_msgs",
    "class_loader": "",  # found with rclcpp_components; what registers classes is in that
    "rclcpp_components": "class_loader rclcpp",
    "tf2": "builtin_interfaces geometry_msgs",
    "tf2_geometry_msgs": "geometry_msgs tf2",
    "tf2_ros": "rclcpp tf2 tf2_msgs",
}
"""Packages of the prefix that programs link, with what they need."""
_GENERATOR = Path(__file__).resolve().parents[2] / "interfaces" / "cpp.py"
_LAID_OUT = "laid_out"
_COMPILED = "compiled"
Say = Callable[[str], None]


def lay_out(toolchain: Toolchain) -> Path:
    """Return the prefix for a toolchain, with headers and CMake packages; they are written if they are not there.

    Raises
    ------
    WorkspaceError
        When this Python cannot be started by a C++ program.
    """
    start = python_start()
    definitions = (path for kind in KINDS for path in BUILT_IN.glob(f"*/{kind}/*.{kind}"))
    own = (path for path in Path(__file__).parent.rglob("*") if "__pycache__" not in path.parts)
    key = _digest([*own, _GENERATOR, *definitions], toolchain.version, toolchain.compiler, start)
    prefix = cache_folder() / "cpp" / key
    with _locked(prefix):
        if not (prefix / _LAID_OUT).is_file():
            shutil.rmtree(prefix, ignore_errors=True)
            _write_built_in(prefix)
            _write_cmake_packages(prefix)
            (prefix / "python_start.txt").write_text(start)
            shutil.copytree(SOURCES / "include", prefix / "include" / "rclcpp")
            shutil.copytree(SOURCES / "cmake", prefix / "share" / "daidalos_cpp" / "cmake")
            (prefix / _LAID_OUT).touch()
    return prefix


def compile_library(prefix: Path, toolchain: Toolchain, say: Say) -> None:
    """Compile the library of a prefix unless that was done before.

    Raises
    ------
    WorkspaceError
        When it does not compile; the message ends with the compiler's.
    """
    with _locked(prefix):
        if (prefix / _COMPILED).is_file():
            return
        began = time.monotonic()
        say("building the C++ library rclcpp, once for this compiler and this Python")
        _compile(prefix, toolchain)
        (prefix / _COMPILED).touch()
        say(f"built rclcpp in {time.monotonic() - began:.0f} s")


@contextmanager
def _locked(prefix: Path) -> Iterator[None]:
    prefix.parent.mkdir(parents=True, exist_ok=True)
    with prefix.with_suffix(".lock").open("ab") as lock:
        lock_file(lock, wait=True)
        yield


def _compile(prefix: Path, toolchain: Toolchain) -> None:
    includes = ";".join(str(prefix / "include" / name) for name in ["rclcpp", *Library().packages()])
    build = prefix / "build"
    commands = [
        [toolchain.cmake, "-S", str(SOURCES), "-B", str(build), *toolchain.generator, *compilers(toolchain),
         "-DCMAKE_BUILD_TYPE=Release", f"-DMESSAGE_INCLUDES={includes}", f"-DCMAKE_INSTALL_PREFIX={prefix}"],
        [toolchain.cmake, "--build", str(build), "--target", "install", "--parallel"],
    ]  # fmt: skip
    for command in commands:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            text = "\n".join((done.stdout + done.stderr).strip().splitlines()[-30:])
            raise WorkspaceError(f"the C++ library rclcpp cannot be built with '{toolchain.compiler}':\n{text}")
    shutil.rmtree(build)


def compilers(toolchain: Toolchain) -> list[str]:
    """Return CMake's arguments that name the compilers."""
    found = [f"-DCMAKE_CXX_COMPILER={toolchain.compiler}"]
    return [*found, f"-DCMAKE_C_COMPILER={toolchain.c_compiler}"] if toolchain.c_compiler else found


def _write_built_in(prefix: Path) -> None:
    library = Library()
    for package in library.packages():
        interfaces = [library.get(name) for name in library.names(package)]
        write_interfaces(package, interfaces, prefix)


def _write_cmake_packages(prefix: Path) -> None:
    folder = "${CMAKE_CURRENT_LIST_DIR}/../../daidalos_cpp/cmake"
    texts = {name: f'include("{folder}/ament_cmake.cmake")\nset({name}_FOUND TRUE)\n' for name in _TOOLS}
    texts["ament_cmake_auto"] = f'include("{folder}/ament_cmake_auto.cmake")\nset(ament_cmake_auto_FOUND TRUE)\n'
    for name, needs in _LIBRARIES.items():
        texts[name] = f"find_package(daidalos_cpp REQUIRED)\ndaidalos_library_package({name} {needs})\n"
    texts["rclcpp_components"] += f'include("{folder}/rclcpp_components.cmake")\n'
    for name, text in texts.items():
        path = prefix / "share" / name / "cmake" / f"{name}Config.cmake"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def library_packages() -> list[str]:
    """Return the packages with C++ libraries that there are, apart from those with messages."""
    return sorted(_LIBRARIES)


def write_interfaces(package: str, interfaces: Sequence[Interface], prefix: Path) -> list[Path]:
    """Write the C++ headers of a package's interfaces and its CMake package; return the files.

    Files whose content is the same are left untouched, so that nothing is compiled anew.
    """
    include = prefix / "include" / package
    files = {include / path: text for path, text in all_headers(interfaces).items()}
    nested = {name.split("/")[0] for one in interfaces for message in messages_of(one) for name in message.nested()}
    depends = " ".join(sorted(nested - {package, "service_msgs"}))
    files[prefix / "share" / package / "cmake" / f"{package}Config.cmake"] = (
        f"find_package(daidalos_cpp REQUIRED)\n"
        f'get_filename_component(_prefix "${{CMAKE_CURRENT_LIST_DIR}}/../../.." ABSOLUTE)\n'
        f'daidalos_interface_package({package} "${{_prefix}}/include/{package}" {depends})\n'
    )
    for path, text in files.items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
    return list(files)


def _digest(files: Iterable[Path], *texts: str) -> str:
    digest = hashlib.sha256(sys.platform.encode())
    for text in texts:
        digest.update(text.encode() + b"\0")
    for path in sorted(files):
        if path.is_file():
            digest.update(str(path.name).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
