"""A substitution for launch arguments that are switches."""

from __future__ import annotations

from launch import LaunchContext, Substitution
from launch.substitutions import LaunchConfiguration

_TRUE = ("1", "true", "t", "yes", "y", "on")


class LaunchConfigAsBool(Substitution):
    """``True`` where a launch argument is 1, true, yes or on in any case, else ``False``.

    Parameters
    ----------
    name
        Of the argument.
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self.__configuration = LaunchConfiguration(name)
        self.__name = name

    @property
    def name(self) -> str:
        """The argument's name."""
        return self.__name

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"LaunchConfigAsBool('{self.__name}')"

    def perform(self, context: LaunchContext) -> str:
        """Convert the argument to a Boolean text."""
        return str(self.__configuration.perform(context).strip().lower() in _TRUE)
