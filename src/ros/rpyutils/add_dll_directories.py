"""Folders in which Windows looks for the libraries of compiled modules."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any


@contextmanager
def add_dll_directories_from_env(env_name: str) -> Iterator[list[Any]]:
    """Add the folders of an environment variable, such as ``PATH``, meanwhile; yield what was added.

    Other systems than Windows need none.

    Parameters
    ----------
    env_name
        Name of the variable; relative paths in it and folders that do not exist are left out.
    """
    with ExitStack() as added:
        folders = [
            folder
            for folder in dict.fromkeys(os.environ.get(env_name, "").split(os.pathsep))
            if os.path.isabs(folder) and os.path.isdir(folder)
        ]
        add = getattr(os, "add_dll_directory", None)
        yield [] if add is None else [added.enter_context(add(folder)) for folder in folders]
