"""The substitution that is a variable of the present scope."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..substitution import Substitution
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class LocalSubstitution(Substitution):
    """A variable among the context's locals, such as the event that is being handled.

    Parameters
    ----------
    expression
        What to read from the locals, such as 'event.process_name'.
    description
        The same in words.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        if not isinstance(expression, str):
            raise TypeError(f"LocalSubstitution expects a 'str' for 'expression', but it got {expression!r}")
        self.__expression = expression
        self.__description = description

    @property
    def expression(self) -> str:
        """What is read from the locals."""
        return self.__expression

    @property
    def description(self) -> str | None:
        """The same in words."""
        return self.__description

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"LocalVar('{self.expression if self.description is None else self.description}')"

    def perform(self, context: LaunchContext) -> str:
        """Read the variable."""
        try:
            return str(eval(f"context.locals.{self.expression}", {}, {"context": context}))
        except (AttributeError, KeyError, IndexError) as error:
            raise SubstitutionFailure(f"local variable '{self.expression}' does not exist: {error}") from error
