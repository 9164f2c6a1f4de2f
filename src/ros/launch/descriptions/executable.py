"""A program with its arguments, folder and environment."""

from __future__ import annotations

import itertools
import os
import re
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions.launch_configuration import LaunchConfiguration
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_context import LaunchContext

_Text = list[Substitution]
_process_numbers = itertools.count(1)


@dataclass(frozen=True)
class PreparedExecutable:
    """A program whose texts are worked out.

    Parameters
    ----------
    name
        The process's name in the launch.
    cmd
        The whole command line.
    cwd
        The working directory, None for that of the launch.
    env
        The whole environment.
    """

    name: str
    cmd: list[str]
    cwd: str | None
    env: dict[str, str]


class Executable:
    """Command line and environment of a process.

    Parameters
    ----------
    cmd
        The program and its arguments.
    prefix
        Comes before them and is split as a shell would. If not said, the launch configuration
        `launch-prefix` for those programs whose name `launch-prefix-filter` matches (a regular expression).
    name
        The process's name without its number; the program's file name if not said.
    cwd
        The working directory, that of the launch if not said.
    env
        The environment, that of the launch if not said.
    additional_env
        Variables added to it.
    arguments
        More arguments.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        additional_env: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        self.__arguments = None if arguments is None else [normalize_to_list_of_substitutions(a) for a in arguments]
        self.__cmd = [*(normalize_to_list_of_substitutions(part) for part in cmd), *(self.__arguments or [])]
        self.__prefix_is_default = prefix is None
        self.__prefix: _Text = (
            [LaunchConfiguration("launch-prefix", default="")]
            if prefix is None
            else normalize_to_list_of_substitutions(prefix)
        )
        self.__prefix_filter: _Text = [LaunchConfiguration("launch-prefix-filter", default="")]
        self.__name = _optional(name)
        self.__cwd = _optional(cwd)
        self.__env = _pairs(env)
        self.__additional_env = _pairs(additional_env)
        self.__program: str | None = None
        self.__prepared: PreparedExecutable | None = None

    @property
    def name(self) -> _Text | None:
        """The process's name without its number."""
        return self.__name

    @property
    def prefix(self) -> _Text:
        """What comes before the program."""
        return self.__prefix

    @property
    def cmd(self) -> list[_Text]:
        """The program and its arguments."""
        return self.__cmd

    @property
    def cwd(self) -> _Text | None:
        """The working directory."""
        return self.__cwd

    @property
    def env(self) -> list[tuple[_Text, _Text]] | None:
        """The environment."""
        return self.__env

    @property
    def additional_env(self) -> list[tuple[_Text, _Text]] | None:
        """The variables added to the environment."""
        return self.__additional_env

    @property
    def arguments(self) -> list[_Text] | None:
        """The additional arguments."""
        return self.__arguments

    @property
    def final_name(self) -> str | None:
        """The process's name in the launch; None before `prepare`."""
        return None if self.__prepared is None else self.__prepared.name

    @property
    def final_cmd(self) -> list[str] | None:
        """The whole command line; None before `prepare`."""
        return None if self.__prepared is None else self.__prepared.cmd

    @property
    def final_cwd(self) -> str | None:
        """The working directory, None for that of the launch."""
        return None if self.__prepared is None else self.__prepared.cwd

    @property
    def final_env(self) -> dict[str, str] | None:
        """The whole environment; None before `prepare`."""
        return None if self.__prepared is None else self.__prepared.env

    @property
    def prepared(self) -> PreparedExecutable:
        """What `prepare` worked out.

        Raises
        ------
        RuntimeError
            Before `prepare`.
        """
        if self.__prepared is None:
            raise RuntimeError("the executable was not prepared: call 'prepare' first")
        return self.__prepared

    def _set_program(self, command: list[str], *, name: str) -> None:
        """Replace the program by a command that runs it, and keep the name that people know it by.

        Parameters
        ----------
        command
            The command, to which the arguments are appended.
        name
            The program's name.
        """
        self.__cmd[:1] = [normalize_to_list_of_substitutions(part) for part in command]
        self.__program = os.path.basename(name)

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Evaluate all texts for an action that is about to execute this.

        Parameters
        ----------
        context
            The launch context.
        action
            The action.
        """
        cmd = [perform_substitutions(context, part) for part in self.__cmd]
        # A shell's command line may be one text.
        first = cmd[0].split()[0] if getattr(action, "shell", False) and cmd[0].strip() else cmd[0]
        program = self.__program or os.path.basename(first)
        name = program if self.__name is None else perform_substitutions(context, self.__name)
        env = dict(context.environment) if self.__env is None else _perform_pairs(context, self.__env)
        env.update(_perform_pairs(context, self.__additional_env or []))
        self.__prepared = PreparedExecutable(
            name=f"{name}-{next(_process_numbers)}",
            cmd=[*self.__prefix_for(program, context), *cmd],
            cwd=None if self.__cwd is None else perform_substitutions(context, self.__cwd),
            env=env,
        )

    def __prefix_for(self, program: str, context: LaunchContext) -> list[str]:
        prefix = perform_substitutions(context, self.__prefix)
        if self.__prefix_is_default:
            prefix_filter = perform_substitutions(context, self.__prefix_filter)
            if prefix_filter and re.match(prefix_filter, program) is None:
                return []
        return shlex.split(prefix)


def _optional(text: SomeSubstitutionsType | None) -> _Text | None:
    return None if text is None else normalize_to_list_of_substitutions(text)


def _pairs(
    mapping: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None,
) -> list[tuple[_Text, _Text]] | None:
    if mapping is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in mapping.items()
    ]


def _perform_pairs(context: LaunchContext, pairs: list[tuple[_Text, _Text]]) -> dict[str, str]:
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in pairs}
