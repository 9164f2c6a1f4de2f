"""Build hook: generates the Python classes of the built-in interfaces."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Runs before a wheel or an editable install is put together."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write `src/generated`."""
        root = Path(self.root)
        sys.path.insert(0, str(root / "src"))
