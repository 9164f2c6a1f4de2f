"""The base of all substitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Substitution:
    """A piece of text that is only known while launching."""

    def describe(self) -> str:
        """Return a short text that distinguishes this substitution from others."""
        return repr(self)

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the text."""
        raise NotImplementedError(f"{type(self).__name__} does not implement perform()")
