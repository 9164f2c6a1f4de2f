"""What a C++ program needs to start this Python: its shared library, its home and its paths."""

from __future__ import annotations

import platform
import sys
import sysconfig
from pathlib import Path

from daidalos.workspaces.errors import WorkspaceError


def python_start() -> str:
    """Return the text of ``python_start.txt``: libpython, Python's home, and what the interpreter runs first.

    Raises
    ------
    WorkspaceError
        When this Python has no shared library.
    """
    paths = [path for path in sys.path if path and ("site-packages" in path or "dist-packages" in path)]
    lines = [
        str(_library()),
        sys.base_prefix,
        "import site, sys",
        f"sys.prefix = sys.exec_prefix = {sys.prefix!r}",
        f"sys.executable = {sys.executable!r}",
        "standard = [path for path in sys.path if not path.endswith('-packages')]",
        "sys.path[:] = []",
        f"for path in {paths!r}:",
        "    site.addsitedir(path)",
        "sys.path[:] = standard + [path for path in sys.path if path not in standard]",
    ]
    return "\n".join(lines) + "\n"


def _library() -> Path:
    names: list[str | None] = [sysconfig.get_config_var(name) for name in ("INSTSONAME", "LDLIBRARY", "PY3LIBRARY")]
    major, minor = sys.version_info[:2]
    names += [f"libpython{major}.{minor}.so.1.0", f"libpython{major}.{minor}.so", f"libpython{major}.{minor}.dylib"]
    folders: list[str | None] = [
        sysconfig.get_config_var(name) for name in ("LIBDIR", "LIBPL", "PYTHONFRAMEWORKPREFIX")
    ]
    folders += [str(Path(sys.base_prefix) / "lib"), f"/usr/lib/{platform.machine()}-linux-gnu"]
    for folder in filter(None, folders):
        for name in filter(None, names):
            path = Path(str(folder)) / str(name)
            if path.is_file() and path.suffix != ".a":
                return path
    raise WorkspaceError(
        f"'{sys.executable}' has no shared library, which C++ nodes load: install it (apt: libpython{major}.{minor}), "
        "or use a Python of uv or conda, which has one"
    )
