"""Commands of catkin, ROS 1's build system."""

from __future__ import annotations

from pathlib import Path

from daidalos.workspaces.cmake.basics import COMMANDS as BASICS
from daidalos.workspaces.cmake.contents import Contents, InstalledFile, Interfaces
from daidalos.workspaces.cmake.installs import COMMANDS as INSTALLS
from daidalos.workspaces.cmake.installs import files_below
from daidalos.workspaces.cmake.interpreter import Call, Handler, Interpreter, keywords
from daidalos.workspaces.errors import WorkspaceError

_NOT_SHARED = {"src", "include", "msg", "srv", "action"}
_SKIPPED_FOLDERS = {"build", "devel", "install", "log", ".git"}


def install_remaining(folder: Path, contents: Contents) -> None:
    """Install files that no other command installs; catkin packages may be used from their source folder.

    Launch files, descriptions and the like go to the package's share folder, scripts to its executables.
    """
    placed = {file.destination for file in contents.files}
    for path in files_below(folder):
        inside = path.relative_to(folder)
        if inside.parts[0] in _SKIPPED_FOLDERS or inside.name in ("CMakeLists.txt", "package.xml"):
            continue
        wanted = [] if inside.parts[0] in _NOT_SHARED else [f"share/{contents.project}/{inside.as_posix()}"]
        with path.open("rb") as file:
            wanted += [f"lib/{contents.project}/{path.name}"] if file.read(2) == b"#!" else []
        for destination in wanted:
            if destination not in placed:
                contents.files.append(InstalledFile(path, destination, destination.startswith("lib/")))


def _interface_files(run: Interpreter, call: Call) -> None:
    kind = {"add_message_files": "msg", "add_service_files": "srv", "add_action_files": "action"}[call.name]
    found, _ = keywords(call.values, ("NOINSTALL",), ("DIRECTORY", "BASE_DIR"), ("FILES",))
    folder = run.path(found.get("DIRECTORY", [kind])[0])
    paths = [folder / name for name in found["FILES"]] if "FILES" in found else sorted(folder.glob(f"*.{kind}"))
    for path in paths:
        if not path.is_file():
            raise WorkspaceError(f"{call.name}(): there is no file '{path}'", call.where)
    before = run.contents.interfaces.files if run.contents.interfaces else []
    run.contents.interfaces = Interfaces(before + paths, call.where)


def _find_package(run: Interpreter, call: Call) -> None:
    BASICS["find_package"](run, call)
    if call.values[0] == "catkin":
        components = keywords(call.values[1:], options=("REQUIRED",), many=("COMPONENTS",))[0].get("COMPONENTS", [])
        run.variables["catkin_LIBRARIES"] = ";".join(components)
        run.variables.update(_destinations(run.contents.project, run.variables["PYTHON_INSTALL_DIR"]))


def _destinations(project: str, python_folder: str) -> dict[str, str]:
    """Return the variables with the destinations of catkin packages."""
    package = {
        "SHARE": f"share/{project}",
        "BIN": f"lib/{project}",
        "LIB": "lib",
        "INCLUDE": f"include/{project}",
        "PYTHON": f"{python_folder}/{project}",
        "ETC": f"etc/{project}",
    }
    everybody = {"BIN": "bin", "LIB": "lib", "INCLUDE": "include", "SHARE": "share", "PYTHON": python_folder}
    return {
        **{f"CATKIN_PACKAGE_{name}_DESTINATION": place for name, place in package.items()},
        **{f"CATKIN_GLOBAL_{name}_DESTINATION": place for name, place in everybody.items()},
    }


def _python_setup(run: Interpreter, call: Call) -> None:
    """Install the Python packages below src that the setup.py of a catkin package lists."""
    for start in sorted(run.path("src").glob("*/__init__.py")):
        for path in files_below(start.parent):
            place = f"{run.variables['PYTHON_INSTALL_DIR']}/{path.relative_to(run.path('src')).as_posix()}"
            run.contents.files.append(InstalledFile(path, place))


def _install_python(run: Interpreter, call: Call) -> None:
    INSTALLS["install"](run, call)


COMMANDS: dict[str, Handler] = {
    "find_package": _find_package,
    "catkin_python_setup": _python_setup,
    "add_message_files": _interface_files,
    "add_service_files": _interface_files,
    "add_action_files": _interface_files,
    "catkin_install_python": _install_python,
}
IGNORED = frozenset({
    "catkin_add_nosetests", "catkin_add_env_hooks", "catkin_metapackage", "catkin_package",
    "catkin_package_xml", "generate_dynamic_reconfigure_options", "generate_messages", "roslaunch_add_file_check",
    "add_rostest", "add_rostest_gtest",
})  # fmt: skip
