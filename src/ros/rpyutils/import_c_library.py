"""Import of a compiled module."""

from __future__ import annotations

import importlib
from types import ModuleType

from rpyutils.add_dll_directories import add_dll_directories_from_env


def import_c_library(name: str, package: str | None = None) -> ModuleType:
    """Import a compiled module.

    Parameters
    ----------
    name
        The module; a relative one begins with a dot.
    package
        The package that a relative module is in.

    Raises
    ------
    ImportError
        When it cannot be imported; the message says what to check.
    """
    with add_dll_directories_from_env("PATH"):
        try:
            return importlib.import_module(name, package=package)
        except ImportError as error:
            if error.path is None:  # there is no such module
                raise
            error.msg = (
                f"{error.msg}\nThe C extension '{error.path}' failed to be imported while being present on the system."
                " Check that it was built for this Python and that the libraries which it needs are installed."
            )
            raise
