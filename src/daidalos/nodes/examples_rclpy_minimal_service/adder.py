"""Server of ``add_two_ints``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import Adder
from daidalos.nodes.runner import run


class MinimalService(Adder):
    """Server that adds two numbers."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("minimal_service", **kwargs)


def main() -> int:
    """Run the node."""
    return run(MinimalService)
