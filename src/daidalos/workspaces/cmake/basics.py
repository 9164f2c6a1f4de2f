"""CMake commands for variables, lists, strings and files."""

from __future__ import annotations

import functools
import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from daidalos.workspaces.cmake.interpreter import Call, Handler, Interpreter, keywords
from daidalos.workspaces.cmake.values import split, substitute
from daidalos.workspaces.errors import WorkspaceError

_LETTER_CASES: dict[str, Callable[[str], str]] = {"TOLOWER": str.lower, "TOUPPER": str.upper, "STRIP": str.strip}


def _project(run: Interpreter, call: Call) -> None:
    name = call.values[0]
    version = keywords(call.values[1:], single=("VERSION",))[0].get("VERSION", [""])
    run.contents.project = run.contents.project or name
    for variable in ("PROJECT_NAME", "CMAKE_PROJECT_NAME"):
        run.variables[variable] = name
    run.variables["PROJECT_VERSION"] = run.variables[f"{name}_VERSION"] = "".join(version)
    for where in ("PROJECT_", f"{name}_"):
        run.variables[f"{where}SOURCE_DIR"] = str(run.folder)
        run.variables[f"{where}BINARY_DIR"] = run.variables["CMAKE_BINARY_DIR"]


def _set(run: Interpreter, call: Call) -> None:
    name, *values = call.values
    if "CACHE" in values:
        at = values.index("CACHE")
        if name in run.variables and "FORCE" not in values[at:]:
            return
        values = values[:at]
    if values[-1:] == ["PARENT_SCOPE"]:
        _assign(run.parent_variables, name, values[:-1])
        return
    _assign(run.variables, name, values)


def _assign(variables: dict[str, str], name: str, values: list[str]) -> None:
    environment = re.fullmatch(r"ENV\{(.*)\}", name)
    if environment:
        return
    if values:
        variables[name] = ";".join(values)
    else:
        variables.pop(name, None)


def _unset(run: Interpreter, call: Call) -> None:
    run.variables.pop(call.values[0], None)


def _option(run: Interpreter, call: Call) -> None:
    run.variables.setdefault(call.values[0], call.values[2] if len(call.values) > 2 else "OFF")


def _list(run: Interpreter, call: Call) -> None:
    action, name, *values = call.values
    items = split(run.variables.get(name, ""))
    if action in ("LENGTH", "GET", "FIND", "JOIN", "SUBLIST"):
        *arguments, result = values
        run.variables[result] = _read_list(action, items, arguments)
        return
    run.variables[name] = ";".join(_changed_list(action, items, values, call))


def _read_list(action: str, items: list[str], arguments: list[str]) -> str:
    if action == "LENGTH":
        return str(len(items))
    if action == "GET":
        return ";".join(items[int(index)] for index in arguments)
    if action == "FIND":
        return str(items.index(arguments[0]) if arguments[0] in items else -1)
    if action == "JOIN":
        return arguments[0].join(items)
    start, length = int(arguments[0]), int(arguments[1])
    return ";".join(items[start:] if length < 0 else items[start : start + length])


def _changed_list(action: str, items: list[str], values: list[str], call: Call) -> list[str]:
    if action == "APPEND":
        return items + values
    if action == "PREPEND":
        return values + items
    if action == "INSERT":
        at = int(values[0])
        return items[:at] + values[1:] + items[at:]
    if action == "REMOVE_ITEM":
        return [item for item in items if item not in values]
    if action == "REMOVE_AT":
        gone = {int(value) % len(items) for value in values}
        return [item for index, item in enumerate(items) if index not in gone]
    if action == "REMOVE_DUPLICATES":
        return list(dict.fromkeys(items))
    if action == "REVERSE":
        return items[::-1]
    if action == "SORT":
        return sorted(items)
    if action == "FILTER":
        keep = values[0] == "INCLUDE"
        return [item for item in items if bool(re.search(values[2], item)) == keep]
    if action == "TRANSFORM":
        return [_transformed(item, values) for item in items]
    raise WorkspaceError(f"list({action}) is not known", call.where)


def _transformed(item: str, values: list[str]) -> str:
    kind = values[0]
    if kind == "PREPEND":
        return values[1] + item
    if kind == "APPEND":
        return item + values[1]
    if kind == "REPLACE":
        return re.sub(values[1], _groups(values[2]), item)
    return _LETTER_CASES.get(kind, str)(item)


def _string(run: Interpreter, call: Call) -> None:
    action, *values = call.values
    if action in _LETTER_CASES:
        run.variables[values[1]] = _LETTER_CASES[action](values[0])
    elif action == "REPLACE":
        run.variables[values[2]] = "".join(values[3:]).replace(values[0], values[1])
    elif action == "REGEX" and values[0] == "REPLACE":
        run.variables[values[3]] = re.sub(values[1], _groups(values[2]), "".join(values[4:]))
    elif action == "REGEX":
        found = [match.group() for match in re.finditer(values[1], "".join(values[3:]))]
        run.variables[values[2]] = ";".join(found if values[0] == "MATCHALL" else found[:1])
    elif action in ("APPEND", "PREPEND"):
        before, added = run.variables.get(values[0], ""), "".join(values[1:])
        run.variables[values[0]] = before + added if action == "APPEND" else added + before
    elif action in ("CONCAT", "JOIN"):
        glue = "" if action == "CONCAT" else values.pop(0)
        run.variables[values[0]] = glue.join(values[1:])
    elif action == "LENGTH":
        run.variables[values[1]] = str(len(values[0]))
    elif action == "FIND":
        run.variables[values[2]] = str(values[0].find(values[1]))
    else:
        run.contents.notes.append(f"{call.where}: string({action}) is not understood and was left out")


def _groups(replacement: str) -> str:
    return re.sub(r"\\(\d)", r"\\g<\1>", replacement)


def _file(run: Interpreter, call: Call) -> None:
    action, *values = call.values
    if action in ("GLOB", "GLOB_RECURSE"):
        found, others = keywords(values, ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"), ("RELATIVE", "LIST_DIRECTORIES"))
        base = found.get("RELATIVE")
        paths = sorted({path for pattern in others[1:] for path in _glob(run, pattern, action == "GLOB_RECURSE")})
        run.variables[others[0]] = ";".join(os.path.relpath(path, base[0]) if base else str(path) for path in paths)
    elif action == "READ":
        path = run.path(values[0])
        if not path.is_file():
            raise WorkspaceError(f"file(READ) cannot open '{values[0]}'", call.where)
        run.variables[values[1]] = path.read_text(encoding="utf-8", errors="replace")
    elif action == "RELATIVE_PATH":
        run.variables[values[0]] = os.path.relpath(values[2], values[1])
    elif action in ("TO_CMAKE_PATH", "TO_NATIVE_PATH"):
        run.variables[values[1]] = values[0]
    elif action in ("WRITE", "APPEND", "CONFIGURE", "GENERATE", "COPY", "DOWNLOAD"):
        run.contents.notes.append(f"{call.where}: file({action}) is left out")


def _glob(run: Interpreter, pattern: str, recursive: bool) -> list[Path]:
    path = run.path(pattern)
    folder, name = (path.parent, path.name) if not recursive else (path.parent, f"**/{path.name}")
    fixed = Path(folder.anchor)
    return [found for found in fixed.glob(str((folder / name).relative_to(fixed))) if found.exists()]


def _get_filename_component(run: Interpreter, call: Call) -> None:
    result, value, kind = call.values[:3]
    path = Path(value)
    base = keywords(call.values[3:], single=("BASE_DIR",))[0].get("BASE_DIR", [str(run.folder)])[0]
    first, dot, rest = path.name.partition(".")
    run.variables[result] = {
        "DIRECTORY": lambda: str(path.parent) if path.parent != Path() else "",
        "PATH": lambda: str(path.parent) if path.parent != Path() else "",
        "NAME": lambda: path.name,
        "NAME_WE": lambda: first,
        "NAME_WLE": lambda: path.stem,
        "EXT": lambda: dot + rest,
        "LAST_EXT": lambda: path.suffix,
        "ABSOLUTE": lambda: os.path.normpath(os.path.join(base, value)),
        "REALPATH": lambda: os.path.realpath(os.path.join(base, value)),
    }.get(kind, lambda: value)()


def _message(run: Interpreter, call: Call) -> None:
    kinds = ("FATAL_ERROR", "SEND_ERROR", "WARNING", "AUTHOR_WARNING", "DEPRECATION", "NOTICE", "STATUS", "VERBOSE")
    kind = call.values[0] if call.values and call.values[0] in (*kinds, "DEBUG", "TRACE") else ""
    text = "".join(call.values[1:] if kind else call.values)
    if kind in ("FATAL_ERROR", "SEND_ERROR"):
        raise WorkspaceError(text, call.where)
    if kind in ("WARNING", "NOTICE", ""):
        run.contents.notes.append(f"{call.where}: {text}")


def _include(run: Interpreter, call: Call) -> None:
    name = call.values[0]
    path = Path(run.variables.get("CMAKE_CURRENT_LIST_DIR", "")) / name
    if not path.is_file():
        path = run.path(name)
    if path.is_file():
        run.run_file(path)
    elif path.suffix and "OPTIONAL" not in call.values:
        raise WorkspaceError(f"include() finds no file '{name}'", call.where)


def _add_subdirectory(run: Interpreter, call: Call) -> None:
    folder = run.path(call.values[0])
    if not (folder / "CMakeLists.txt").is_file():
        raise WorkspaceError(f"add_subdirectory(): there is no '{call.values[0]}/CMakeLists.txt'", call.where)
    run.run_folder(folder)


def _configure_file(run: Interpreter, call: Call) -> None:
    source = run.path(call.values[0])
    target = Path(run.variables["CMAKE_CURRENT_BINARY_DIR"]) / call.values[1]
    if not source.is_file():
        raise WorkspaceError(f"configure_file(): there is no '{call.values[0]}'", call.where)
    target = target / source.name if target.is_dir() else target
    target.parent.mkdir(parents=True, exist_ok=True)
    if "COPYONLY" in call.values:
        shutil.copyfile(source, target)
        return
    target.write_text(configured(source, run.variables, "@ONLY" in call.values), encoding="utf-8")


def configured(path: Path, variables: dict[str, str], only_at: bool = False) -> str:
    """Return the text of a template with ``@NAME@`` (and ``${NAME}``) filled in."""
    text = re.sub(r"@(\w+)@", lambda match: variables.get(match[1], ""), path.read_text(encoding="utf-8"))
    return text if only_at else substitute(text, variables)


def _cmake_parse_arguments(run: Interpreter, call: Call) -> None:
    values = call.values
    if values[0] == "PARSE_ARGV":
        start = int(values[1])
        values = [*values[2:], *split(run.variables.get("ARGV", ""))[start:]]
    prefix, options, single, many = values[0], split(values[1]), split(values[2]), split(values[3])
    found, others = keywords(values[4:], options, single, many)
    for name in options:
        run.variables[f"{prefix}_{name}"] = "TRUE" if name in found else "FALSE"
    for name in (*single, *many):
        _assign(run.variables, f"{prefix}_{name}", found.get(name, []))
    _assign(run.variables, f"{prefix}_UNPARSED_ARGUMENTS", others)


def _find_package(run: Interpreter, call: Call) -> None:
    for name in (call.values[0], call.values[0].upper()):
        run.variables[f"{name}_FOUND"] = "1"
        for suffix in ("LIBRARIES", "LIBS", "TARGETS"):  # a target that links one of them needs the package
            run.variables.setdefault(f"{name}_{suffix}", call.values[0])


def _find_file(run: Interpreter, call: Call) -> None:
    run.variables.setdefault(call.values[0], f"{call.values[0]}-NOTFOUND")


def _find_program(run: Interpreter, call: Call) -> None:
    result, *names = call.values
    found = next(filter(None, map(shutil.which, names)), None)
    run.variables.setdefault(result, found or f"{result}-NOTFOUND")


def _left_out(what: str, run: Interpreter, call: Call) -> None:
    run.contents.notes.append(f"{call.where}: {call.name}() is left out: {what}")


COMMANDS: dict[str, Handler] = {
    "project": _project,
    "set": _set,
    "unset": _unset,
    "option": _option,
    "list": _list,
    "string": _string,
    "file": _file,
    "get_filename_component": _get_filename_component,
    "message": _message,
    "include": _include,
    "add_subdirectory": _add_subdirectory,
    "configure_file": _configure_file,
    "cmake_parse_arguments": _cmake_parse_arguments,
    "find_package": _find_package,
    "find_file": _find_file,
    "find_path": _find_file,
    "find_library": _find_file,
    "find_program": _find_program,
    "execute_process": functools.partial(_left_out, "a build here runs no programs"),
    "add_custom_command": functools.partial(_left_out, "a build here runs no programs"),
    "add_custom_target": functools.partial(_left_out, "a build here runs no programs"),
}
IGNORED = frozenset({
    "add_definitions", "add_dependencies", "add_link_options", "check_cxx_compiler_flag", "cmake_language",
    "cmake_minimum_required", "cmake_path", "cmake_policy", "cmake_print_variables", "enable_language",
    "enable_testing", "export", "find_dependency", "get_directory_property", "get_property", "get_target_property",
    "include_external_msproject", "include_guard", "link_directories", "link_libraries", "mark_as_advanced", "math",
    "pkg_check_modules", "separate_arguments", "set_directory_properties", "set_property",
    "set_source_files_properties", "set_tests_properties", "site_name", "source_group", "target_link_directories",
    "target_link_options", "target_precompile_headers", "variable_watch",
})  # fmt: skip
