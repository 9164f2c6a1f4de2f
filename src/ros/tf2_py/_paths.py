"""Finding the way from one frame to another."""

from __future__ import annotations

from collections.abc import Mapping

from . import _report
from ._history import Fixed, History, Item
from .exceptions import ConnectivityException, ExtrapolationException, LookupException

Frames = Mapping[str, History | Fixed | None]
"""What is known of every frame; nothing of the root of a tree."""
Found = tuple[Item, Item, float] | Item
_MAX_DEPTH = 1000


def path(frames: Frames, target: str, source: str, stamp: int) -> tuple[list[Found], list[Found]]:
    """Return what `History.at` gives for the frames from the source, and from the target, to where they meet.

    Raises
    ------
    ConnectivityException, ExtrapolationException, LookupException
        When they do not meet at that time, or go round in a loop.
    """
    upward: list[Found] = []
    places: dict[str, int] = {}
    failure: str | None = None
    frame = source
    while frame != target:
        history = frames[frame]
        if history is None:
            break
        found = history.at(stamp)
        if isinstance(found, str):
            failure = found  # the way down from here may still lead to the target
            break
        if frame in places:
            raise _loop(frames)
        places[frame] = len(upward)
        upward.append(found)
        frame = parent_of(found)
    top = frame
    downward: list[Found] = []
    frame = target
    while frame != top:
        if frame in places:
            del upward[places[frame] :]
            break
        history = frames[frame]
        if history is None:
            if failure is not None:
                raise ExtrapolationException(_between(failure, source, target))
            raise _unconnected(target, source)
        found = history.at(stamp)
        if isinstance(found, str):
            raise ExtrapolationException(_between(found, source, target))
        downward.append(found)
        frame = parent_of(found)
        if len(downward) > _MAX_DEPTH:
            raise _loop(frames)
    return upward, downward


def latest_common(frames: Frames, target: str, source: str) -> int:
    """Return the newest time at which all transforms between two frames are known, zero for any time.

    Raises
    ------
    ConnectivityException, LookupException
        When they do not meet, or go round in a loop.
    """
    newest: dict[str, int] = {}  # parent: the oldest of the newest stamps on the way to it
    common = 0
    frame = source
    while frame != target:
        history = frames[frame]
        stamp, parent = (0, "") if history is None else history.latest()
        if not parent:
            break
        if stamp and (stamp < common or not common):
            common = stamp
        if parent in newest:
            raise _loop(frames)
        newest[parent] = common
        frame = parent
    else:
        return common
    common = 0
    frame = target
    depth = 0
    while frame != source:
        history = frames[frame]
        stamp, parent = (0, "") if history is None else history.latest()
        if not parent:
            raise _unconnected(target, source)
        if stamp and (stamp < common or not common):
            common = stamp
        if parent in newest:
            other = newest[parent]
            return min(common, other) if common and other else common or other
        frame = parent
        depth += 1
        if depth > _MAX_DEPTH:
            raise _loop(frames)
    return common


def parent_of(found: Found) -> str:
    """Return the parent in what `History.at` found."""
    parent = found[0]
    return parent if isinstance(parent, str) else parent[0]


def _between(problem: str, source: str, target: str) -> str:
    return f"{problem}, when looking up transform from frame [{source}] to frame [{target}]"


def _unconnected(target: str, source: str) -> ConnectivityException:
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def _loop(frames: Frames) -> LookupException:
    return LookupException(f"The tf tree is invalid because it contains a loop.\n{_report.as_sentences(frames)}\n")
