"""The action that runs a GTest program."""

from __future__ import annotations

from typing import Any

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

from .test import Test


class GTest(Test):
    """Action that runs a GTest program.

    Parameters
    ----------
    path
        The program.
    **kwargs
        As for `Test`.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[path], **kwargs)
        self.__path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The program."""
        return self.__path
