"""Commands that define what is compiled, linked and tested."""

from __future__ import annotations

from daidalos.workspaces.cmake.contents import Target, Test
from daidalos.workspaces.cmake.interpreter import Call, Handler, Interpreter, keywords
from daidalos.workspaces.errors import WorkspaceError

_SCOPES = ("PUBLIC", "PRIVATE", "INTERFACE", "BEFORE", "AFTER", "SYSTEM")
_KINDS = ("STATIC", "SHARED", "MODULE", "OBJECT", "INTERFACE", "WIN32", "MACOSX_BUNDLE", "EXCLUDE_FROM_ALL")


def _add(run: Interpreter, call: Call) -> None:
    name, *rest = call.values
    if "ALIAS" in rest or "IMPORTED" in rest:
        return
    kind = "executable" if call.name.endswith("executable") else "library"
    target = Target(name, kind, call.where, standard=run.variables.get("CMAKE_CXX_STANDARD", ""))
    directories = run.variables.get("_INCLUDE_DIRECTORIES", "")
    target.includes += [run.path(folder) for folder in directories.split(";") if folder]
    target.options += [option for option in run.variables.get("_COMPILE_OPTIONS", "").split(";") if option]
    run.contents.targets[name] = target
    _add_sources(run, call, target, rest)
    if call.name.startswith("ament_auto"):
        target.links.append("the packages of package.xml")


def _add_sources(run: Interpreter, call: Call, target: Target, names: list[str]) -> None:
    for name in names:
        if name in _SCOPES or name in _KINDS or name.startswith("$<"):
            continue
        path = run.path(name)
        if run.is_made_by_build(path):
            target.links.append("generated code")
        elif not path.is_file():
            raise WorkspaceError(f"{call.name}({target.name}): there is no file '{name}'", call.where)
        target.sources.append(path)


def _target_sources(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    if target is not None:
        _add_sources(run, call, target, call.values[1:])


def _target_links(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    if target is not None:
        target.links += [value for value in call.values[1:] if value not in _SCOPES]


def _target_includes(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    if target is None:
        return
    for value in call.values[1:]:
        if value.startswith("$<BUILD_INTERFACE:"):
            value = value.removeprefix("$<BUILD_INTERFACE:").removesuffix(">")
        if value not in _SCOPES and not value.startswith("$<"):
            target.includes.append(run.path(value))


def _target_definitions(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    if target is not None:
        target.definitions += [value.removeprefix("-D") for value in call.values[1:] if value not in _SCOPES]


def _target_features(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    for value in call.values[1:]:
        if target is not None and value.startswith("cxx_std_"):
            target.standard = value.removeprefix("cxx_std_")


def _target_options(run: Interpreter, call: Call) -> None:
    target = _target(run, call)
    if target is not None:
        target.options += [value for value in call.values[1:] if value not in _SCOPES and not value.startswith("$<")]


def _target_properties(run: Interpreter, call: Call) -> None:
    names, _, properties = _partition(call.values, "PROPERTIES")
    pairs = dict(zip(properties[::2], properties[1::2], strict=False))
    for name in names:
        target = run.contents.targets.get(name)
        if target is not None:
            target.output_name = pairs.get("OUTPUT_NAME", target.output_name)
            target.standard = pairs.get("CXX_STANDARD", target.standard)


def _partition(values: list[str], word: str) -> tuple[list[str], str, list[str]]:
    at = values.index(word) if word in values else len(values)
    return values[:at], word, values[at + 1 :]


def _target(run: Interpreter, call: Call) -> Target | None:
    return run.contents.targets.get(call.values[0])


def _include_directories(run: Interpreter, call: Call) -> None:
    _extend(run, "_INCLUDE_DIRECTORIES", [value for value in call.values if value not in _SCOPES])


def _add_compile_definitions(run: Interpreter, call: Call) -> None:
    _extend(run, "_COMPILE_OPTIONS", [f"-D{value.removeprefix('-D')}" for value in call.values if "$<" not in value])


def _add_compile_options(run: Interpreter, call: Call) -> None:
    _extend(run, "_COMPILE_OPTIONS", [value for value in call.values if not value.startswith("$<")])


def _extend(run: Interpreter, variable: str, values: list[str]) -> None:
    before = run.variables.get(variable, "")
    run.variables[variable] = ";".join([*([before] if before else []), *values])


def _register_component(run: Interpreter, call: Call) -> None:
    """Record the executable of rclcpp_components_register_node; its library is skipped like any other."""
    executable = keywords(call.values, (), ("EXECUTABLE", "PLUGIN", "EXECUTOR", "RESOURCE_INDEX"))[0].get("EXECUTABLE")
    if executable:
        target = Target(executable[0], "executable", call.where, links=["rclcpp_components"])
        target.destination = f"lib/{run.contents.project}"
        run.contents.targets[target.name] = target


def _pytest(run: Interpreter, call: Call) -> None:
    found, others = keywords(
        call.values,
        ("SKIP_TEST",),
        ("PYTHON_EXECUTABLE", "RUNNER", "TIMEOUT", "WORKING_DIRECTORY", "WERROR"),
        ("APPEND_ENV", "APPEND_LIBRARY_DIRS", "ENV"),
    )
    if "SKIP_TEST" not in found:
        _add_test(run, call, others[0], "pytest", others[1], found)


def _launch_test(run: Interpreter, call: Call) -> None:
    found, others = keywords(
        call.values,
        ("SKIP_TEST",),
        ("TARGET", "PYTHON_EXECUTABLE", "RUNNER", "TIMEOUT", "WORKING_DIRECTORY"),
        ("ARGS", "APPEND_ENV", "APPEND_LIBRARY_DIRS", "ENV", "LABELS"),
    )
    if "SKIP_TEST" in found:
        return
    path = others[0]
    if not run.path(path).is_file():
        path = f"test/{path}"
    name = found.get("TARGET", [others[0].replace("/", "_").removesuffix(".py")])[0]
    _add_test(run, call, name, "launch", path, found)


def _add_test(run: Interpreter, call: Call, name: str, kind: str, path: str, found: dict[str, list[str]]) -> None:
    where = run.path(path)
    if not where.exists():
        raise WorkspaceError(f"{call.name}(): there is no file '{path}'", call.where)
    try:
        timeout = float(found.get("TIMEOUT", ["60"])[0])
    except ValueError:
        raise WorkspaceError(f"{call.name}(): TIMEOUT needs a number of seconds", call.where) from None
    pairs = [item.partition("=") for item in found.get("ENV", [])]
    environment = tuple((key, value) for key, _, value in pairs)
    folder = str(run.path(found["WORKING_DIRECTORY"][0])) if "WORKING_DIRECTORY" in found else ""
    run.contents.tests.append(Test(name, kind, where, tuple(found.get("ARGS", [])), timeout, environment, folder))


def _compiled_test(run: Interpreter, call: Call) -> None:
    run.contents.left_out_tests.append(call.values[0])


COMMANDS: dict[str, Handler] = {
    "add_executable": _add,
    "add_library": _add,
    "ament_auto_add_executable": _add,
    "ament_auto_add_library": _add,
    "target_sources": _target_sources,
    "target_link_libraries": _target_links,
    "ament_target_dependencies": _target_links,
    "target_include_directories": _target_includes,
    "target_compile_definitions": _target_definitions,
    "target_compile_features": _target_features,
    "target_compile_options": _target_options,
    "set_target_properties": _target_properties,
    "include_directories": _include_directories,
    "add_compile_options": _add_compile_options,
    "add_compile_definitions": _add_compile_definitions,
    "rclcpp_components_register_node": _register_component,
    "ament_add_pytest_test": _pytest,
    "add_launch_test": _launch_test,
    "ament_add_ros_isolated_gtest": _compiled_test,
    "ament_add_gtest": _compiled_test,
    "ament_add_gmock": _compiled_test,
    "add_test": _compiled_test,
    "ament_add_test": _compiled_test,
    "catkin_add_gtest": _compiled_test,
}
IGNORED = frozenset({
    "pluginlib_enable_plugin_testing", "qt5_wrap_cpp", "qt5_wrap_ui", "qt6_wrap_cpp", "qt6_wrap_ui",
    "qt_standard_project_setup", "qt_wrap_cpp", "rclcpp_components_register_nodes",
    "rclcpp_components_register_plugin",
})  # fmt: skip
