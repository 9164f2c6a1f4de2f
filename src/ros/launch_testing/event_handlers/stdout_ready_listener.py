"""The reaction to a process that reports that it is ready."""

from __future__ import annotations

from typing import Any

from launch.actions import ExecuteProcess
from launch.event_handlers import OnProcessIO
from launch.events.process import ProcessIO
from launch.some_entities_type import SomeEntitiesType


class StdoutReadyListener(OnProcessIO):
    """Event handler that visits entities once a process has printed a text to its standard output.

    Parameters
    ----------
    target_action
        The action that runs the process, None for any.
    ready_txt
        The text.
    actions
        The entities.
    """

    def __init__(
        self, *, target_action: ExecuteProcess | None = None, ready_txt: str, actions: list[SomeEntitiesType]
    ) -> None:
        super().__init__(target_action=target_action, on_stdout=self.__on_stdout)
        self.__ready_text = ready_txt
        self.__actions = actions
        self.__text = ""
        self.__is_ready = False

    def __on_stdout(self, process_io: ProcessIO) -> Any:
        if self.__is_ready:
            return None
        self.__text += process_io.text.decode(errors="replace")
        if self.__ready_text not in self.__text:
            return None
        self.__is_ready = True
        self.__text = ""
        return self.__actions

    def describe(self) -> tuple[str, list[SomeEntitiesType]]:
        """Return the handler in words and the entities that it yields."""
        text, _ = super().describe()
        return text, list(self.__actions)
