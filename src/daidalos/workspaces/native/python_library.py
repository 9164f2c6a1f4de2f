"""What a C++ program needs to start this Python: its shared library, its home and its paths."""

from __future__ import annotations

import platform
import site
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
    # Not sys.path, to which a sourced workspace adds its own: then each workspace would have a library.
    paths = site.getsitepackages()
    if site.ENABLE_USER_SITE:
        paths.append(site.getusersitepackages())
    lines = [
        str(_library()),
        sys.base_prefix,
        "import site, sys",
        f"sys.prefix = sys.exec_prefix = {sys.prefix!r}",
        f"sys.executable = {sys.executable!r}",
        # The base's own packages give way to those of this environment; PYTHONPATH comes first, as ever.
        "base = set(site.getsitepackages([sys.base_prefix]))",
        "first = [path for path in sys.path if path not in base]",
        "sys.path[:] = []",
        f"for path in {paths!r}:",
        "    site.addsitedir(path)",
        "sys.path[:] = first + [path for path in sys.path if path not in first]",
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
