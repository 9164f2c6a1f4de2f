"""The condition that a launch configuration has some value."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from ..condition import Condition
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class LaunchConfigurationEquals(Condition):
    """Condition that holds if a launch configuration has some value.

    Parameters
    ----------
    launch_configuration_name
        The configuration's name.
    expected_value
        The value; None for a configuration that is not set.
    """

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        warnings.warn(
            f"{type(self).__name__} is deprecated: use IfCondition with EqualsSubstitution or NotEqualsSubstitution",
            UserWarning,
            stacklevel=2,
        )
        self.__name = launch_configuration_name
        self.__expected_value = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=self._predicate_func)

    def _predicate_func(self, context: LaunchContext) -> bool:
        expected = None if self.__expected_value is None else perform_substitutions(context, self.__expected_value)
        return context.launch_configurations.get(self.__name) == expected

    def describe(self) -> str:
        """Return the condition in words."""
        expected = "None"
        if self.__expected_value is not None:
            expected = " + ".join(sub.describe() for sub in self.__expected_value)
        return f"{type(self).__name__}('{self.__name}', {expected})"
