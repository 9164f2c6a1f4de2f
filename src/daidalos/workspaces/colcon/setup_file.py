"""Build task of packages of build type ament_python, whose setup.py may fail."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from colcon_core.event.output import StderrLine
from colcon_core.package_augmentation import PackageAugmentationExtensionPoint
from colcon_core.plugin_system import satisfies_version
from colcon_ros.package_augmentation.ros_ament_python import RosAmentPythonPackageAugmentation
from colcon_ros.task.ament_python.build import AmentPythonBuildTask

from daidalos.common.errors import Location
from daidalos.workspaces.colcon.identification import PYTHON_TYPE
from daidalos.workspaces.errors import WorkspaceError

_QUERY = """
import ast
import re
import setuptools
import sys

def literals(holder):
    found = {}
    for name, value in vars(holder).items():
        try:
            ast.literal_eval(repr(value))
        except (SyntaxError, ValueError):
            continue
        found[name] = value
    return found

def check(scripts):
    for text in scripts or []:
        if not re.fullmatch(r"\\s*[^=\\s]+\\s*=\\s*[\\w.]+:[\\w.]+\\s*", text):
            raise ValueError(f"console_scripts: {text!r} is not 'name = package.module:function'")

def setup(**attributes):
    points = attributes.get("entry_points") or {}
    check(points.get("console_scripts") if isinstance(points, dict) else None)
    distribution = setuptools.Distribution(attributes)
    distribution.parse_config_files()
    distribution.finalize_options()
    print("\\0" + repr({**literals(distribution), "metadata": literals(distribution.metadata)}))

setuptools.setup = sys.modules["distutils.core"].setup = setup
sys.argv = ["setup.py", "--dry-run"]
with open("setup.py", "rb") as file:
    exec(compile(file.read(), "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
"""


class PythonPackageBuildTask(AmentPythonBuildTask):  # type: ignore[misc]
    """Build task of a package of build type ament_python, which tells a mistake in setup.py in one line."""

    async def build(self) -> int:
        """Build and install the package; returns the exit status."""
        try:
            return int(await super().build() or 0)
        except WorkspaceError as error:
            self.context.put_event_into_queue(StderrLine(f"{error}\n".encode()))
            return 1


class SetupFileAugmentation(PackageAugmentationExtensionPoint):  # type: ignore[misc]
    """Options of the setup.py of packages of build type ament_python."""

    PRIORITY = RosAmentPythonPackageAugmentation.PRIORITY

    def __init__(self) -> None:
        super().__init__()
        satisfies_version(PackageAugmentationExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")

    def augment_package(self, desc: Any, *, additional_argument_names: Any = None) -> None:
        """Register how a package's options are found."""
        path = desc.path / "setup.py"
        if desc.type == PYTHON_TYPE and path.is_file():
            desc.metadata["get_python_setup_options"] = lambda env: options(path, env)


def options(path: Path, env: Mapping[str, str]) -> dict[str, Any]:
    """Return the arguments and the metadata that a setup.py gives to `setup`, when it runs in an environment.

    Raises
    ------
    WorkspaceError
        Naming the line at fault of a setup.py that fails.
    """
    return dict(_options(path, tuple(sorted(env.items()))))


@cache
def _options(path: Path, env: tuple[tuple[str, str], ...]) -> Mapping[str, Any]:
    done = subprocess.run(
        [sys.executable, "-c", _QUERY], capture_output=True, text=True, cwd=path.parent, env=dict(env), check=False
    )
    values = done.stdout.rpartition("\0")[2]
    if done.returncode or "\0" not in done.stdout:
        problem, line = _fault(done.stderr)
        raise WorkspaceError(problem, Location(str(path), line))
    found: dict[str, Any] = ast.literal_eval(values)
    return found


def _fault(error_text: str) -> tuple[str, int | None]:
    """Return the error that a failing setup.py ends with, and the line at fault that it names."""
    lines = re.findall(r'File "setup\.py", line (\d+)', error_text)
    errors = re.findall(r"^[\w.]+: .*", error_text, re.MULTILINE) or [line for line in error_text.splitlines() if line]
    return (errors[-1] if errors else "it does not call setup()"), (int(lines[-1]) if lines else None)
