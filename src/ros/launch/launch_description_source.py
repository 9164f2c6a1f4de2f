"""Sources of launch descriptions: files or the program itself."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from .some_substitutions_type import SomeSubstitutionsType
from .utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from .launch_context import LaunchContext
    from .launch_description import LaunchDescription


class LaunchDescriptionSource:
    """A launch description together with where it was found; subclasses load it from files.

    Parameters
    ----------
    launch_description
        The description, where it is already there.
    location
        Where it comes from, usually a path.
    method
        How it is obtained, in words.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "<string>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self.__launch_description = launch_description
        self.__loaded_from: str | None = None
        self.__location = normalize_to_list_of_substitutions(location)
        self.__expanded_location: str | None = None
        self.__method = method

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description if it can be found before launching, else None.

        It cannot where its location depends on what only happens while launching.
        """
        if self.__launch_description is None:
            from .launch_context import LaunchContext
            from .logging import get_logger

            try:
                self.__load(perform_substitutions(LaunchContext(), self.__location))
            # A location or a launch file may raise anything; that is an answer to this question.
            except Exception as error:
                get_logger("launch.launch_description_source").debug(
                    f"no launch description from {self.location} before launching: {error}"
                )
        return self.__launch_description

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description, loading it the first time."""
        if self.__expanded_location is None:
            location = perform_substitutions(context, self.__location)
            given = self.__loaded_from is None and self.__launch_description is not None
            self.__expanded_location = location if given else _beside_current_launch_file(location, context)
        # It may have been loaded before launching, when the location meant another file.
        if self.__loaded_from not in (None, self.__expanded_location):
            self.__launch_description = None
        return self.__launch_description or self.__load(self.__expanded_location)

    def __load(self, location: str) -> LaunchDescription:
        self.__launch_description = self._get_launch_description(location)
        self.__loaded_from = location
        return self.__launch_description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise NotImplementedError(f"{type(self).__name__} does not know how to load a launch description")

    @property
    def location(self) -> str:
        """The location as text; before launching, its substitutions as Python shows them."""
        if self.__expanded_location is None:
            return " + ".join(str(substitution) for substitution in self.__location)
        return self.__expanded_location

    @property
    def method(self) -> str:
        """How the description is obtained, in words."""
        return self.__method


def _beside_current_launch_file(location: str, context: LaunchContext) -> str:
    """Find a relative path beside the launch file that mentions it, if it is not in the working folder."""
    if location.startswith("<") or os.path.isabs(location) or os.path.exists(location):
        return location  # the first is no file
    folder = context.get_locals_as_dict().get("current_launch_file_directory")
    if isinstance(folder, str):
        beside = os.path.join(folder, location)
        if os.path.exists(beside):
            return beside
    return location
