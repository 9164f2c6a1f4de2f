"""`daidalos rapid debug`: a debug adapter for editors, on standard input and output."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.daidalos.rapid_loading import load_tasks
from daidalos.common.errors import UserError
from daidalos.industry.rapid.runtime.pacing import Pace

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


def debug_programs() -> int:
    """Answer an editor until it disconnects."""
    from daidalos.industry.rapid.debugging.adapter import Adapter
    from daidalos.industry.rapid.debugging.protocol import Channel

    Adapter(Channel(sys.stdin.buffer, sys.stdout.buffer), _load).serve()
    return 0


def _load(arguments: dict[str, Any]) -> dict[str, Task]:
    """Return the tasks of a launch request.

    Raises
    ------
    UserError
        Where the arguments do not fit, or a task has errors.
    """
    if not isinstance(arguments.get("program"), str):
        raise UserError("launch needs 'program': the path of a module, a program file or a folder")
    known = {
        "program",
        "task",
        "robot",
        "signals",
        "io",
        "home",
        "procedure",
        "stopOnEntry",
        "fast",
        "maxTime",
        "manual",
    }
    ignored = {"name", "type", "request", "noDebug"}
    unknown = [one for one in arguments if one not in known | ignored and not one.startswith("__")]
    if unknown:
        raise UserError(f"launch has no argument '{unknown[0]}'; it has {', '.join(sorted(known))}")
    signals = arguments.get("signals") or {}
    args = argparse.Namespace(
        path=Path(arguments["program"]),
        task=_texts(arguments.get("task")),
        robot=_texts(arguments.get("robot")) or None,
        signal=[f"{name}={value}" for name, value in signals.items()],
        io=[Path(one) for one in _texts(arguments.get("io"))],
        home=Path(arguments["home"]) if arguments.get("home") else None,
        sensor=[],
        external=_texts(arguments.get("external")),
        manual=bool(arguments.get("manual")),
        max_time=arguments.get("maxTime"),
    )
    tasks = load_tasks(args, None if arguments.get("fast") else Pace(), 0.0, is_debugged=True)
    if tasks is None:
        raise UserError(f"{args.path}: has errors; daidalos rapid check lists them")
    return tasks


def _texts(value: Any) -> list[str]:
    return [] if value is None else [value] if isinstance(value, str) else [str(one) for one in value]
