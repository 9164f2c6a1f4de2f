"""What the threads of a lock-step run wait for, in words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import FrameType
from typing import Any

from daidalos.lockstep.scheduler import Thread
from daidalos.transport.graph import EndpointKind

_LONG_NS = 10_000_000_000
"""Stepped time [ns] after which a wait for another node is worth a line."""

_Words = Callable[[Mapping[str, Any]], str]


def _server_of(variables: Mapping[str, Any]) -> str:
    handle = variables["self"].handle
    name = handle.endpoint.name
    servers = handle.node.session.graph.endpoints(EndpointKind.SERVICE, name=name)
    nodes = [server.node.full_name for server in servers]
    return f"the answer of {' or '.join(nodes) or 'nobody'} to a call of the service '{name}'"


_WAITS: dict[tuple[str, str], _Words] = {
    ("rclpy.client", "call"): _server_of,
    ("rclpy.client", "wait_for_service"): lambda found: f"a server of the service '{found['self'].handle.name}'",
    ("rclpy.action.client", "wait_for_server"): lambda found: f"a server of the action '{found['self']._action_name}'",
    ("rclpy.executors", "_wait"): lambda found: "work of its executor",
    ("rclpy.wait_for_message", "wait_for_message"): lambda found: f"a message on '{found['topic']}'",
    ("tf2_ros.buffer", "_wait"): lambda found: "a transform",
    ("threading", "join"): lambda found: f"the end of the thread '{found['self'].name}'",
    ("queue", "get"): lambda found: "an item of a queue",
    ("queue", "put"): lambda found: "room in a queue",
    ("concurrent.futures._base", "result"): lambda found: "the result of a future",
}
"""Modules and functions that wait, with functions that say from their variables what for; the innermost one counts."""

_OF_OTHER_NODES = ("rclpy.client", "rclpy.action.client", "rclpy.wait_for_message", "tf2_ros.buffer")
"""Modules whose waits end only when another node does something."""

_IN_GENERAL: dict[tuple[str, str], str] = {
    ("threading", "wait"): "a condition or event",
    ("asyncio.base_events", "_run_once"): "events of asyncio",
}


def describe(threads: Iterable[Thread]) -> str:
    """Return what each thread waits for, and where."""
    return "\n".join(
        f"{thread.owner.name} ({thread.name}) waits for {waits_for(thread)}:\n{thread.stack()}" for thread in threads
    )


def waits_for(thread: Thread) -> str:
    """Return what a thread waits for."""
    if thread.waiting is None:
        return "its turn"
    frames = list(_frames(thread))
    for frame in frames:
        words = _WAITS.get(_place(frame))
        if words is not None:
            return words(frame.f_locals)
    return next((_IN_GENERAL[place] for place in map(_place, frames) if place in _IN_GENERAL), thread.waiting.what)


def long_waits(threads: Iterable[Thread], now_ns: int) -> list[str]:
    """Return a line for each thread that has waited for another node for long."""
    lines = []
    for thread in threads:
        waiting = thread.waiting
        frame = next((frame for frame in _frames(thread) if _place(frame) in _WAITS), None)
        if waiting is None or frame is None or _place(frame)[0] not in _OF_OTHER_NODES:
            continue
        if now_ns - waiting.since_ns >= _LONG_NS:
            line = f"{thread.owner.name} ({thread.name}) has waited since {1e-9 * waiting.since_ns:g} s"
            lines.append(f"{line} for {waits_for(thread)}")
    return lines


def _frames(thread: Thread) -> Iterable[FrameType]:
    """Yield the frames of a thread, the innermost first."""
    frame: FrameType | None = thread.gr_frame
    while frame is not None:
        yield frame
        frame = frame.f_back


def _place(frame: FrameType) -> tuple[str, str]:
    return str(frame.f_globals.get("__name__")), frame.f_code.co_name
