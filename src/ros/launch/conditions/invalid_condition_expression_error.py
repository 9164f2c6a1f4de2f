"""The error of a condition that is neither true nor false."""

from __future__ import annotations

from ..substitution import Substitution


class InvalidConditionExpressionError(ValueError):
    """A condition's text means neither true nor false.

    Parameters
    ----------
    expression
        The text.
    unexpanded_expression
        The substitutions that it came from.
    valid_expressions
        What it may be.
    """

    def __init__(
        self, expression: str, unexpanded_expression: list[Substitution], valid_expressions: list[str]
    ) -> None:
        source = " + ".join(substitution.describe() for substitution in unexpanded_expression)
        super().__init__(
            f"invalid condition expression '{expression}' from [{source}]: expected one of {valid_expressions}"
        )
