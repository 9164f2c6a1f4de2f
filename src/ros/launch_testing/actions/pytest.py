"""The action that runs pytest."""

from __future__ import annotations

import sys
from typing import Any

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

from .test import Test


class PyTest(Test):
    """Action that runs pytest on a file or folder.

    Parameters
    ----------
    path
        The file or folder.
    **kwargs
        As for `Test`.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, "-m", "pytest", path], **kwargs)
        self.__path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The file or folder."""
        return self.__path
