"""Text in any of the forms it can be given in, as a list of substitutions."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """Return the substitutions that make up a text.

    Raises
    ------
    TypeError
        If something in it is neither a string, nor a path, nor a substitution.
    """
    if isinstance(subs, str | Path | Substitution) or not isinstance(subs, Iterable):
        return [_as_substitution(subs)]
    return [_as_substitution(sub) for sub in subs]


def _as_substitution(value: Any) -> Substitution:
    from ..substitutions.text_substitution import TextSubstitution

    if isinstance(value, Substitution):
        return value
    if isinstance(value, str | Path):
        return TextSubstitution(text=str(value))
    raise TypeError(
        f"Failed to normalize {value!r} of type '{type(value).__name__}': "
        "only 'str', 'pathlib.Path' and 'launch.Substitution' make a text"
    )
