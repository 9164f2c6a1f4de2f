"""Environments of Gymnasium around simulated worlds and robots.

Importing it registers ``daidalos/World-v0``: ``gymnasium.make("daidalos.learning:daidalos/World-v0", world="arena")``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.learning.environment import WorldEnv, make_vector
    from daidalos.learning.state import State

__all__ = ["State", "WorldEnv", "make_vector"]

_MODULES = {
    "State": "daidalos.learning.state",
    "WorldEnv": "daidalos.learning.environment",
    "make_vector": "daidalos.learning.environment",
}


def __getattr__(name: str) -> Any:
    """Import Gymnasium on first use."""
    if name in _MODULES:
        from importlib import import_module

        return getattr(import_module(_MODULES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _register() -> None:
    from importlib.util import find_spec

    from daidalos.common.errors import UserError

    if find_spec("gymnasium") is None:
        raise UserError("environments need Gymnasium: pip install 'daidalos[learning]'")
    import gymnasium

    if "daidalos/World-v0" not in gymnasium.registry:
        gymnasium.register("daidalos/World-v0", entry_point="daidalos.learning.environment:WorldEnv")


_register()
