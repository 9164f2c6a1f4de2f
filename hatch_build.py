"""Build hook: generates the Python classes of the built-in interfaces."""

from __future__ import annotations

import compileall
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Runs before a wheel or an editable install is put together."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write `src/generated`, and compile it so that the first start is as quick as the next."""
        root = Path(self.root)
        sys.path.insert(0, str(root / "src"))
        from daidalos.interfaces.build import write_built_in

        generated = root / "src" / "generated"
        generated.mkdir(exist_ok=True)
        write_built_in(root / "src" / "daidalos" / "share", generated)
        if version == "editable":
            compileall.compile_dir(root / "src", quiet=2)
