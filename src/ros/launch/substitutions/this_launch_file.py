"""The substitution that is the launch file's own path."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ._arguments import expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("filename")
class ThisLaunchFile(Substitution):
    """The path of the launch file that is being visited."""

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[ThisLaunchFile], dict[str, Any]]:
        """Read `$(filename)`."""
        expect_arguments("filename", data, 0)
        return cls, {}

    def describe(self) -> str:
        """Return the substitution in words."""
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        variables = context.get_locals_as_dict()
        if "current_launch_file_path" not in variables:
            raise SubstitutionFailure("ThisLaunchFile used outside of a launch file (in a script)")
        return str(variables["current_launch_file_path"])
