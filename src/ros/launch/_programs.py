"""Lookup of programs: on the PATH, then beside the Python interpreter of the launch.

The commands of a virtual environment (`ros2`, `xacro`) are found although nobody activated it.
"""

from __future__ import annotations

import os
import shutil
import sysconfig
from collections.abc import Mapping


def search_path(environment: Mapping[str, str]) -> str:
    """Return the PATH of an environment with the interpreter's own folder of commands at its end."""
    path = environment.get("PATH", os.defpath)
    scripts = sysconfig.get_path("scripts")
    folders = path.split(os.pathsep)
    return path if scripts in folders else os.pathsep.join([*folders, scripts])


def which(program: str, environment: Mapping[str, str]) -> str | None:
    """Return the file that a program's name stands for, or None."""
    return shutil.which(program, path=search_path(environment))
