"""The substitution that is what a command prints."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.tracebacks import without_frames

from .._programs import search_path, which
from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments
from .substitution_failure import SubstitutionFailure

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

_ON_STDERR = ("fail", "ignore", "warn", "capture")


@expose_substitution("command")
class Command(Substitution):
    """The standard output of a command.

    Parameters
    ----------
    command
        The command line; it is split as a shell would, but no shell runs it.
    on_stderr
        What to do when it prints errors: 'fail', 'ignore', 'warn', or 'capture' to have them in the text.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.__command = normalize_to_list_of_substitutions(command)
        self.__on_stderr = normalize_to_list_of_substitutions(on_stderr)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Command], dict[str, Any]]:
        """Read `$(command 'line' 'on_stderr')`."""
        expect_arguments("command", data, 1, 2)
        kwargs = {"command": data[0]}
        if len(data) == 2:
            kwargs["on_stderr"] = data[1]
        return cls, kwargs

    @property
    def command(self) -> list[Substitution]:
        """The command line."""
        return self.__command

    @property
    def on_stderr(self) -> list[Substitution]:
        """What to do when it prints errors."""
        return self.__on_stderr

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"Command({describe_text(self.command)})"

    def perform(self, context: LaunchContext) -> str:
        """Run the command and return what it prints."""
        line = perform_substitutions(context, self.command)
        on_stderr = perform_substitutions(context, self.on_stderr)
        if on_stderr not in _ON_STDERR:
            raise SubstitutionFailure(f"on_stderr is '{on_stderr}', but it should be one of {', '.join(_ON_STDERR)}")
        try:
            arguments = shlex.split(line) if os.name != "nt" else shlex.split(line.replace("\\", "/"))
        except ValueError as error:
            raise SubstitutionFailure(f"the command line '{line}' cannot be split: {error}") from error
        if not arguments:
            raise SubstitutionFailure("the command line is empty")
        result = _run(arguments, dict(context.environment), line, merged=on_stderr == "capture")
        if result.returncode != 0:
            captured = without_frames(result.stderr or result.stdout)
            raise SubstitutionFailure(
                f"executed command failed. Command: {line}\n"
                f"Exit code: {result.returncode}. Captured stderr output: {captured}"
            )
        if result.stderr and on_stderr in ("fail", "warn"):
            message = (
                f"executed command showed stderr output. Command: {line}\n"
                f"Captured stderr output:\n{without_frames(result.stderr)}"
            )
            if on_stderr == "fail":
                raise SubstitutionFailure(message)
            from ..logging import get_logger

            get_logger("launch.substitutions.Command").warning(message)
        return result.stdout


def _run(
    arguments: list[str], environment: dict[str, str], line: str, *, merged: bool
) -> subprocess.CompletedProcess[str]:
    environment["PATH"] = search_path(environment)
    program = which(arguments[0], environment)
    if program is None:
        raise SubstitutionFailure(f"file not found: '{arguments[0]}', in the command: {line}")
    own_xacro = Path(program) == Path(sys.executable).with_name("xacro")
    # Ours names the file and the line of a mistake; the one of the package `xacro` may stand there.
    # Only commands that are run pay for it.
    from daidalos.workspaces.executables import built_in_command

    beginning = built_in_command("xacro", "xacro") if own_xacro else [program]
    try:
        return subprocess.run(
            [*beginning, *arguments[1:]],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if merged else subprocess.PIPE,
            text=True,
            env=environment,
            check=False,
        )
    except OSError as error:
        raise SubstitutionFailure(f"the command cannot be run: {line}: {error}") from error
