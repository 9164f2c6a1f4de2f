"""The type of whatever text can be given as: a string, a path, a substitution or a sequence of these."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from .substitution import Substitution

SomeSubstitutionsType = str | Path | Substitution | Iterable[str | Path | Substitution]

SomeSubstitutionsType_types_tuple = (str, Path, Substitution, Iterable)
