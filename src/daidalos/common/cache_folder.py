"""The folder for what is computed once and kept."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def cache_folder() -> Path:
    """Return the cache folder: ``DAIDALOS_CACHE``, else the system's."""
    chosen = os.environ.get("DAIDALOS_CACHE")
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "daidalos"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "daidalos"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "daidalos"
