"""Files of packages that CMake builds (``ament_cmake`` and plain ``cmake``)."""

from __future__ import annotations

from collections.abc import Iterator

from daidalos.cli.ros2.new_package.package import Entry, NewPackage
from daidalos.common.names import camel_case


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield the files apart from the manifest."""
    name, library = package.name, package.library_name
    yield Entry("src", note="creating source and include folder")
    yield Entry(f"include/{name}")
    yield Entry("CMakeLists.txt", _cmake_lists(package))
    if package.build_type == "cmake":
        yield Entry(f"{name}Config.cmake.in", _config(package))
        yield Entry(f"{name}ConfigVersion.cmake.in", _CONFIG_VERSION)
    if package.node_name:
        yield Entry(f"src/{package.node_name}.cpp", _node(package))
    if library:
        yield Entry(f"include/{name}/{library}.hpp", _header(package))
        yield Entry(f"src/{library}.cpp", _source(package))
        yield Entry(f"include/{name}/visibility_control.h", _visibility(package))


def _cmake_lists(package: NewPackage) -> str:
    parts = [
        f"cmake_minimum_required(VERSION 3.8)\nproject({package.name})\n",
        'if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")\n'
        "  add_compile_options(-Wall -Wextra -Wpedantic)\nendif()\n",
        _find_packages(package),
    ]
    if package.library_name:
        parts.append(_library_rules(package))
    if package.node_name:
        parts.append(_node_rules(package))
    parts.append(_ending(package))
    return "\n".join(parts)


def _find_packages(package: NewPackage) -> str:
    tools = ("ament_cmake",) if package.build_type == "ament_cmake" else ()
    names = (*tools, *package.dependencies)
    lines = [f"find_package({name} REQUIRED)\n" for name in names]
    if not package.dependencies:
        lines.append("# Add a find_package() for every dependency here.\n")
    return "# find dependencies\n" + "".join(lines)


def _link(package: NewPackage, target: str, scope: str) -> str:
    if not package.dependencies:
        return ""
    if package.build_type == "ament_cmake":
        listed = "\n".join(f'  "{name}"' for name in package.dependencies)
        return f"ament_target_dependencies(\n  {target}\n{listed}\n)\n"
    return f"target_link_libraries({target} {scope} {' '.join(package.dependencies)})\n"


def _includes(target: str) -> str:
    return (
        f"target_include_directories({target} PUBLIC\n"
        "  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>\n"
        "  $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)\n"
        f"target_compile_features({target} PUBLIC c_std_99 cxx_std_17)  # Require C99 and C++17\n"
    )


def _library_rules(package: NewPackage) -> str:
    library = package.library_name
    assert library is not None
    define = f"{package.name.upper().replace('-', '_')}_BUILDING_LIBRARY"
    return (
        f"add_library({library} src/{library}.cpp)\n"
        f"add_library({package.name}::{library} ALIAS {library})\n"
        f"{_includes(library)}{_link(package, library, 'PUBLIC')}"
        "\n# The library exports its symbols while it is built and imports them where it is used.\n"
        f'target_compile_definitions({library} PRIVATE "{define}")\n\n'
        "install(\n  DIRECTORY include/\n  DESTINATION include/${PROJECT_NAME}\n)\n"
        f"install(\n  TARGETS {library}\n"
        "  EXPORT export_${PROJECT_NAME}\n"
        "  ARCHIVE DESTINATION lib\n  LIBRARY DESTINATION lib\n  RUNTIME DESTINATION bin\n)\n"
    )


def _node_rules(package: NewPackage) -> str:
    node = package.node_name
    assert node is not None
    link = f"target_link_libraries({node} {package.library_name})\n" if package.library_name else ""
    return (
        f"add_executable({node} src/{node}.cpp)\n"
        f"{_includes(node)}{link}{_link(package, node, 'PRIVATE')}\n"
        f"install(TARGETS {node}\n  DESTINATION lib/${{PROJECT_NAME}})\n"
    )


def _ending(package: NewPackage) -> str:
    if package.build_type == "cmake":
        return _CMAKE_ENDING
    testing = (
        "if(BUILD_TESTING)\n  find_package(ament_lint_auto REQUIRED)\n"
        "  # Remove these two lines when the sources have copyright notices and the package is in a git repository.\n"
        "  set(ament_cmake_copyright_FOUND TRUE)\n  set(ament_cmake_cpplint_FOUND TRUE)\n"
        "  ament_lint_auto_find_test_dependencies()\nendif()\n\n"
    )
    exports = (
        'ament_export_include_directories(\n  "include/${PROJECT_NAME}"\n)\n'
        f"ament_export_libraries(\n  {package.library_name}\n)\n"
        "ament_export_targets(\n  export_${PROJECT_NAME}\n)\n\n"
        if package.library_name
        else ""
    )
    return f"{testing}{exports}ament_package()\n"


_CMAKE_ENDING = """\
include(CMakePackageConfigHelpers)
configure_package_config_file(
  "${PROJECT_NAME}Config.cmake.in" "${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config.cmake"
  INSTALL_DESTINATION share/${PROJECT_NAME}/cmake)
configure_file("${PROJECT_NAME}ConfigVersion.cmake.in" "${PROJECT_NAME}ConfigVersion.cmake" @ONLY)
install(FILES package.xml DESTINATION share/${PROJECT_NAME})
install(
  FILES
    "${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config.cmake"
    "${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}ConfigVersion.cmake"
  DESTINATION share/${PROJECT_NAME}/cmake)
"""


def _config(package: NewPackage) -> str:
    include = f'\nset({package.name}_INCLUDE_DIRS "@PACKAGE_INCLUDE_DIR@")\n' if package.library_name else ""
    return f"@PACKAGE_INIT@\n\nset({package.name}_CONFIG_INCLUDED TRUE)\n{include}"


_CONFIG_VERSION = """\
set(PACKAGE_VERSION "0.0.0")
if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  set(PACKAGE_VERSION_EXACT TRUE)
else()
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
endif()
"""


def _node(package: NewPackage) -> str:
    include = f'#include "{package.name}/{package.library_name}.hpp"\n\n' if package.library_name else ""
    return f"""\
#include <cstdio>

{include}int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

  printf("hello world {package.name} package\\n");
  return 0;
}}
"""


def _class_name(package: NewPackage) -> str:
    return camel_case(package.library_name or "")


def _header(package: NewPackage) -> str:
    name, library = package.name.replace("-", "_"), package.library_name or ""
    guard = f"{name.upper()}__{library.upper()}_HPP_"
    kind = _class_name(package)
    return f"""\
#ifndef {guard}
#define {guard}

#include "{package.name}/visibility_control.h"

namespace {name}
{{

class {name.upper()}_PUBLIC {kind}
{{
public:
  {kind}();

  virtual ~{kind}();
}};

}}  // namespace {name}

#endif  // {guard}
"""


def _source(package: NewPackage) -> str:
    name, kind = package.name.replace("-", "_"), _class_name(package)
    return f"""\
#include "{package.name}/{package.library_name}.hpp"

namespace {name}
{{

{kind}::{kind}()
{{
}}

{kind}::~{kind}()
{{
}}

}}  // namespace {name}
"""


def _visibility(package: NewPackage) -> str:
    name = package.name.replace("-", "_").upper()
    return f"""\
#ifndef {name}__VISIBILITY_CONTROL_H_
#define {name}__VISIBILITY_CONTROL_H_

// What is marked as public can be used from outside the library.
#if defined _WIN32 || defined __CYGWIN__
  #ifdef {name}_BUILDING_LIBRARY
    #define {name}_PUBLIC __declspec(dllexport)
  #else
    #define {name}_PUBLIC __declspec(dllimport)
  #endif
#else
  #define {name}_PUBLIC __attribute__ ((visibility("default")))
#endif

#endif  // {name}__VISIBILITY_CONTROL_H_
"""
