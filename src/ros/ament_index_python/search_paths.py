"""The prefixes in which packages are looked for.

A prefix is a folder with `share/<package>` and `share/ament_index` in it. Those in the environment come
first; the Python environment itself and the packages that come with this project follow without being named
anywhere.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec

from .constants import AMENT_PREFIX_PATH_ENV_VAR


def get_search_paths() -> list[str]:
    """Return the prefixes that the environment names, as far as they exist.

    Raises
    ------
    EnvironmentError
        If AMENT_PREFIX_PATH is not set or empty.
    """
    paths = _environment_paths()
    if not os.environ.get(AMENT_PREFIX_PATH_ENV_VAR):
        raise OSError(f"Environment variable '{AMENT_PREFIX_PATH_ENV_VAR}' is not set or empty")
    return paths


def get_all_prefixes() -> list[str]:
    """Return the prefixes of the environment, the Python environment, and what comes with this project."""
    prefixes = [*_environment_paths(), sys.prefix]
    built_in = get_built_in_prefix()
    if built_in is not None:
        prefixes.append(built_in)
    return list(dict.fromkeys(prefixes))


def get_built_in_prefix() -> str | None:
    """Return the prefix of the packages that come with this project.

    In it `share/<package>/package.xml` alone makes a package.
    """
    spec = find_spec("daidalos")
    if spec is None or not spec.submodule_search_locations:
        return None
    return os.path.abspath(next(iter(spec.submodule_search_locations)))


def _environment_paths() -> list[str]:
    paths = os.environ.get(AMENT_PREFIX_PATH_ENV_VAR, "").split(os.pathsep)
    return [path for path in paths if path and os.path.isdir(path)]
