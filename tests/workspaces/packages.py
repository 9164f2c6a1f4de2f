"""Packages as a course has them written, put into a workspace by tests."""

import textwrap
from pathlib import Path


def write(folder: Path, files: dict[str, str]) -> Path:
    """Write files below a folder; returns the folder."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(text).lstrip("\n"), encoding="utf-8")
    return folder


def python_package(
    folder: Path,
    name: str,
    modules: dict[str, str],
    data: str = "",
    needs: str = "",
    more: dict[str, str] | None = None,
) -> Path:
    """Write a package of build type ament_python with an executable for each module."""
    scripts = ", ".join(f"'{module} = {name}.{module}:main'" for module in modules)
    depends = "".join(f"<depend>{need}</depend>" for need in needs.split())
    return write(
        folder / name,
        {
            "package.xml": package_xml(name, "ament_python", f"{depends}<test_depend>python3-pytest</test_depend>"),
            "setup.py": f"""
                import os
                from glob import glob
                from setuptools import find_packages, setup

                package_name = '{name}'

                setup(
                    name=package_name,
                    version='0.0.0',
                    packages=find_packages(exclude=['test']),
                    data_files=[
                        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
                        ('share/' + package_name, ['package.xml']),
                        {data}
                    ],
                    install_requires=['setuptools'],
                    zip_safe=True,
                    maintainer='me',
                    maintainer_email='me@example.org',
                    description='A package',
                    license='Apache-2.0',
                    tests_require=['pytest'],
                    entry_points={{'console_scripts': [{scripts}]}},
                )
                """,
            "setup.cfg": f"""
                [develop]
                script_dir=$base/lib/{name}
                [install]
                install_scripts=$base/lib/{name}
                """,
            f"resource/{name}": "",
            f"{name}/__init__.py": "",
            **{f"{name}/{module}.py": text for module, text in modules.items()},
            **(more or {}),
        },
    )


def package_xml(name: str, build_type: str, depends: str) -> str:
    """Return the description of a package, with these elements for what it depends on."""
    return f"""
        <?xml version="1.0"?>
        <package format="3">
          <name>{name}</name>
          <version>0.0.0</version>
          <description>A package</description>
          <maintainer email="me@example.org">me</maintainer>
          <license>Apache-2.0</license>
          {depends}
          <export><build_type>{build_type}</build_type></export>
        </package>
        """


def cmake_package(folder: Path, name: str, body: str, files: dict[str, str], more_xml: str = "") -> Path:
    """Write a package of build type ament_cmake with these commands in its CMakeLists.txt."""
    more_xml = " ".join(more_xml.split())
    return write(
        folder / name,
        {
            "package.xml": package_xml(
                name, "ament_cmake", f"<buildtool_depend>ament_cmake</buildtool_depend>{more_xml}"
            ),
            "CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\n"
            f"project({name})\n"
            "find_package(ament_cmake REQUIRED)\n" + textwrap.dedent(body) + "\nament_package()\n",
            **files,
        },
    )


INTERFACES_XML = """
<buildtool_depend>rosidl_default_generators</buildtool_depend>
<depend>geometry_msgs</depend>
<exec_depend>rosidl_default_runtime</exec_depend>
<member_of_group>rosidl_interface_packages</member_of_group>
"""
