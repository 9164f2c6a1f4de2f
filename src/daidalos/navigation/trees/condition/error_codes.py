"""Condition node on error codes of actions."""

import json
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, entry


def code_list(text: str) -> list[int]:
    """Parse error codes in BehaviorTree.CPP's notations, ``101;107`` and ``json:[101, 107]``."""
    if text.startswith("json:"):
        return [int(code) for code in json.loads(text.removeprefix("json:"))]
    return [int(code) for code in text.split(";") if code.strip()]


class AreErrorCodesPresent(Node):
    """Condition node that succeeds where an action's error code is one of those that are given by number."""

    names = ("AreErrorCodesPresent",)
    PORTS: ClassVar[dict[str, Port]] = {
        "error_code": Port(entry),
        "error_codes_to_check": Port(code_list),
    }

    def update(self) -> Status:
        """Compare the numbers."""
        code: Any = self.ports.get("error_code")
        wanted = self.ports.get("error_codes_to_check") or ()
        return Status.SUCCESS if getattr(code, "number", code) in wanted else Status.FAILURE
