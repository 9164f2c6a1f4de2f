"""A launch description as a tree of text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, cast

from .action import Action
from .actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from .event_handler import BaseEventHandler
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .some_substitutions_type import SomeSubstitutionsType
from .utilities import is_a, normalize_to_list_of_entities, normalize_to_list_of_substitutions


def indent(lines: list[str], indention: str = "    ") -> list[str]:
    """Return lines with something before each."""
    return [f"{indention}{line}" for line in lines]


def tree_like_indent(lines: list[str]) -> list[str]:
    """Return indented lines with branches drawn to those that are indented least."""
    drawn = indent(lines, "    ")
    heads = [number for number, line in enumerate(lines) if not line.startswith((" ", "│", "├", "└"))]
    for number, line in enumerate(drawn):
        last = heads[-1] if heads else -1
        if number in heads:
            drawn[number] = ("└── " if number == last else "├── ") + line[4:]
        elif number < last:
            drawn[number] = "│   " + line[4:]
    return drawn


def format_entities(entities: Iterable[LaunchDescriptionEntity]) -> list[str]:
    """Return entities and what is in them as lines."""
    lines: list[str] = []
    for entity in entities:
        if is_a(entity, Action):
            lines.extend(format_action(cast("Action", entity)))
            continue
        lines.append(entity.describe())
        lines.extend(_format_sub_entities(entity))
    return lines


def format_substitutions(substitutions: SomeSubstitutionsType) -> str:
    """Return a text in words."""
    return " + ".join(sub.describe() for sub in normalize_to_list_of_substitutions(substitutions))


def format_event_handler(event_handler: BaseEventHandler) -> list[str]:
    """Return an event handler and the entities that it yields as lines."""
    description, entities = event_handler.describe()
    return [description, *tree_like_indent(format_entities(normalize_to_list_of_entities(entities)))]


def format_action(action: Action) -> list[str]:
    """Return an action and what is in it as lines."""
    if is_a(action, LogInfo):
        return [f"LogInfo({format_substitutions(cast('LogInfo', action).msg)})"]
    if is_a(action, EmitEvent):
        return [f"EmitEvent(event='{cast('EmitEvent', action).event.name}')"]
    if is_a(action, ExecuteProcess):
        return [_format_process(cast("ExecuteProcess", action)), *_format_sub_entities(action)]
    if is_a(action, RegisterEventHandler):
        handler = cast("RegisterEventHandler", action).event_handler
        return ["RegisterEventHandler:", *indent(format_event_handler(handler))]
    return [f"Action({action.describe()})", *_format_sub_entities(action)]


def _format_process(process: ExecuteProcess) -> str:
    description = process.process_description
    cmd = ", ".join(format_substitutions(part) for part in description.cmd)
    cwd = "None" if description.cwd is None else format_substitutions(description.cwd)
    env = "None"
    if description.env is not None:
        pairs = [f"{format_substitutions(name)}: {format_substitutions(value)}" for name, value in description.env]
        env = f"{{{', '.join(pairs)}}}"
    return f"{type(process).__name__}(cmd=[{cmd}], cwd={cwd}, env={env}, shell={process.shell})"


def _format_sub_entities(entity: Any) -> list[str]:
    lines = tree_like_indent(format_entities(entity.describe_sub_entities()))
    for condition, sub_entities in entity.describe_conditional_sub_entities():
        lines.extend(indent([condition, *tree_like_indent(format_entities(sub_entities))]))
    return lines


class LaunchIntrospector:
    """Introspector that shows what a launch description holds, as far as it is known before launching."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the description as a tree of text."""
        return "\n".join([f"{launch_description}", *tree_like_indent(format_entities(launch_description.entities))])
