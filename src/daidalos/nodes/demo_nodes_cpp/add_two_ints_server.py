"""`add_two_ints_server`: adds integers."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import Adder


class AddTwoIntsServer(Adder):
    """Server of ``add_two_ints``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("add_two_ints_server", **kwargs)
