"""The substitution that is the folder of the log files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..logging import launch_config as launch_logging_config
from ..some_substitutions_type import SomeSubstitutionsType
from ._arguments import expect_arguments
from .path_join_substitution import PathSubstitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("launch_log_dir")
@expose_substitution("log_dir")
class LaunchLogDir(PathSubstitution):
    """The folder of this launch's log files."""

    def __init__(self) -> None:
        super().__init__(self)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[LaunchLogDir], dict[str, Any]]:
        """Read `$(launch_log_dir)`."""
        expect_arguments("launch_log_dir", data, 0)
        return cls, {}

    def describe(self) -> str:
        """Return the substitution in words."""
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return launch_logging_config.log_dir
