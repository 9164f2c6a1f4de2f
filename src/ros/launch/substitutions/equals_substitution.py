"""The substitution that compares two values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._pair import PairSubstitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("equals")
class EqualsSubstitution(PairSubstitution):
    """'true' if two values are equal, else 'false'.

    Texts that mean true or false (`true`, `1`, `false` and `0` in any case) are compared as such, numbers as
    numbers, all else as text.
    None is the same as no text.

    Parameters
    ----------
    left, right
        The values.
    """

    frontend_name = "equals"

    def __init__(self, left: Any | Iterable[Any] | None, right: Any | Iterable[Any] | None) -> None:
        super().__init__(_as_substitutions(left), _as_substitutions(right))

    def perform(self, context: LaunchContext) -> str:
        """Compare the values."""
        equal = _equal(perform_substitutions(context, self.left), perform_substitutions(context, self.right))
        return str(equal).lower()


def _as_substitutions(value: Any) -> list[Substitution]:
    if isinstance(value, Iterable) and not isinstance(value, str):
        return [substitution for item in value for substitution in _as_substitutions(item)]
    if isinstance(value, str | Path | Substitution):
        return normalize_to_list_of_substitutions(value)
    if value is None:
        return normalize_to_list_of_substitutions("")
    return normalize_to_list_of_substitutions(str(value).lower() if isinstance(value, bool) else str(value))


def _equal(left: str, right: str) -> bool:
    truths = {"true": True, "1": True, "false": False, "0": False}
    if left.lower() in truths and right.lower() in truths:
        return truths[left.lower()] == truths[right.lower()]
    try:
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right
