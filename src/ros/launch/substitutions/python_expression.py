"""The substitution that is the value of a Python expression."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("eval")
class PythonExpression(Substitution):
    """The value of a Python expression as text.

    Parameters
    ----------
    expression
        The expression.
    python_modules
        The modules it may use, `math` if not said; what is in `math` may be used without its prefix.
    """

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        self.__expression = normalize_to_list_of_substitutions(expression)
        self.__python_modules = normalize_to_list_of_substitutions(python_modules)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[PythonExpression], dict[str, Any]]:
        """Read `$(eval 'expression' 'module, module')`."""
        expect_arguments("eval", data, 1, 2)
        kwargs: dict[str, Any] = {"expression": data[0]}
        if len(data) == 2:
            names = "".join(getattr(part, "text", "") for part in normalize_to_list_of_substitutions(data[1]))
            kwargs["python_modules"] = [name.strip() for name in names.split(",") if name.strip()]
        return cls, kwargs

    @property
    def expression(self) -> list[Substitution]:
        """The expression."""
        return self.__expression

    @property
    def python_modules(self) -> list[Substitution]:
        """The modules that the expression may use."""
        return self.__python_modules

    def describe(self) -> str:
        """Return the substitution in words."""
        modules = ", ".join(module.describe() for module in self.python_modules)
        return f"PythonExpr({describe_text(self.expression)}, [{modules}])"

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the expression."""
        variables: dict[str, Any] = {}
        for name in (perform_substitutions(context, [module]) for module in self.python_modules):
            module = importlib.import_module(name)
            if name == "math":
                variables.update(vars(module))
            top_level = name.partition(".")[0]
            variables[top_level] = importlib.import_module(top_level)
        expression = perform_substitutions(context, self.expression)
        try:
            return str(eval(expression, variables))
        except Exception as error:
            error.add_note(f"in the Python expression: {expression}")
            raise
