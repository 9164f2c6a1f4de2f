"""Manifest, ``package.xml``."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

from daidalos.cli.ros2.new_package.package import NewPackage

_TEST_DEPENDENCIES = {
    "ament_python": ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest"),
    "ament_cmake": ("ament_lint_auto", "ament_lint_common"),
    "cmake": (),
}
_BUILD_TOOLS = {"ament_python": (), "ament_cmake": ("ament_cmake",), "cmake": ("cmake",)}


def package_xml(package: NewPackage) -> str:
    """Return the text of the manifest."""
    groups = (
        [("buildtool_depend", name) for name in _BUILD_TOOLS[package.build_type]],
        [("depend", name) for name in package.dependencies],
        [("test_depend", name) for name in _TEST_DEPENDENCIES[package.build_type]],
    )
    dependencies = "".join(
        "\n" + "".join(f"  <{tag}>{escape(name)}</{tag}>\n" for tag, name in group) for group in groups if group
    )
    number = package.package_format
    return (
        '<?xml version="1.0"?>\n'
        f'<?xml-model href="http://download.ros.org/schema/package_format{number}.xsd" '
        'schematypens="http://www.w3.org/2001/XMLSchema"?>\n'
        f'<package format="{number}">\n'
        f"  <name>{package.name}</name>\n"
        "  <version>0.0.0</version>\n"
        f"  <description>{escape(package.description)}</description>\n"
        f"  <maintainer email={quoteattr(package.maintainer_email)}>{escape(package.maintainer_name)}</maintainer>\n"
        f"  <license>{escape(package.license)}</license>\n"
        f"{dependencies}\n"
        "  <export>\n"
        f"    <build_type>{package.build_type}</build_type>\n"
        "  </export>\n"
        "</package>\n"
    )
