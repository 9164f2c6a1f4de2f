"""The action that runs a process on this machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..descriptions.executable import Executable
from ..event_handlers import OnProcessExit
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..substitutions.launch_configuration import LaunchConfiguration
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

if TYPE_CHECKING:
    from asyncio import Future

    from .._process_runner import ProcessRunner, RunOptions
    from ..events.process import ProcessExited
    from ..launch_context import LaunchContext

_SIGTERM_TIMEOUT = LaunchConfiguration("sigterm_timeout", default=5)
_SIGKILL_TIMEOUT = LaunchConfiguration("sigkill_timeout", default=5)

OnExit = SomeEntitiesType | Callable[["ProcessExited", "LaunchContext"], SomeEntitiesType | None]


class ExecuteLocal(Action):
    """Action that runs a process, passes on what it prints, and stops it with the launch.

    To stop, the process and what it started get SIGINT, after `sigterm_timeout` SIGTERM, and after another
    `sigkill_timeout` SIGKILL.

    Parameters
    ----------
    process_description
        What to execute.
    shell
        Whether a shell runs it.
    sigterm_timeout, sigkill_timeout
        Timeouts [s]; the launch configurations of the same names if not said, 5 where these are not
        set.
    emulate_tty
        Whether the process writes to a pseudo terminal, which makes it print lines at once and in colour.
        The launch configuration of the same name comes before it.
    output
        Where to what it prints goes, see `launch.logging.get_output_loggers`. The environment variable
        OVERRIDE_LAUNCH_PROCESS_OUTPUT comes before it.
    output_format
        The form of a line, with `line` and `this` (the action).
    cached_output
        Whether what it prints is kept for `get_stdout` and `get_stderr`.
    log_cmd
        Whether the command line is logged.
    on_exit
        Entities to visit when the process ends, or a function that takes the event and the context and
        returns them.
    respawn
        Whether the process is started again when it ends.
    respawn_delay
        Seconds to wait before that.
    respawn_max_retries
        How often at most, -1 for ever.
    **kwargs
        As for `Action`.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType = _SIGTERM_TIMEOUT,
        sigkill_timeout: SomeSubstitutionsType = _SIGKILL_TIMEOUT,
        emulate_tty: bool = False,
        output: SomeSubstitutionsType | Mapping[str, Any] = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: OnExit | None = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | SomeSubstitutionsType | None = None,
        respawn_max_retries: int | SomeSubstitutionsType = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__process_description = process_description
        self.__shell = shell
        self.__sigterm_timeout = _as_text(sigterm_timeout)
        self.__sigkill_timeout = _as_text(sigkill_timeout)
        self.__emulate_tty = emulate_tty
        output = os.environ.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT", output)
        self.__output: Any = output if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self.__output_format = output_format
        self.__cached_output = cached_output
        self.__log_cmd = log_cmd
        self.__on_exit = on_exit
        self.__exit_handler = None if on_exit is None else OnProcessExit(target_action=self, on_exit=on_exit)
        self.__respawn = normalize_typed_substitution(respawn, bool)
        self.__respawn_delay = normalize_typed_substitution(0.0 if respawn_delay is None else respawn_delay, float)
        self.__respawn_max_retries = normalize_typed_substitution(respawn_max_retries, int)
        self.__executed = False
        self.__runner: ProcessRunner | None = None

    @property
    def process_description(self) -> Executable:
        """What is executed."""
        return self.__process_description

    @property
    def shell(self) -> bool:
        """Whether a shell runs it."""
        return self.__shell

    @property
    def emulate_tty(self) -> bool:
        """Whether the process writes to a pseudo terminal."""
        return self.__emulate_tty

    @property
    def sigterm_timeout(self) -> list[Substitution]:
        """Seconds between SIGINT and SIGTERM."""
        return self.__sigterm_timeout

    @property
    def sigkill_timeout(self) -> list[Substitution]:
        """Seconds between SIGTERM and SIGKILL."""
        return self.__sigkill_timeout

    @property
    def output(self) -> Any:
        """Where to what the process prints goes."""
        return self.__output

    @property
    def process_details(self) -> dict[str, Any] | None:
        """The process's `name`, `cmd`, `cwd`, `env` and `action`, and its `pid` once it has started.

        None before the action is executed.
        """
        return None if self.__runner is None else self.__runner.details

    @property
    def return_code(self) -> int | None:
        """The exit code, or minus the number of the signal that ended the process; None before that."""
        return None if self.__runner is None else self.__runner.return_code

    def get_stdout(self) -> str:
        """Return what the process printed.

        Raises
        ------
        RuntimeError
            If it was not kept.
        """
        self.__check_cached()
        return "" if self.__runner is None else self.__runner.stdout.text

    def get_stderr(self) -> str:
        """Return the errors that the process printed.

        Raises
        ------
        RuntimeError
            If they were not kept.
        """
        self.__check_cached()
        return "" if self.__runner is None else self.__runner.stderr.text

    def __check_cached(self) -> None:
        if not self.__cached_output:
            raise RuntimeError(f"the output of {self.describe()} is not kept: set 'cached_output'")

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities for when the process ends."""
        return self.__on_exit if isinstance(self.__on_exit, list) else []

    def get_asyncio_future(self) -> Future[None] | None:
        """Return a future that is done when the process has ended and will not be started again."""
        return None if self.__runner is None else self.__runner.completed

    def prepare(self, context: LaunchContext) -> None:
        """Evaluate what to execute."""
        self.__process_description.prepare(context, self)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the process."""
        # A launch file that only describes processes does not pay for running them.
        from .._process_runner import ProcessRunner

        self.prepare(context)
        if self.__executed:
            name = self.__process_description.final_name
            raise RuntimeError(f"ExecuteLocal action '{name}': executed more than once: {self.describe()}")
        self.__executed = True
        if context.is_shutdown:
            return None
        self.__runner = ProcessRunner(self, self.__options(context), self.__exit_handler, context)
        self.__runner.start()
        return None

    def __options(self, context: LaunchContext) -> RunOptions:
        from .._process_runner import RunOptions

        if not isinstance(self.__output, Mapping):
            self.__output = perform_substitutions(context, normalize_to_list_of_substitutions(self.__output))
        return RunOptions(
            shell=self.__shell,
            emulate_tty=self.__is_tty_emulated(context),
            output=self.__output,
            output_format=self.__output_format,
            cached_output=self.__cached_output,
            log_cmd=self.__log_cmd,
            sigterm_timeout=float(perform_substitutions(context, self.__sigterm_timeout)),
            sigkill_timeout=float(perform_substitutions(context, self.__sigkill_timeout)),
            respawn=perform_typed_substitution(context, self.__respawn, bool),
            respawn_delay=perform_typed_substitution(context, self.__respawn_delay, float),
            respawn_max_retries=perform_typed_substitution(context, self.__respawn_max_retries, int),
        )

    def __is_tty_emulated(self, context: LaunchContext) -> bool:
        from ..conditions import evaluate_condition_expression

        if os.name != "posix":
            return False
        if "emulate_tty" in context.launch_configurations:
            return evaluate_condition_expression(context, [LaunchConfiguration("emulate_tty")])
        if isinstance(self.__emulate_tty, bool):
            return self.__emulate_tty
        return evaluate_condition_expression(context, normalize_to_list_of_substitutions(self.__emulate_tty))


def _as_text(seconds: SomeSubstitutionsType | float) -> list[Substitution]:
    return normalize_to_list_of_substitutions(str(seconds) if isinstance(seconds, int | float) else seconds)
