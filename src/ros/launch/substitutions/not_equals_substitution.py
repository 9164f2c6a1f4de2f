"""The substitution by whether two values differ."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..frontend.expose import expose_substitution
from .equals_substitution import EqualsSubstitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("not-equals")
class NotEqualsSubstitution(EqualsSubstitution):
    """'true' if two values are not equal, else 'false'; parameters as for `EqualsSubstitution`."""

    frontend_name = "not-equals"

    def perform(self, context: LaunchContext) -> str:
        """Compare the values."""
        return "false" if super().perform(context) == "true" else "true"
