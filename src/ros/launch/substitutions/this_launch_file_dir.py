"""The substitution that is the launch file's own folder."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ._arguments import expect_arguments
from .path_join_substitution import PathSubstitution
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("dirname")
class ThisLaunchFileDir(PathSubstitution):
    """The folder of the launch file that is being visited."""

    def __init__(self) -> None:
        super().__init__(self)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[ThisLaunchFileDir], dict[str, Any]]:
        """Read `$(dirname)`."""
        expect_arguments("dirname", data, 0)
        return cls, {}

    def describe(self) -> str:
        """Return the substitution in words."""
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        variables = context.get_locals_as_dict()
        if "current_launch_file_directory" not in variables:
            raise SubstitutionFailure("ThisLaunchFileDir used outside of a launch file (in a script)")
        return str(variables["current_launch_file_directory"])
