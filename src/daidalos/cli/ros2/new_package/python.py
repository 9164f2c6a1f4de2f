"""Files of packages in Python (``ament_python``)."""

from __future__ import annotations

from collections.abc import Iterator

from daidalos.cli.ros2.new_package.package import Entry, NewPackage


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield the files apart from the manifest."""
    name = package.name
    yield Entry(name, note="creating source folder")
    yield Entry("setup.py", _setup_py(package))
    yield Entry("setup.cfg", f"[develop]\nscript_dir=$base/lib/{name}\n[install]\ninstall_scripts=$base/lib/{name}\n")
    yield Entry("resource")
    yield Entry(f"resource/{name}", "")
    yield Entry(f"{name}/__init__.py", "")
    yield Entry("test")
    for tool in ("copyright", "flake8", "pep257"):
        yield Entry(f"test/test_{tool}.py", _linter_test(tool))
    if package.library_name:
        yield Entry(f"{name}/{package.library_name}")
        yield Entry(f"{name}/{package.library_name}/__init__.py", "")
    if package.node_name:
        yield Entry(f"{name}/{package.node_name}.py", _node(package))


def _setup_py(package: NewPackage) -> str:
    script = (
        f"\n            '{package.node_name} = {package.name}.{package.node_name}:main',\n        "
        if package.node_name
        else ""
    )
    return f"""\
from setuptools import find_packages, setup

package_name = '{package.name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={package.maintainer_name!r},
    maintainer_email={package.maintainer_email!r},
    description={package.description!r},
    license={package.license!r},
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [{script}],
    }},
)
"""


def _node(package: NewPackage) -> str:
    return f"""\
def main():
    print('Hi from {package.name}.')


if __name__ == '__main__':
    main()
"""


_LINTER_CALLS = {
    "copyright": "    assert linter.main(argv=['.', 'test']) == 0, 'found files without a copyright notice'\n",
    "flake8": (
        "    status, errors = linter.main_with_errors(argv=[])\n"
        "    assert status == 0, f'found {len(errors)} code style errors:\\n' + '\\n'.join(errors)\n"
    ),
    "pep257": "    assert linter.main(argv=['.', 'test']) == 0, 'found code style errors in docstrings'\n",
}


def _linter_test(tool: str) -> str:
    skip = (
        "@pytest.mark.skip(reason='No copyright header has been placed in the generated source file.')\n"
        if tool == "copyright"
        else ""
    )
    return f"""\
import pytest

linter = pytest.importorskip('ament_{tool}.main')


{skip}@pytest.mark.{tool}
@pytest.mark.linter
def test_{tool}():
{_LINTER_CALLS[tool]}"""
