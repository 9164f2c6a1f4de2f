"""Contract of commands and verbs."""

from __future__ import annotations

from typing import Any, Protocol, runtime_checkable


@runtime_checkable
class Subcommand(Protocol):
    """Command or verb: a class with `main`, whose docstring is its description.

    It declares its arguments in ``add_arguments(parser, cli_name)``, and `main` takes them as ``args``.
    """

    def main(self, *args: Any, **keywords: Any) -> Any:
        """Run it, and return the exit status, or a message for standard error."""
