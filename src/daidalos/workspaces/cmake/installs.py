"""install() and the commands of ament, rosidl and catkin that install or register files."""

from __future__ import annotations

import fnmatch
import os
import re
from collections.abc import Iterator
from configparser import ConfigParser
from configparser import Error as ConfigError
from pathlib import Path

from daidalos.workspaces.cmake.basics import configured
from daidalos.workspaces.cmake.contents import InstalledFile, Interfaces, PythonPackage, Resource
from daidalos.workspaces.cmake.interpreter import Call, Handler, Interpreter, keywords
from daidalos.workspaces.errors import WorkspaceError

_OPTIONS = ("OPTIONAL", "EXCLUDE_FROM_ALL", "FILES_MATCHING", "USE_SOURCE_PERMISSIONS", "MESSAGE_NEVER")
_SINGLE = ("DESTINATION", "COMPONENT", "RENAME", "TYPE", "FILE_SET", "EXPORT", "NAMESPACE")
_MANY = ("PERMISSIONS", "FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS", "CONFIGURATIONS")
_BY_TYPE = {"BIN": "bin", "LIB": "lib", "INCLUDE": "include", "DATA": "share", "DOC": "share/doc", "MAN": "share/man"}
_ARTIFACTS = ("RUNTIME", "LIBRARY", "ARCHIVE", "OBJECTS", "PUBLIC_HEADER", "PRIVATE_HEADER", "RESOURCE", "BUNDLE")


def _install(run: Interpreter, call: Call) -> None:
    kind, *values = call.values
    if kind == "DIRECTORY":
        _install_directories(run, call, values)
    elif kind in ("FILES", "PROGRAMS"):
        _install_files(run, call, values, kind == "PROGRAMS")
    elif kind == "TARGETS":
        _install_targets(run, values)
    elif kind in ("SCRIPT", "CODE"):
        run.contents.notes.append(f"{call.where}: install({kind}) is left out: a build here runs no programs")


def _install_files(run: Interpreter, call: Call, values: list[str], executable: bool) -> None:
    found, files = keywords(values, _OPTIONS, _SINGLE, _MANY)
    destination = _destination(found, run, call)
    executable = executable or any("EXECUTE" in item for item in found.get("PERMISSIONS", []))
    for name in files:
        source = run.path(name)
        if not source.is_file():
            if "OPTIONAL" in found or run.is_made_by_build(source):
                continue
            raise WorkspaceError(f"install(): there is no file '{name}'", call.where)
        target = found.get("RENAME", [source.name])[0]
        run.contents.files.append(
            InstalledFile(source, _joined(destination, target), executable or os.access(source, os.X_OK))
        )


def _install_directories(run: Interpreter, call: Call, values: list[str]) -> None:
    patterns = next((at for at, value in enumerate(values) if value in ("PATTERN", "REGEX")), len(values))
    found, folders = keywords(values[:patterns], _OPTIONS, _SINGLE, _MANY)
    destination = _destination(found, run, call)
    chooses = _FileFilter(values[patterns:], "FILES_MATCHING" in found)
    for name in folders:
        folder = run.path(name)
        if not folder.is_dir():
            if "OPTIONAL" in found or run.is_made_by_build(folder):
                continue
            raise WorkspaceError(f"install(): there is no folder '{name}'", call.where)
        # Without a slash at its end the folder itself is installed, with one what it holds.
        base = destination if name.endswith("/") else _joined(destination, folder.resolve().name)
        for path in files_below(folder):
            if chooses(path, folder):
                target = _joined(base, path.relative_to(folder).as_posix())
                run.contents.files.append(InstalledFile(path, target, os.access(path, os.X_OK)))


def files_below(folder: Path) -> Iterator[Path]:
    """Yield the files of a folder and its subfolders, without files of tools."""
    for root, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if name not in ("__pycache__", ".git", ".svn"))
        for name in sorted(files):
            yield Path(root) / name


class _FileFilter:
    """Filter of a folder's installed files by PATTERN and REGEX with EXCLUDE."""

    def __init__(self, values: list[str], only_matching: bool) -> None:
        self._only_matching = only_matching
        self._rules: list[tuple[str, str, bool]] = []
        for at, value in enumerate(values):
            if value in ("PATTERN", "REGEX"):
                self._rules.append((value, values[at + 1], values[at + 2 : at + 3] == ["EXCLUDE"]))

    def __call__(self, path: Path, folder: Path) -> bool:
        parts = [folder.joinpath(*path.relative_to(folder).parts[: n + 1]) for n in range(len(path.parts))]
        if any(self._matches(rule, part) for rule in self._rules if rule[2] for part in parts):
            return False
        return not self._only_matching or any(self._matches(rule, path) for rule in self._rules if not rule[2])

    def _matches(self, rule: tuple[str, str, bool], path: Path) -> bool:
        kind, pattern, _ = rule
        if kind == "REGEX":
            return re.search(pattern, path.as_posix()) is not None
        return fnmatch.fnmatch(path.name, pattern) or fnmatch.fnmatch(path.as_posix(), f"*/{pattern}")


def _install_targets(run: Interpreter, values: list[str]) -> None:
    start = next((at for at, value in enumerate(values) if value in (*_ARTIFACTS, *_SINGLE, "INCLUDES")), len(values))
    artifact = ""
    destinations: dict[str, str] = {}
    for at in range(start, len(values)):
        if values[at] in _ARTIFACTS or values[at] == "INCLUDES":
            artifact = values[at]
        elif values[at] == "DESTINATION":
            destinations[artifact] = values[at + 1]
    for name in values[:start]:
        target = run.contents.targets.get(name)
        if target is not None:
            artifact = "RUNTIME" if target.kind == "executable" else "LIBRARY"
            fallback = "bin" if target.kind == "executable" else "lib"
            target.destination = destinations.get(artifact, destinations.get("", fallback))


def _destination(found: dict[str, list[str]], run: Interpreter, call: Call) -> str:
    if "TYPE" in found:
        return _BY_TYPE.get(found["TYPE"][0], "share")
    if not found.get("DESTINATION"):
        raise WorkspaceError("install() needs a DESTINATION", call.where)
    return relative(found["DESTINATION"][0], run, call)


def relative(destination: str, run: Interpreter, call: Call) -> str:
    """Return a destination relative to the prefix.

    Raises
    ------
    WorkspaceError
        When it lies outside of it.
    """
    prefix = run.variables["CMAKE_INSTALL_PREFIX"]
    clean = os.path.normpath(os.path.join(prefix, destination))
    inside = os.path.relpath(clean, prefix)
    if inside.startswith(".."):
        raise WorkspaceError(f"'{destination}' is outside of the folder to install to", call.where)
    return inside.replace(os.sep, "/")


def _joined(folder: str, name: str) -> str:
    return os.path.normpath(f"{folder}/{name}").replace(os.sep, "/")


def _python_package(run: Interpreter, call: Call) -> None:
    found, names = keywords(
        call.values, ("SKIP_COMPILE",), ("PACKAGE_DIR", "VERSION", "SETUP_CFG", "DESTINATION", "SCRIPTS_DESTINATION")
    )
    name = names[0]
    folder = run.path(found.get("PACKAGE_DIR", [name])[0])
    if not (folder / "__init__.py").is_file():
        raise WorkspaceError(f"{call.name}(): there is no file '{folder / '__init__.py'}'", call.where)
    target = relative(found.get("DESTINATION", [run.variables["PYTHON_INSTALL_DIR"]])[0], run, call)
    for path in files_below(folder):
        if path.suffix != ".pyc":
            place = _joined(f"{target}/{name}", path.relative_to(folder).as_posix())
            run.contents.files.append(InstalledFile(path, place))
    scripts = found.get("SCRIPTS_DESTINATION", [f"lib/{run.contents.project}"])[0]
    settings = run.path(found.get("SETUP_CFG", ["setup.cfg"])[0])
    run.contents.python_packages.append(PythonPackage(name, relative(scripts, run, call), _console_scripts(settings)))


def _console_scripts(settings: Path) -> tuple[tuple[str, str], ...]:
    """Return the executables that a setup.cfg declares: name and ``module:function``."""
    if not settings.is_file():
        return ()
    parser = ConfigParser()
    try:
        parser.read_string(settings.read_text(encoding="utf-8"), str(settings))
    except ConfigError as error:
        raise WorkspaceError(str(error).replace("\n", " ")) from None
    lines = parser.get("options.entry_points", "console_scripts", fallback="").splitlines()
    pairs = [line.partition("=") for line in lines if "=" in line]
    return tuple((name.strip(), function.strip()) for name, _, function in pairs)


def _python_module(run: Interpreter, call: Call) -> None:
    found, names = keywords(call.values, ("SKIP_COMPILE",), ("DESTINATION",))
    destination = relative(found.get("DESTINATION", [run.variables["PYTHON_INSTALL_DIR"]])[0], run, call)
    _install_files(run, call, [names[0], "DESTINATION", destination], False)


def _generate_interfaces(run: Interpreter, call: Call) -> None:
    options = ("ADD_LINTER_TESTS", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK")
    files = keywords(call.values, options, ("LIBRARY_NAME",), ("DEPENDENCIES",))[1][1:]
    if not files:
        raise WorkspaceError(f"{call.name}() names no .msg, .srv, .action or .idl files", call.where)
    paths = []
    for name in files:
        base, _, rest = name.rpartition(":")
        path = Path(base, rest) if base and not Path(name).is_absolute() else run.path(name)
        if not path.is_file():
            raise WorkspaceError(f"{call.name}(): there is no file '{name}'", call.where)
        if path.suffix not in (".msg", ".srv", ".action", ".idl"):
            raise WorkspaceError(f"{call.name}(): '{name}' is not an .msg, .srv, .action or .idl file", call.where)
        paths.append(path)
    before = run.contents.interfaces.files if run.contents.interfaces else []
    run.contents.interfaces = Interfaces(before + paths, call.where)


def _plugin_description(run: Interpreter, call: Call) -> None:
    base, name = call.values[:2]
    project = run.contents.project
    _install_files(run, call, [name, "DESTINATION", f"share/{project}"], False)
    content = f"share/{project}/{Path(name).name}\n"
    run.contents.resources.append(Resource(f"{base}__pluginlib__plugin", project, content))


def _register_resource(run: Interpreter, call: Call) -> None:
    found, others = keywords(call.values, (), ("CONTENT", "CONTENT_FILE", "PACKAGE_NAME"), ("AMENT_INDEX_BINARY_DIR",))
    content = "".join(found.get("CONTENT", []))
    if "CONTENT_FILE" in found:
        path = run.path(found["CONTENT_FILE"][0])
        if not path.is_file():
            raise WorkspaceError(f"{call.name}(): there is no file '{path}'", call.where)
        content = path.read_text(encoding="utf-8")
    name = found.get("PACKAGE_NAME", [run.contents.project])[0]
    run.contents.resources.append(Resource(others[0], name, content))


def _environment_hooks(run: Interpreter, call: Call) -> None:
    build = Path(run.variables["CMAKE_BINARY_DIR"]) / "environment"
    # One of ament's own hooks is named by a variable that nothing sets here, as the build writes those hooks itself.
    for name in filter(None, call.values):
        source = run.path(name)
        if not source.is_file():
            raise WorkspaceError(f"{call.name}(): there is no file '{name}'", call.where)
        if source.suffix == ".in":
            build.mkdir(parents=True, exist_ok=True)
            filled = build / source.stem
            filled.write_text(configured(source, run.variables, only_at=True), encoding="utf-8")
            source = filled
        target = f"share/{run.contents.project}/environment/{source.name}"
        run.contents.files.append(InstalledFile(source, target))
        run.contents.hooks.append(target)


def _auto_package(run: Interpreter, call: Call) -> None:
    found, _ = keywords(call.values, ("NO_INSTALL_TO_SHARE",), (), ("INSTALL_TO_SHARE", "INSTALL_TO_PATH"))
    project = run.contents.project
    for keyword, destination in (("INSTALL_TO_SHARE", f"share/{project}"), ("INSTALL_TO_PATH", "bin")):
        names = found.get(keyword, [])
        if names:
            _install_directories(run, call, [*names, "DESTINATION", destination])
    for target in run.contents.targets.values():
        if target.destination is None:
            target.destination = f"lib/{project}" if target.kind == "executable" else "lib"


COMMANDS: dict[str, Handler] = {
    "install": _install,
    "ament_python_install_package": _python_package,
    "ament_python_install_module": _python_module,
    "rosidl_generate_interfaces": _generate_interfaces,
    "pluginlib_export_plugin_description_file": _plugin_description,
    "ament_index_register_resource": _register_resource,
    "ament_environment_hooks": _environment_hooks,
    "ament_auto_package": _auto_package,
}
IGNORED = frozenset({
    "ament_auto_find_build_dependencies", "ament_auto_find_test_dependencies",
    "ament_cmake_environment_generate_package_run_dependencies_marker", "ament_copyright", "ament_cppcheck",
    "ament_cpplint", "ament_export_definitions", "ament_export_dependencies", "ament_export_include_directories",
    "ament_export_interfaces", "ament_export_libraries", "ament_export_link_flags", "ament_export_targets",
    "ament_find_gmock", "ament_find_gtest", "ament_flake8", "ament_get_recursive_properties",
    "ament_index_get_resource", "ament_index_has_resource", "ament_index_register_package",
    "ament_lint_auto_exclude", "ament_lint_auto_find_test_dependencies", "ament_lint_cmake", "ament_package",
    "ament_package_xml", "ament_pep257", "ament_uncrustify", "ament_xmllint", "configure_package_config_file",
    "generate_export_header", "include_directories_system", "rosidl_get_typesupport_target",
    "rosidl_target_interfaces", "rosidl_write_generator_arguments", "write_basic_package_version_file",
})  # fmt: skip
