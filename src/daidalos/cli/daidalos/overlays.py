"""Sourced workspaces, which must not replace what the product runs itself."""

from __future__ import annotations

import os
from pathlib import Path

_PREFIX_PATHS = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH")


def leave_overlays() -> None:
    """Remove sourced workspaces from the environment of this process and of those that it starts."""
    prefixes = [Path(text) for name in _PREFIX_PATHS for text in os.environ.pop(name, "").split(os.pathsep) if text]
    python_path = [text for text in os.environ.get("PYTHONPATH", "").split(os.pathsep) if text]
    kept = [text for text in python_path if not any(Path(text).is_relative_to(prefix) for prefix in prefixes)]
    if kept != python_path:
        os.environ["PYTHONPATH"] = os.pathsep.join(kept)
