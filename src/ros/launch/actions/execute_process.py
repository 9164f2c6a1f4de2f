"""The action that runs a command line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..descriptions.executable import Executable
from ..frontend.entity import Entity
from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions.text_substitution import TextSubstitution
from .execute_local import ExecuteLocal
from .shutdown_action import Shutdown

if TYPE_CHECKING:
    from ..frontend.parser import Parser

# Attributes of an element that are texts, and those that have another type, with their arguments' names.
_TEXTS = {
    "cwd": "cwd",
    "name": "name",
    "launch-prefix": "prefix",
    "output": "output",
}
_TYPED = {
    "respawn": bool,
    "respawn_max_retries": int,
    "respawn_delay": float,
    "sigkill_timeout": float,
    "sigterm_timeout": float,
}


@expose_action("executable")
class ExecuteProcess(ExecuteLocal):
    """Action that runs a command line; see `ExecuteLocal` for how.

    Parameters
    ----------
    cmd
        The program and its arguments.
    prefix, name, cwd, env, additional_env
        As for `launch.descriptions.Executable`.
    **kwargs
        As for `ExecuteLocal`.
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
        **kwargs: Any,
    ) -> None:
        executable = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=executable, **kwargs)

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: list[str] | None = None
    ) -> tuple[type[ExecuteProcess], dict[str, Any]]:
        """Read an element `executable`.

        Parameters
        ----------
        entity
            The element.
        parser
            The parser of its file.
        ignore
            Arguments that a subclass reads itself.
        """
        _, kwargs = super().parse(entity, parser)
        ignored = set(ignore or [])
        if "cmd" not in ignored:
            kwargs["cmd"] = cls._parse_cmdline(entity.get_attr("cmd"), parser)
        for attribute, argument in _TEXTS.items():
            if argument not in ignored:
                text = entity.get_attr(attribute, optional=True)
                if text is not None:
                    kwargs[argument] = parser.parse_substitution(text)
        for name, data_type in _TYPED.items():
            if name not in ignored:
                value = entity.get_attr(name, data_type=data_type, optional=True, can_be_str=True)
                if value is not None:
                    kwargs[name] = parser.parse_if_substitutions(value)
        for name in ("shell", "emulate_tty", "log_cmd"):
            if name not in ignored:
                value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
                if value is not None:
                    kwargs[name] = value
        if "on_exit" not in ignored:
            on_exit = entity.get_attr("on_exit", optional=True)
            if on_exit is not None:
                if on_exit != "shutdown":
                    raise ValueError(
                        f"the attribute 'on_exit' of '{entity.type_name}' is '{on_exit}', expected 'shutdown'"
                    )
                kwargs["on_exit"] = [Shutdown()]
        if "additional_env" not in ignored:
            variables = entity.get_attr("env", data_type=list[Entity], optional=True)
            if variables is not None:
                kwargs["additional_env"] = _parse_env(variables, parser)
        return cls, kwargs

    @classmethod
    def _parse_cmdline(cls, cmd: str, parser: Parser) -> list[list[Substitution]]:
        """Split a command line as a shell would; what a substitution yields is never split."""
        return split_words(parser.parse_substitution(cmd))

    @property
    def name(self) -> str | list[Substitution] | None:
        """The process's name in the launch, once it is known."""
        description = self.process_description
        return description.name if description.final_name is None else description.final_name

    @property
    def cmd(self) -> Any:
        """The command line, once it is known as a list of strings."""
        description = self.process_description
        return description.cmd if description.final_cmd is None else description.final_cmd

    @property
    def cwd(self) -> Any:
        """The working directory, once it is known as a string."""
        description = self.process_description
        return description.cwd if description.final_cwd is None else description.final_cwd

    @property
    def env(self) -> Any:
        """The environment, once it is known as a dictionary."""
        description = self.process_description
        return description.env if description.final_env is None else description.final_env

    @property
    def additional_env(self) -> Any:
        """The variables added to the environment."""
        return self.process_description.additional_env


def split_words(substitutions: list[Substitution]) -> list[list[Substitution]]:
    """Split a command line into words as a shell would; substitutions are atoms of words.

    Raises
    ------
    ValueError
        If a quote is not closed.
    """
    splitter = _WordSplitter()
    for substitution in substitutions:
        if isinstance(substitution, TextSubstitution):
            splitter.feed(substitution.text)
        else:
            splitter.add(substitution)
    return splitter.finish()


class _WordSplitter:
    """Splitter of text with quotes and backslashes into words, in pieces."""

    def __init__(self) -> None:
        self.words: list[list[Substitution]] = []
        self.parts: list[Substitution] = []
        self.plain = ""
        self.quote = ""
        self.escaped = False
        self.inside = False

    def feed(self, text: str) -> None:
        for character in text:
            if self.escaped:
                # Inside double quotes a backslash only escapes what would mean something there.
                kept = "\\" if self.quote and character not in '"\\' else ""
                self.write(kept + character)
                self.escaped = False
            elif character == "\\" and self.quote != "'":
                self.escaped = self.inside = True
            elif character == self.quote:
                self.quote = ""
            elif not self.quote and character in "'\"":
                self.quote = character
                self.inside = True
            elif not self.quote and character.isspace():
                self.end_word()
            else:
                self.write(character)

    def write(self, text: str) -> None:
        self.plain += text
        self.inside = True

    def add(self, substitution: Substitution) -> None:
        self.flush()
        self.parts.append(substitution)
        self.inside = True

    def flush(self) -> None:
        if self.plain:
            self.parts.append(TextSubstitution(text=self.plain))
            self.plain = ""

    def end_word(self) -> None:
        self.flush()
        if self.inside:
            self.words.append(self.parts or [TextSubstitution(text="")])
        self.parts = []
        self.inside = False

    def finish(self) -> list[list[Substitution]]:
        if self.quote or self.escaped:
            raise ValueError(f"No closing quotation: {self.quote or 'backslash'} in a command line")
        self.end_word()
        return self.words


def _parse_env(variables: list[Entity], parser: Parser) -> dict[Any, Any]:
    parsed: dict[Any, Any] = {}
    for variable in variables:
        name = tuple(parser.parse_substitution(variable.get_attr("name")))
        parsed[name] = parser.parse_substitution(variable.get_attr("value"))
        variable.assert_entity_completely_parsed()
    return parsed
